# SPDX-License-Identifier: BSD-3-Clause
"""join_sessions.py [--no-pictures] [--paraview=VERSION] RESULT.xml SESSION.xml...: one session that plays the others.

ParaView starts once for all of them, as its start takes longer than most sessions; fresh_session.py removes between two
what the first has made, and names the one that begins. "All sessions ended" is printed after the last event.
--no-pictures leaves out the comparisons of pictures.
An event in a comment that begins with "Since ParaView 5.13:" is played by that version and later ones. Widgets that a
version has moved, and texts that it shows otherwise, are replaced (CHANGED).
"""

import re
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

SHELL = "pqClientMainWindow/pythonShellDock/pythonShell/consoleWidget"
BEGIN = (
    "import os, sys; sys.path.insert(0, os.environ['TAUTLINE_GUI']); "
    "import fresh_session; fresh_session.begin('{name}')"
)
END = "print('All sessions ended', file=sys.__stdout__, flush=True)"

#: Since a version of ParaView: a pattern in the sessions, and what takes its place.
CHANGED = (
    ((6, 1), r"InteractiveBox/(?=(translate|rotate|scale)[XYZ])",
     "InteractiveBox/tabWidget/qt_tabwidget_stackedwidget/fieldsPage/"),
    ((6, 1), r'(/cellCount" property="text" arguments="[0-9]+),([0-9]+)"', r'\1\2"'),
)  # fmt: skip
SINCE = re.compile(r"<!-- Since ParaView ([0-9]+)[.]([0-9]+): (<pqevent [^<]*/>) -->")


def text_for(session, version):
    """The session as this version of ParaView, a pair, plays it."""
    text = SINCE.sub(
        lambda found: found[3] if version >= (int(found[1]), int(found[2])) else "",
        session.read_text(encoding="utf-8"),
    )
    for since, pattern, replacement in CHANGED:
        text = re.sub(pattern, replacement, text) if version >= since else text
    return text


def joined(sessions, pictures, version):
    result = tree.Element("pqevents")
    for session in sessions:
        begin = BEGIN.format(name=session.stem)
        tree.SubElement(result, "pqevent", object=SHELL, command="executeCommand", arguments=begin)
        events = tree.fromstring(text_for(session, version))
        result.extend(event for event in events if pictures or event.tag != "pqcompareview")
    tree.SubElement(result, "pqevent", object=SHELL, command="executeCommand", arguments=END)
    return result


def main(arguments):
    options = [name for name in arguments if name.startswith("--")]
    version = next((tuple(map(int, name.split("=")[1].split(".")[:2])) for name in options if "=" in name), (0, 0))
    result, *sessions = (Path(name) for name in arguments if name not in options)
    root = joined(sessions, "--no-pictures" not in options, version)
    tree.indent(root)
    text = '<?xml version="1.0" ?>\n' + tree.tostring(root, encoding="unicode") + "\n"
    if not result.exists() or result.read_text(encoding="utf-8") != text:
        result.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
