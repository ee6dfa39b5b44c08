# SPDX-License-Identifier: BSD-3-Clause
"""requests_on_ranks.py FILE DATA LARGE: for pvbatch --sym on any number of MPI ranks, see test_read_on_ranks.py.

Reads the files of the folder LARGE and some of DATA with each rank asking for its piece, and writes to FILE as JSON
what each rank found: whether files were read by ranges, cells, messages. Then only some ranks ask, or not all for their
piece.
"""

import json
import sys
from pathlib import Path

import tautline
from vtkmodules.vtkParallelCore import vtkMultiProcessController

FILE, DATA, LARGE = sys.argv[1:4]
CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()
KINDS = {".msh": "Gmsh", ".mesh": "Medit", ".sol": "Medit", ".off": "Off"}


def read(path: str, piece: int = RANK, named: bool = True) -> dict:
    """What a rank gets of a file; named: whether the reader is given its name."""
    reader = getattr(tautline, f"vtk{KINDS.get(Path(path).suffix, 'TetGen')}Reader")()
    if named:
        reader.SetFileName(path)
    reader.UpdatePiece(piece, RANKS, 0)
    return {
        "ranges": reader.GetReadByRanges(),
        "cells": reader.GetOutput().GetNumberOfCells(),
        "message": reader.GetErrorText(),
    }


found = {}
for folder in (LARGE, DATA):
    for path in sorted(Path(folder).iterdir()):
        if path.suffix in {".msh", ".mesh", ".ele", ".off", ".poly"}:
            found[path.name] = read(str(path))
# all ask for the first piece: none is sent anything
found["first piece"] = read(f"{LARGE}/large2.msh", 0)
# a rank that has no file name does not leave the others waiting
found["no name"] = read(f"{LARGE}/large2.msh", named=RANK > 0)
# formats without ranges: a rank alone
if RANK == RANKS - 1:
    found["alone"] = {name: read(f"{DATA}/{name}") for name in ("house.off", "box.poly")}
CONTROLLER.Barrier()

Path(f"{FILE}.{RANK}").write_text(json.dumps(found), encoding="utf-8")
CONTROLLER.Barrier()
if RANK == 0:
    of_ranks = [json.loads(Path(f"{FILE}.{rank}").read_text(encoding="utf-8")) for rank in range(RANKS)]
    Path(FILE).write_text(json.dumps({"ranks": RANKS, "found": of_ranks}), encoding="utf-8")
