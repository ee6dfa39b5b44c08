# SPDX-License-Identifier: BSD-3-Clause
"""pvpython open_states.py PLUGIN DATA [STATES]: opens every state file elsewhere, and checks what it shows.

The state files are those in DATA, or those in any directory of STATES, of which each has the states of one version.
"""

import os
import sys
import tempfile
from pathlib import Path

from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

SIZE = [330, 210]
FEWEST = 0.02  # of the pixels that are not background
PICTURE = "state.png"


def drawn(view) -> float:
    """The fraction of the view's pixels that are not of the color of its corner."""
    simple.SaveScreenshot(PICTURE, view, ImageResolution=SIZE)
    reader = vtkPNGReader()
    reader.SetFileName(PICTURE)
    reader.Update()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return float((pixels != pixels[0]).any(axis=1).mean())


def complaints(state: Path, data: Path):
    if str(data) in state.read_text(encoding="utf-8"):
        yield "names the directory it was made in"
    simple.LoadState(str(state), data_directory=str(data))
    sources = simple.GetSources()
    if not sources or not simple.GetViews():
        yield "has no sources or no views"
    for (name, _), source in sources.items():
        source.UpdatePipeline()
        if source.GetDataInformation().GetNumberOfPoints() == 0:
            yield f"has nothing in {name}"
    for view in simple.GetViews():
        if drawn(view) < FEWEST:
            yield "shows nothing in a view"
    simple.ResetSession()


def main(plugin: Path, data: Path, folder_of_states: Path) -> bool:
    simple.LoadPlugin(str(plugin), ns=vars(simple))
    states = sorted(folder_of_states.rglob("*.pvsm"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # the names of files in the states are relative
        wrong = [f"{state.name} {complaint}" for state in states for complaint in complaints(state, data)]
        os.chdir(data)
    print("\n".join(wrong + [f"{len(states)} states, {len(wrong)} wrong"]))
    return bool(states) and not wrong


if __name__ == "__main__":
    if not main(*(Path(argument).resolve() for argument in (sys.argv[1:] + sys.argv[2:3])[:3])):
        sys.exit(1)
