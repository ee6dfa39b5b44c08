# SPDX-License-Identifier: BSD-3-Clause
"""The demo: measure a mesh, untangle and optimize it, write the meshes, a table and pictures colored by quality.

usage: pvpython demo.py OUTPUT_DIRECTORY [MESH]

The default mesh is the bore of the dissertation, perturbed and slightly tangled; where the meshers were not built, the
bracket in Data.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import tautline
from paraview import simple
from paraview.modules.vtkRemotingServerManager import vtkSMSettings
from tautline import _files, _tables

METRICS = ["imr", "rr", "scaled_jacobian"]
SHOWN, TITLE = METRICS[0], "Inverse mean ratio"
CELLS = 1  # vtkDataObject::CELL
WORST = 3  # elements listed
LOW_PRIORITY = -1.0  # of settings: lower than the settings of the site and the user
DOMAIN, CELL_COUNT = "bore", 8000
SIZE = [1200, 800]
FROM, ABOVE, UP, ZOOM = [0.75, -1.0, 0.55], [0.0, 0.0, 1.0], [0, 0, 1], 1.1  # the camera
BLACK, WHITE, SHADOW = [0, 0, 0], [1, 1, 1], [0.2, 0.3, 0.4]
SHADOWED: dict[str, Any] = {"Opacity": 0.08}
EDGED: dict[str, Any] = {"Representation": "Surface With Edges", "EdgeColor": [0.3, 0.3, 0.3], "LineWidth": 1.0}


def start(output: Path) -> Path:
    """A generated domain with elements of all qualities, or the sample mesh if there are no meshers."""
    try:
        made = tautline.perturb(tautline.domain(DOMAIN, CELL_COUNT), fraction=0.9, seed=1, tangle=0.005)
    except tautline.Error as error:
        print(f"the domain cannot be meshed ({error}); the bracket is used")
        return Path(__file__).resolve().parents[2] / "Data" / "bracket-tangled.vtu"
    tautline.write(made, output / "domain.vtu")
    return output / "domain.vtu"


def measure(mesh: Path, output: Path) -> list[Path]:
    """Measure with the Python function; print the table, write mesh and table."""
    result = tautline.quality(mesh, METRICS)
    print(f"{mesh}\n{_tables.quality_text(result, WORST)}\n")
    written = [output / "quality.vtu", output / "quality.csv"]
    tautline.write(result, written[0])
    _files.replace_text(written[1], _tables.csv_text(_tables.quality_rows(result)))
    return written


def improve(mesh: Path, output: Path) -> Path:
    """Untangle and optimize with the Python functions; print their summaries, write the mesh."""
    valid = tautline.untangle(mesh)
    better = tautline.optimize(valid)
    print(f"{valid.summary}\n{better.summary}\n")
    tautline.write(tautline.quality(better, METRICS), output / "better.vtu")
    return output / "better.vtu"


def show(proxy: Any, view: Any, **options: Any) -> Any:
    """Show a mesh colored by quality with the range of the metric, to which ColorBy would not keep."""
    display = simple.Show(proxy, view)
    display.SetScalarColoring(SHOWN, CELLS)
    display.Ambient, display.Diffuse = 0.35, 0.75
    for name, value in options.items():
        setattr(display, name, value)
    return display


def cut_open(quality: Any, view: Any, middle: list[float]) -> None:
    """Show half of the elements, the other half transparent with the inverted elements in it."""
    for half, options in enumerate((EDGED, SHADOWED)):
        clip = simple.Clip(Input=quality, ClipType="Plane", Crinkleclip=1, Invert=half)
        clip.ClipType.Origin, clip.ClipType.Normal = middle, [0, 1, 0]
        display = show(clip, view, **options)
        if half:
            simple.ColorBy(display, None)
            display.AmbientColor = display.DiffuseColor = SHADOW
    inverted = simple.Threshold(Input=quality, Scalars=["CELLS", "Validity"])
    inverted.ThresholdMethod, inverted.LowerThreshold, inverted.UpperThreshold = "Between", -1, -1
    show(inverted, view, **EDGED)


def picture(mesh: Path, file: Path) -> None:
    """Look inside a measured mesh, save a picture."""
    quality = simple.OpenDataFile(str(mesh))
    quality.UpdatePipeline()
    xmin, xmax, ymin, ymax, zmin, zmax = quality.GetDataInformation().GetBounds()
    middle = [(xmin + xmax) / 2, (ymin + ymax) / 2, (zmin + zmax) / 2]
    solid = zmax > zmin

    view = simple.CreateView("RenderView")
    view.ViewSize = SIZE
    view.UseColorPaletteForBackground = 0
    view.Background = WHITE
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    if solid:
        cut_open(quality, view, middle)
    else:
        show(quality, view, **EDGED)

    bar = simple.GetScalarBar(simple.GetColorTransferFunction(SHOWN), view)
    bar.Title, bar.ComponentTitle, bar.HorizontalTitle = TITLE, "", 1
    bar.TitleColor = bar.LabelColor = BLACK
    bar.TitleFontSize, bar.LabelFontSize = 20, 18
    # ParaView 6.1 has the formats of std::format.
    label = "{:.1f}" if simple.GetParaViewVersion() >= (6, 1) else "%.1f"
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, label, label
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.82, 0.27], 0.5
    bar.Visibility = 1
    note = simple.Show(simple.Text(Text="blue: inverted"), view)
    note.Color, note.FontSize = BLACK, 18
    note.WindowLocation, note.Position = "Any Location", [0.755, 0.2]

    camera = view.GetActiveCamera()
    camera.SetFocalPoint(middle)
    camera.SetPosition([m + f for m, f in zip(middle, FROM if solid else ABOVE)])
    camera.SetViewUp(UP if solid else [0, 1, 0])
    simple.ResetCamera(view)
    camera.Zoom(ZOOM)
    camera.SetWindowCenter(0.2, 0)
    with TemporaryDirectory() as folder:
        made = Path(folder, file.name)
        simple.SaveScreenshot(str(made), view, ImageResolution=SIZE)
        _files.replace_bytes(file, made.read_bytes())


def main(mesh: Path | None, output: Path) -> None:
    """Write quality.vtu, quality.csv and quality.png of a mesh, better.vtu and better.png of the improved one."""
    _files.make_folder(output)
    mesh = mesh or start(output)
    # The colors of the plugin, which need not be built for the demo.
    vtkSMSettings.GetInstance().AddCollectionFromString(tautline.vtkElementQuality.GetColorMapSettings(), LOW_PRIORITY)
    written = measure(mesh, output)
    picture(written[0], output / "quality.png")
    written.append(output / "quality.png")
    better = improve(mesh, output)
    written += [better, output / "better.png"]
    picture(better, written[-1])
    print("\n".join(map(str, written)))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(Path(sys.argv[2]) if len(sys.argv) > 2 else None, Path(sys.argv[1]))
