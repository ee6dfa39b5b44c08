# SPDX-License-Identifier: BSD-3-Clause
"""test_check_layers.py SOURCE_TREE: check_layers.py finds includes that break the layers, the floors or make circles.

Each violation is written into a copy of the sources.
"""

import contextlib
import io
import shutil
import sys
import tempfile
from pathlib import Path

import check_layers

KERNEL = "Filters/Kernel"
#: The file that is changed, the line that is put in front of it, and what must be reported.
VIOLATIONS = (
    (f"{KERNEL}/Mesh/Mesh.h", '#include "tautline/Quality/Metrics.h"', "Mesh is on floor 3 and must not include"),
    (f"{KERNEL}/Objectives/Objective.h", '#include "tautline/Patches/SimplexMesh.h"', "Objectives is on floor 5"),
    (f"{KERNEL}/Mesh/Mesh.h", '#include "FacetTable.h"', "Mesh/FacetTable, Mesh/Mesh include each other in a circle"),
    (f"{KERNEL}/Optimization/Optimize.h", '#include "tautline/Solvers/LinearSolver.h"', "TautlineKernel must not"),
    (f"{KERNEL}/Optimization/Optimize.h", "#include <petscksp.h>", "TautlineKernel must not include petscksp.h"),
    (f"{KERNEL}/Quality/Metrics.h", '#include "vtkDataSet.h"', "a kernel file must not include vtkDataSet.h"),
    (f"{KERNEL}/Quality/Metrics.h", '#include "tautline/Quality/Targets.h"', "of its own room"),
    (f"{KERNEL}/New.h", "", "is in no room"),
    ("Filters/Quality/vtkElementQuality.h", '#include "vtkSMProxy.h"', "a filter file must not include vtkSMProxy.h"),
    ("Filters/Deformation/vtk.module", "NAME Tautline::Deformation DEPENDS Tautline::Quality", "must not depend on"),
    (f"{KERNEL}/Mesh/Mesh.h", "struct IterationRecord\n{\n};\n", "define IterationRecord; give one another name"),
    ("Filters/Core/Blocks.h", "class Mesh : public std::string\n{\n};\n", "define Mesh; give one another name"),
)


def report(top: Path) -> str:
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        code = check_layers.main(top)
    assert (code == 0) == text.getvalue().endswith(" 0 wrong includes or names\n"), text.getvalue()
    return text.getvalue()


def main(source: Path) -> int:
    failed = 0
    with tempfile.TemporaryDirectory() as directory:
        top = Path(directory)
        for name in ("Filters", "Readers", "Plugin"):
            shutil.copytree(source / name, top / name)
        assert " 0 wrong includes" in report(top), report(top)
        for file, line, expected in VIOLATIONS:
            path = top / file
            before = path.read_text() if path.exists() else None
            path.write_text(f"{line}\n{before or ''}")
            if expected not in report(top):
                print(f"{line!r} in {file} is not reported as {expected!r}:\n{report(top)}")
                failed += 1
            path.unlink() if before is None else path.write_text(before)
    print(f"{len(VIOLATIONS)} violations, {failed} not found")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
