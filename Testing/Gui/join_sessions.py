# SPDX-License-Identifier: BSD-3-Clause
"""join_sessions.py [--no-pictures] RESULT.xml SESSION.xml...: one session that plays the others one after another.

ParaView starts once for all of them, as its start takes longer than most sessions; fresh_session.py removes between two
what the first has made, and names the one that begins. --no-pictures leaves out the comparisons of pictures.
"""

import sys
import xml.etree.ElementTree as tree
from pathlib import Path

SHELL = "pqClientMainWindow/pythonShellDock/pythonShell/consoleWidget"
BEGIN = (
    "import os, sys; sys.path.insert(0, os.environ['TAUTLINE_GUI']); import fresh_session; fresh_session.begin('{name}')"
)


def joined(sessions, pictures):
    result = tree.Element("pqevents")
    for session in sessions:
        begin = BEGIN.format(name=session.stem)
        tree.SubElement(result, "pqevent", object=SHELL, command="executeCommand", arguments=begin)
        events = tree.parse(session).getroot()
        result.extend(event for event in events if pictures or event.tag != "pqcompareview")
    return result


def main(arguments):
    pictures = "--no-pictures" not in arguments
    result, *sessions = (Path(name) for name in arguments if name != "--no-pictures")
    root = joined(sessions, pictures)
    tree.indent(root)
    text = '<?xml version="1.0" ?>\n' + tree.tostring(root, encoding="unicode") + "\n"
    if not result.exists() or result.read_text(encoding="utf-8") != text:
        result.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
