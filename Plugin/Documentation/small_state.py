# SPDX-License-Identifier: BSD-3-Clause
"""Small ParaView state files: of representations and views only the properties that our pictures set."""

import xml.etree.ElementTree as ElementTree

KEPT = {
    "representations": """Input Visibility Representation ColorArrayName LookupTable Opacity EdgeColor Ambient Diffuse
        AmbientColor DiffuseColor ScalarOpacityFunction""".split(),
    "views": """Background UseColorPaletteForBackground OrientationAxesVisibility CenterAxesVisibility CameraPosition
        CameraFocalPoint CameraViewUp CameraParallelProjection CameraParallelScale Representations ViewSize""".split(),
    "annotations": [],
}
HELPERS = ("PolarAxesRepresentation", "GridAxesRepresentation")  # parts of representations, as by default


def shortened(text: str) -> str:
    """The state without default properties of representations and views, domains, settings and indentation."""
    root = ElementTree.fromstring(text)
    state = root.find("ServerManagerState")
    for part in list(state):
        if part.tag == "Settings":
            state.remove(part)
        kept = [] if part.get("type") in HELPERS else KEPT.get(part.get("group"))
        for item in part.findall("Property"):
            if kept is not None and item.get("name") not in kept:
                part.remove(item)
            else:
                for domain in item.findall("Domain"):
                    item.remove(domain)
    for node in root.iter():
        node.text = node.text.strip() if node.text else None
        node.tail = "\n" if node.tail and node.tag in ("Proxy", "Property", "ProxyCollection") else None
    return ElementTree.tostring(root, encoding="unicode") + "\n"
