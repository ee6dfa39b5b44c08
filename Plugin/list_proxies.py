# SPDX-License-Identifier: BSD-3-Clause
"""pvpython list_proxies.py PLUGIN: loads the plugin and prints the proxies it adds, in one line."""

import sys

from paraview import servermanager, simple

GROUPS = ("filters", "sources", "readers", "writers")


def proxies():
    """The (group, name) pairs of all proxies registered in ParaView."""
    manager = servermanager.ProxyManager()
    definitions = manager.GetProxyDefinitionManager()
    found = set()
    for group in GROUPS:
        iterator = definitions.NewSingleGroupIterator(group)
        iterator.InitTraversal()
        while not iterator.IsDoneWithTraversal():
            found.add((group, iterator.GetProxyName()))
            iterator.GoToNextItem()
    return found


if __name__ == "__main__":
    simple.Connect() if not servermanager.ActiveConnection else None
    before = proxies()
    simple.LoadPlugin(sys.argv[1])
    added = sorted(proxies() - before)
    print(", ".join(f"{group}.{name}" for group, name in added))
    sys.exit(0 if added else "the plugin adds no proxy")
