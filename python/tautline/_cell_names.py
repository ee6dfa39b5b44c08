# SPDX-License-Identifier: BSD-3-Clause
"""The names of cells."""

from __future__ import annotations

#: Cells with a fixed number of points by name: VTK's number, number of points.
CELLS = {
    "vertex": (1, 1),
    "line": (3, 2),
    "triangle": (5, 3),
    "quadrilateral": (9, 4),
    "tetrahedron": (10, 4),
    "hexahedron": (12, 8),
    "wedge": (13, 6),
    "pyramid": (14, 5),
    "line3": (21, 3),
    "triangle6": (22, 6),
    "quad8": (23, 8),
    "tetra10": (24, 10),
    "hexahedron20": (25, 20),
    "wedge15": (26, 15),
    "pyramid13": (27, 13),
    "quad9": (28, 9),
    "hexahedron27": (29, 27),
    "quad6": (30, 6),
    "wedge12": (31, 12),
    "wedge18": (32, 18),
    "hexahedron24": (33, 24),
    "triangle7": (34, 7),
    "line4": (35, 4),
    "pyramid19": (37, 19),
}
#: The names by VTK's number, also of cells without a fixed number of points.
CELLS_BY_NUMBER = {number: name for name, (number, _) in CELLS.items()} | {
    2: "polyvertex", 4: "polyline", 6: "triangle strip", 7: "polygon", 42: "polyhedron",
}  # fmt: skip
#: Other names, among them the names in meshio and in PyVista.
ALIASES = {
    "tri": "triangle",
    "quad": "quadrilateral",
    "tet": "tetrahedron",
    "tetra": "tetrahedron",
    "hex": "hexahedron",
    "hexa": "hexahedron",
    "prism": "wedge",
    "pyr": "pyramid",
    "tet10": "tetra10",
    "tri6": "triangle6",
    "hex20": "hexahedron20",
    "hex27": "hexahedron27",
    "point": "vertex",
    "edge": "line",
}


def find_cell(name: str, known: list[str]) -> str | None:
    """The known name that a name of a cell stands for, case-insensitive; None if there is none."""
    folded = name.strip().casefold()
    found = ALIASES.get(folded, folded)
    return found if found in known else None
