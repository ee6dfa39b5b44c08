# SPDX-License-Identifier: BSD-3-Clause
"""write_on_ranks.py FILE FOLDER: for pvbatch on any number of MPI ranks, see test_write_on_ranks.py.

Saves a cube of tetrahedra in pieces, with and without ghost cells, and writes what was saved to FILE as JSON.
"""

import json
import os
import sys
from pathlib import Path

from paraview import simple
from rank_meshes import RANKS

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())

# Runs on every rank.
CUBE = """
from rank_meshes import RANK, RANKS, divided, piece, simplices

places, cells = simplices(4)
own = divided(places[cells].mean(axis=1), "slabs", RANKS) == RANK
output.VTKObject.ShallowCopy(piece(places.astype(float), cells, own, ghosts={ghosts}))
"""
FORMATS = ("vtu", "node", "mesh", "msh", "off")
results = {"ranks": RANKS, "saved": []}
folder = Path(sys.argv[2])


def attempt(name: str, proxy, **options) -> None:  # (scripts of sources import into this module: not "save")
    try:
        simple.SaveData(str(folder / name), proxy=proxy, **options)
        results["saved"].append(name)
    except (AttributeError, RuntimeError) as error:  # there is no writer
        print(name, error)


for ghosts in (False, True):
    cube = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=CUBE.format(ghosts=ghosts))
    cube.UpdatePipeline()
    # (Debian 12's libexpat does not read raw bytes in XML.)
    attempt(f"ghosts{int(ghosts)}.pvtu", cube, DataMode="Binary")
for ending in FORMATS:
    attempt(f"cube.{ending}", cube)

with open(sys.argv[1], "w") as file:
    json.dump(results, file)
