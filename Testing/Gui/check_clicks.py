# SPDX-License-Identifier: BSD-3-Clause
"""check_clicks.py SESSION.xml LIMIT: a recorded job takes at most this many clicks, and it has the check of its result.

A click is an event of the mouse; a choice in a list counts as two, as the list is opened first. Not counted:
Ctrl+O, which is recorded as two entries of the menu File; the Python shell, in which a session is checked; what comes
before the comment "Start" (the mesh is opened), and after "Checks".
"""

import sys
import xml.etree.ElementTree as tree

OPEN = [("menubar", "menu_File"), ("menu_File", "actionFileOpen")]
START, CHECKS = "Start", "Checks"


def clicks(file):
    """The events that are clicks, and the number of checks."""
    builder = tree.TreeBuilder(insert_comments=True)
    root = tree.parse(file, tree.XMLParser(target=builder)).getroot()
    counted, checks, done = [], 0, False
    for event in root:
        if event.tag is tree.Comment:
            done = done or CHECKS in event.text
            counted = [] if START in event.text else counted
            continue
        name = event.get("object").split("/")[-1]
        shell = name == "consoleWidget"
        checks += event.tag == "pqcheck" or shell
        opened = (name, event.get("arguments")) in OPEN
        if event.tag == "pqevent" and not (done or shell or opened):
            counted += ["open the list"] * (event.get("command") == "activated")
            counted.append(f"{name} {event.get('arguments')}")
    return counted, checks


counted, checks = clicks(sys.argv[1])
print(f"{len(counted)} clicks: {'; '.join(counted)}")
assert 0 < len(counted) <= int(sys.argv[2]), f"more than {sys.argv[2]} clicks"
assert checks, "the session checks nothing"
