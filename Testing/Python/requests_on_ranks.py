# SPDX-License-Identifier: BSD-3-Clause
"""requests_on_ranks.py FILE FORMATS: for pvbatch --sym on any number of MPI ranks, see test_read_on_ranks.py.

Reads the files of the folder FORMATS with each rank asking for its piece, and writes to FILE as JSON what each rank
found: cells and messages. Then all ask for the first piece, and one rank has no file name, or a name without a file.
"""

import json
import sys
from pathlib import Path

import tautline
from vtkmodules.vtkParallelCore import vtkMultiProcessController

FILE, FORMATS = sys.argv[1:3]
CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()
KINDS = {".msh": "Gmsh", ".mesh": "Medit", ".ele": "TetGen"}


def read(path: Path, piece: int = RANK, named: bool = True) -> dict:
    """The part of a file that a rank gets; named: whether the reader is given its name."""
    reader = getattr(tautline, f"vtk{KINDS[path.suffix]}Reader")()
    if named:
        reader.SetFileName(str(path))
    reader.UpdatePiece(piece, RANKS, 0)
    return {"cells": reader.GetOutput().GetNumberOfCells(), "message": reader.GetErrorText()}


files = sorted(path for path in Path(FORMATS).iterdir() if path.suffix in KINDS)
found = {path.name: read(path) for path in files}
found["first piece"] = read(files[0], 0)
found["no name"] = read(files[0], named=RANK > 0)
found["missing"] = read(files[0] if RANK > 0 else Path(FORMATS, "missing.msh"))
CONTROLLER.Barrier()

Path(f"{FILE}.{RANK}").write_text(json.dumps(found), encoding="utf-8")
CONTROLLER.Barrier()
if RANK == 0:
    of_ranks = [json.loads(Path(f"{FILE}.{rank}").read_text(encoding="utf-8")) for rank in range(RANKS)]
    Path(FILE).write_text(json.dumps({"ranks": RANKS, "found": of_ranks}), encoding="utf-8")
