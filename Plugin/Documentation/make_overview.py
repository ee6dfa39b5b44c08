# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_overview.py PLUGIN: draws overview.png, the picture of README.md and of the help's first page.

Left the sample plate after Perturb Mesh, right the tangled sample bracket, both colored by their quality.
"""

import sys
from pathlib import Path

from paraview import simple

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "Data"
PICTURE = HERE / "overview.png"
SIZE = [660, 290]
CELLS = 1  # vtkDataObject::CELL
FLAT, LIT = (1, 0), (0.65, 0.45)  # ambient and diffuse light
SHADES = 16  # of 256


def show(source, view, light):
    display = simple.Show(source, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.25, 0.25, 0.25]
    display.Ambient, display.Diffuse = light
    display.SetScalarColoring("imr", CELLS)
    return display


def make_view():
    view = simple.CreateView("RenderView")
    view.OrientationAxesVisibility = view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.CameraParallelProjection = 1
    return view


def plate():
    view = make_view()
    mesh = simple.OpenDataFile(str(DATA / "plate.vtu"))
    worse = simple.PerturbMesh(Input=mesh, Percentage=20, TangledFraction=0.005)
    quality = simple.ElementQuality(Input=worse)
    show(quality, view, FLAT)
    inverted = simple.Threshold(Input=simple.OutputPort(quality, 0), Scalars=["CELLS", "Validity"])
    inverted.ThresholdMethod, inverted.LowerThreshold = "Below Lower Threshold", -1
    show(inverted, view, FLAT).Position = [0, 0, 0.1]  # they lie below others
    simple.ResetCamera(view)
    view.CameraParallelScale *= 0.8
    return view


def bracket():
    view = make_view()
    quality = simple.ElementQuality(Input=simple.OpenDataFile(str(DATA / "bracket-tangled.vtu")))
    quality.UpdatePipeline()
    cut = simple.Clip(Input=simple.OutputPort(quality, 0), ClipType="Plane", Crinkleclip=1, Invert=0)
    low, high = [quality.GetDataInformation().GetBounds()[i::2] for i in (0, 1)]
    cut.ClipType.Origin = [(a + b) / 2 for a, b in zip(low, high)]
    cut.ClipType.Normal = [0, 1, 0]
    display = show(cut, view, LIT)
    simple.Render(view)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.9, -2, 1.0], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    view.CameraParallelScale *= 0.9
    display.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(simple.GetColorTransferFunction("imr"), view)
    bar.Title, bar.ComponentTitle = "inverse mean ratio", ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize = bar.LabelFontSize = 12
    bar.LabelFormat = bar.RangeLabelFormat = "%.3g"
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.5, 10
    bar.WindowLocation, bar.Position = "Any Location", [0.84, 0.45]
    return view


def shrink() -> None:
    """Fewer shades, half the bytes."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter

    reader = vtkPNGReader()
    reader.SetFileName(str(PICTURE))
    reader.Update()
    colors = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    step = 256 // SHADES
    colors[:] = ((colors.astype(int) + step // 2) // step * step).clip(0, 255)
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(PICTURE))
    writer.SetInputData(reader.GetOutput())
    writer.Write()


def main(plugin: str) -> None:
    simple.LoadPlugin(plugin, ns=vars(simple))
    layout = simple.CreateLayout("Tautline")
    simple.AssignViewToLayout(view=plate(), layout=layout, hint=0)
    layout.SplitHorizontal(0, 0.5)
    simple.AssignViewToLayout(view=bracket(), layout=layout, hint=2)
    simple.SaveScreenshot(str(PICTURE), layout, ImageResolution=SIZE, SeparatorWidth=0)
    shrink()


if __name__ == "__main__":
    main(sys.argv[1])
