# SPDX-License-Identifier: BSD-3-Clause
"""check_layers.py SOURCE_TREE: headers are included downwards only.

Layers: Plugin -> Filters, Readers -> Filters/Kernel. The kernel includes nothing of VTK, the filters nothing of
ParaView or Qt. Only the VTK module Core may be a dependency of the others.

Inside the kernel: a room (a folder of Filters/Kernel) includes rooms of lower floors only, the sources Name.h and
Name.cxx that include each other form no circle with others, and only the rooms of the library TautlineSolvers include
PETSc, SLEPc and MPI.

No two headers define a class of the same name in the namespace tautline: a library that has both would mix them up.
"""

import re
import sys
from pathlib import Path
from typing import Iterator

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
PARAVIEW = r"(vtkSM(?!P(Tools|Thread|Range))|vtkSI[A-Z]|vtkPV|vtkClientServer|vtkProcessModule|vtkRemoting|pq|Q[A-Z])"
FORBIDDEN = {"kernel": re.compile(r"(vtk|pq|Q[A-Z])"), "filter": re.compile(PARAVIEW)}
# Parsers and calls of mesh generators are also plain C++.
PLAIN = re.compile(r"Readers/(?!vtk|(Foam|Gzip|Image|Mesh)FileAdapter)|Filters/Meshing/Generators/")
SOURCES = (".h", ".cxx")

#: The rooms of the kernel, from the lowest floor up.
FLOORS = (
    ("Core",),
    ("Elements",),
    ("Geometry", "Mesh"),
    ("Quality", "Shapes", "Domains", "Perturbation", "Ranks"),
    ("FiniteVolume", "Objectives", "Patches", "Solvers"),
    ("Boundary", "Elliptic", "Peridynamics"),
    ("Adaptation", "Sliding"),
    ("Untangling",),
    ("Optimization",),
    ("Curved", "Curving", "Deformation", "Polyhedral", "Reconnection"),
)
FLOOR = {room: floor for floor, rooms in enumerate(FLOORS, 1) for room in rooms}
#: The rooms of TautlineSolvers; rooms of the other libraries need no PETSc and no MPI.
SOLVERS = {"Ranks", "Solvers", "Elliptic", "Peridynamics", "Deformation"}
PARALLEL = re.compile(r"(petsc|slepc|mpi)", re.IGNORECASE)
ROOM_INCLUDE = re.compile(r"tautline/(\w+)/(\w+)\.h")
SHARED_MODULES = {"Tautline::Core"}
#: A definition outside of classes; specializations of templates have their arguments behind the name.
DEFINED = re.compile(
    r"^(?:class|struct|enum class)(?: TAUTLINE\w*_EXPORT)? (\w+)(?: final)?(?: : [^;\n]*)?$", re.MULTILINE
)


def layer(path: Path) -> str:
    return "kernel" if "Kernel" in path.parts or PLAIN.match(path.as_posix()) else "filter"


def sources(directory: Path) -> list[Path]:
    return sorted(p for p in directory.rglob("*") if p.suffix in SOURCES)


def check_layers(top: Path) -> Iterator[str]:
    for path in (p for d in ("Filters", "Readers") for p in sources(top / d)):
        kind = layer(path.relative_to(top))
        for header in INCLUDE.findall(path.read_text()):
            if FORBIDDEN[kind].match(header):
                yield f"{path.relative_to(top)}: a {kind} file must not include {header}"


def check_modules(top: Path) -> Iterator[str]:
    for path in sorted((top / "Filters").rglob("vtk.module")):
        name, *others = re.findall(r"Tautline::\w+", path.read_text())
        for other in others:
            if other not in SHARED_MODULES:
                yield f"{path.relative_to(top)}: {name} must not depend on {other}; what both need belongs to Core"


def check_rooms(kernel: Path) -> Iterator[str]:
    for path in sources(kernel):
        place, room = path.relative_to(kernel), path.parent.name
        if path.parent.parent != kernel or room not in FLOOR:
            yield f"{place}: is in no room; the rooms are {', '.join(FLOOR)}"
            continue
        for header in INCLUDE.findall(path.read_text()):
            found = ROOM_INCLUDE.fullmatch(header)
            if found and found[1] == room:
                yield f'{place}: includes {header} of its own room; write "{found[2]}.h"'
            elif found and FLOOR.get(found[1], len(FLOORS) + 1) >= FLOOR[room]:
                yield f"{place}: {room} is on floor {FLOOR[room]} and must not include {header}"
            elif room not in SOLVERS and (PARALLEL.match(header) or (found and found[1] in SOLVERS)):
                yield f"{place}: TautlineKernel must not include {header}"


def check_circles(kernel: Path) -> Iterator[str]:
    """The circles of sources; Name.h and Name.cxx are one source."""
    graph: dict[str, set[str]] = {}
    for path in sources(kernel):
        unit = f"{path.parent.name}/{path.stem}"
        for header in INCLUDE.findall(path.read_text()):
            found = ROOM_INCLUDE.fullmatch(header)
            other = f"{found[1]}/{found[2]}" if found else f"{path.parent.name}/{Path(header).stem}"
            if other != unit and (kernel / f"{other}.h").is_file():
                graph.setdefault(unit, set()).add(other)
    # The sources left after repeatedly removing those that include nothing of the rest lie on circles or above.
    changed = True
    while changed:
        free = [unit for unit, others in graph.items() if not any(other in graph for other in others)]
        changed = bool(free)
        for unit in free:
            del graph[unit]
    reached = {unit: reachable(graph, unit) for unit in graph}
    circles = {tuple(sorted(v for v in reached[u] if u in reached[v])) for u in graph if u in reached[u]}
    for circle in sorted(circles):
        yield f"Filters/Kernel: {', '.join(circle)} include each other in a circle"


def reachable(graph: dict[str, set[str]], start: str) -> set[str]:
    found: set[str] = set()
    waiting = [start]
    while waiting:
        for other in graph.get(waiting.pop(), ()):
            if other in graph and other not in found:
                found.add(other)
                waiting.append(other)
    return found


def check_names(top: Path) -> Iterator[str]:
    found: dict[str, list[str]] = {}
    for path in (p for d in ("Filters", "Readers", "Plugin") for p in sources(top / d) if p.suffix == ".h"):
        for name in set(DEFINED.findall(path.read_text())):
            found.setdefault(name, []).append(path.relative_to(top).as_posix())
    for name, places in found.items():
        if len(places) > 1:
            yield f"{' and '.join(places)} define {name}; give one another name"


def main(top: Path) -> int:
    kernel = top / "Filters" / "Kernel"
    wrong = [*check_layers(top), *check_modules(top), *check_rooms(kernel), *check_circles(kernel), *check_names(top)]
    print("\n".join(wrong))
    count = len(sources(top / "Filters")) + len(sources(top / "Readers"))
    print(f"{count} files, {len(wrong)} wrong includes or names")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
