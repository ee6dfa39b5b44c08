"""pvpython make_improve.py PLUGIN: draws improve_mesh.png, the slivers of the sample bracket before and after, and
improve_mesh_plane.png, a planar mesh.

Left the tetrahedra of the bracket with a dihedral angle below 25 degrees, right those of the output of Improve Mesh
with the preset Aggressive, both coloured by the angle. The planar mesh is a part of the sample wrench with its points
moved at random, and what Improve Mesh makes of it, coloured in the same way.
"""

import sys
from pathlib import Path

from paraview import simple

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "Data"
PICTURE = HERE / "improve_mesh.png"
PLANE = HERE / "improve_mesh_plane.png"
SIZE = [760, 300]
CELLS = 1  # vtkDataObject::CELL
BAD = 25.0  # degrees


def make_view(mesh, hull):
    """A view of the bad tetrahedra within the transparent surface."""
    view = simple.CreateView("RenderView")
    view.OrientationAxesVisibility = view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.CameraParallelProjection = 1
    surface = simple.Show(hull, view)
    surface.ColorArrayName = [None, ""]
    surface.Representation, surface.Opacity = "Surface", 0.15
    surface.DiffuseColor = surface.AmbientColor = [0.55, 0.65, 0.75]
    bad = simple.Threshold(Input=mesh, Scalars=["CELLS", "min_angle"])
    bad.ThresholdMethod, bad.UpperThreshold, bad.LowerThreshold = "Below Lower Threshold", BAD, BAD
    bad.UpdatePipeline()
    if bad.GetDataInformation().GetNumberOfCells() > 0:
        display = simple.Show(bad, view)
        display.Representation = "Surface With Edges"
        display.EdgeColor = [0.25, 0.25, 0.25]
        display.SetScalarColoring("min_angle", CELLS)
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.9, -2, 1.0], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    view.CameraParallelScale *= 0.8
    return view


def make_plane_view(mesh):
    """A view of triangles, coloured by the smallest angle from 0 to 60 degrees."""
    view = simple.CreateView("RenderView")
    view.OrientationAxesVisibility = view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.InteractionMode, view.CameraParallelProjection = "2D", 1
    display = simple.Show(mesh, view)
    display.Representation, display.EdgeColor = "Surface With Edges", [0.25, 0.25, 0.25]
    display.SetScalarColoring("min_angle", CELLS)
    simple.GetColorTransferFunction("min_angle").RescaleTransferFunction(0, 60)
    simple.ResetCamera(view)
    view.CameraParallelScale *= 0.55
    return view


def draw_plane() -> None:
    mesh = simple.OpenDataFile(str(DATA / "wrench.msh"))
    worse = simple.PerturbMesh(Input=mesh, Percentage=100, Fraction=0.95)
    quality = simple.ElementQuality(Input=worse, Metrics=["Minimum angle"])
    better = simple.ImproveMesh(Input=worse, Preset="Aggressive")
    better.UpdatePipeline()
    better.UpdatePropertyInformation()
    print(f"smallest angle {better.SmallestAngleBefore:.3g}, then {better.SmallestAngleAfter:.3g}")
    layout = simple.CreateLayout("Plane")
    simple.AssignViewToLayout(view=make_plane_view(simple.OutputPort(quality, 0)), layout=layout, hint=0)
    layout.SplitHorizontal(0, 0.5)
    simple.AssignViewToLayout(view=make_plane_view(simple.OutputPort(better, 0)), layout=layout, hint=2)
    simple.SaveScreenshot(str(PLANE), layout, ImageResolution=SIZE, SeparatorWidth=2)


def main(plugin: str) -> None:
    simple.LoadPlugin(plugin, ns=vars(simple))
    draw_plane()
    mesh = simple.OpenDataFile(str(DATA / "bracket.vtu"))
    hull = simple.ExtractSurface(Input=mesh)
    quality = simple.ElementQuality(Input=mesh, Metrics=["Minimum angle"])
    better = simple.ImproveMesh(Input=mesh, Preset="Aggressive")
    layout = simple.CreateLayout("Tautline")
    simple.AssignViewToLayout(view=make_view(simple.OutputPort(quality, 0), hull), layout=layout, hint=0)
    layout.SplitHorizontal(0, 0.5)
    simple.AssignViewToLayout(view=make_view(simple.OutputPort(better, 0), hull), layout=layout, hint=2)
    simple.SaveScreenshot(str(PICTURE), layout, ImageResolution=SIZE, SeparatorWidth=2)


if __name__ == "__main__":
    main(sys.argv[1])
