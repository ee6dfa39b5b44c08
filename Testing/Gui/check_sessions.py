# SPDX-License-Identifier: BSD-3-Clause
"""check_sessions.py DIRECTORY XML...: every filter, source and reader of the plugin is in a recorded session.

XML are the files of the server manager. A filter or source counts as tested where a session of the directory chooses
it in the menu Tautline and presses Apply before it chooses another one; a reader where a session opens a file of one of
its endings and presses Apply; of what was opened, the session has checks of its own.

A session opens a menu right before it chooses something in its submenu Tautline, as a user does: ParaView 5.13 makes
the submenus again when a menu opens, and its player of events uses one that is gone where the menu was not opened.
"""

import sys
import xml.etree.ElementTree as tree
from pathlib import Path

MENUS = {"menuFilters": "filters", "menuSources": "sources"}


def proxies(files):
    """Choices of the menus and of File > Open: groups and names of filters and sources, endings of each reader."""
    offered, readers = set(), {}
    for file in files:
        for group in tree.parse(file).getroot().iter("ProxyGroup"):
            for proxy in group:
                name = proxy.get("name")
                if proxy.find("Hints/ShowInMenu") is not None:
                    offered.add((group.get("name"), name))
                factory = proxy.find("Hints/ReaderFactory")
                if factory is not None:
                    readers[name] = set(factory.get("extensions").split())
    return offered, readers


def applied(session, readers):
    """The filters and sources that a session applies."""
    chosen, done = set(), set()
    for event in tree.parse(session).getroot().iter("pqevent"):
        place, command = event.get("object").split("/"), event.get("arguments")
        if place[-1] == "Tautline" and place[-2] in MENUS:
            chosen = {(MENUS[place[-2]], command)}
        elif place[-1] == "FileOpenDialog":
            chosen = {name for name, endings in readers.items() if command.split(".")[-1] in endings}
        elif place[-1] == "Accept" and event.get("command") == "activate":
            done |= chosen
    return done


def unopened(session):
    """The choices of a session in a submenu of a menu that the previous event has not opened."""
    events = list(tree.parse(session).getroot().iter("pqevent"))
    for before, event in zip([None, *events], events):
        menu, _, submenu = event.get("object").rpartition("/")
        place, _, name = menu.rpartition("/")
        opened = before is not None and (before.get("object"), before.get("arguments")) == (place, name)
        if submenu == "Tautline" and name in MENUS and not opened:
            yield f"{session.name}: {event.get('arguments')}"


def main(directory, files):
    offered, readers = proxies(files)
    done, closed = set(), []
    for session in sorted(Path(directory).glob("*.xml")):
        done |= applied(session, readers)
        closed += unopened(session)
    missing = sorted(f"{group}.{name}" for group, name in offered - done) + sorted(set(readers) - done)
    print(f"{len(offered)} filters and sources, {len(readers)} readers")
    if not offered or missing:
        sys.exit(f"no recorded session of Testing/Gui applies: {', '.join(missing) or 'anything'}")
    if closed:
        sys.exit(f"sessions that choose in a menu before they open it: {', '.join(closed)}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
