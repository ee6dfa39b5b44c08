"""check_layers.py SOURCE_TREE: headers are included downwards only.

Plugin -> Filters, Readers -> Filters/Kernel. The kernel includes nothing of VTK, the filters nothing
of ParaView or Qt.
"""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
PARAVIEW = r"(vtkSM(?!P(Tools|Thread|Range))|vtkSI[A-Z]|vtkPV|vtkClientServer|vtkProcessModule|vtkRemoting|pq|Q[A-Z])"
FORBIDDEN = {"kernel": re.compile(r"(vtk|pq|Q[A-Z])"), "filter": re.compile(PARAVIEW)}
# Parsers and calls of mesh generators are plain C++, too, in the directories of their filters.
PLAIN = re.compile(r"Readers/(?!vtk|MeshFileAdapter)|Filters/Meshing/(Planar|Solid)Mesher")


def layer(path: Path) -> str:
    return "kernel" if "Kernel" in path.parts or PLAIN.match(path.as_posix()) else "filter"


def main(top: Path) -> int:
    wrong = 0
    files = [p for d in ("Filters", "Readers") for p in (top / d).rglob("*") if p.suffix in (".h", ".cxx")]
    for path in sorted(files):
        kind = layer(path.relative_to(top))
        for header in INCLUDE.findall(path.read_text()):
            if FORBIDDEN[kind].match(header):
                print(f"{path}: a {kind} file must not include {header}")
                wrong += 1
    print(f"{len(files)} files, {wrong} wrong includes")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
