"""The main job in one script: measure a mesh, colour it by quality, write mesh, table and picture.

usage: pvpython demo.py OUTPUT_DIRECTORY [MESH]
Without a mesh it makes one: the wrench, with 1,500 triangles.
"""

import sys
from pathlib import Path

from paraview import simple

from tautline import vtkElementQuality

METRIC = "imr"
CELLS = 1  # vtkDataObject::CELL


def main(output: Path, mesh: Path | None) -> None:
    output.mkdir(parents=True, exist_ok=True)
    source = simple.OpenDataFile(str(mesh)) if mesh else simple.MeshDomain(Domain="Wrench", NumberOfCells=1500)
    quality = simple.ElementQuality(Input=source)
    quality.UpdatePipeline()

    view = simple.CreateView("RenderView")
    view.ViewSize = [800, 600]
    display = simple.Show(quality, view)
    display.Representation = "Surface With Edges"
    display.SetScalarColoring(METRIC, CELLS)
    display.SetScalarBarVisibility(view, True)
    simple.ResetCamera(view)

    written = [output / name for name in ("quality.vtu", "quality.csv", "quality.png")]
    simple.SaveData(str(written[0]), proxy=quality)
    simple.SaveData(str(written[1]), proxy=quality, FieldAssociation="Cell Data")
    simple.SaveScreenshot(str(written[2]), view)

    low, high = quality.CellData[METRIC].GetRange()
    print(f"{mesh.name if mesh else 'wrench'}: {METRIC} from {low:.4g} to {high:.4g}, measured by {vtkElementQuality.__name__}")
    for path in written:
        print(path)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
