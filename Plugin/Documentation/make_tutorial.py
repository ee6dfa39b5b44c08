# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_tutorial.py PLUGIN [--write]: tests the steps of the tutorial; --write makes the states.

Each step is a function that makes what tutorial.md describes, checks its numbers and that the page has them, and
returns the views to show. The states of the views are saved beside the sample meshes, tutorial_N.pvsm. Names of files
in the states are relative: ParaView finds them with "Search files under specified directory". The state of
Plugin/Site/openfoam-mesh.md is openfoam_mesh.pvsm. The pictures of both pages are of sessions (make_strips.py).
"""

import re
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from make_pictures import LIT, OBLIQUE, RED, cut, draw, draw_around, fit, new_view, output, side_by_side  # noqa: E402
from paraview import servermanager, simple  # noqa: E402
from small_state import shortened  # noqa: E402

DATA = HERE.parents[1] / "Data"
PAGE = HERE / "tutorial.md"
ELEMENTS, INVERTED = 8140, 41  # of the sample, as in Data/README.md
STATES = (2, 4, 5, 6, 8, 9)
ANGLE = 120  # degrees by which the hole turns
BEYOND = (90, 180)  # degrees: a non-orthogonality that checkMesh fails

made = {}  # what the steps made, by name


def summary(source, name="Summary") -> str:
    source.UpdatePipeline()
    source.UpdatePropertyInformation()
    return getattr(source, name)


def number_of(source, array, is_bad) -> int:
    values = servermanager.Fetch(source).GetCellData().GetArray(array)
    return sum(is_bad(values.GetValue(cell)) for cell in range(values.GetNumberOfTuples()))


def stated(*texts) -> None:
    """The page has these words."""
    page = " ".join(PAGE.read_text(encoding="utf-8").split())
    missing = [text for text in texts if text not in page]
    assert not missing, missing


def view_inside(mesh, inside, array):
    """The mesh translucent around what lies inside."""
    view = new_view(OBLIQUE)
    draw_around(mesh, view)
    inside.UpdatePipeline()
    if inside.GetDataInformation().GetNumberOfCells():
        draw(inside, view, array, light=LIT)
    return fit(view, 1.2)


def open_mesh():
    made["mesh"] = simple.OpenDataFile(str(DATA / "bracket-tangled.vtu"))
    view = new_view(OBLIQUE)
    draw(made["mesh"], view, light=LIT)
    assert made["mesh"].GetDataInformation().GetNumberOfCells() == ELEMENTS
    return [fit(view, 1.2)]


def find():
    quality = made["quality"] = simple.ElementQuality(Input=made["mesh"])
    assert f"{INVERTED} inverted" in summary(quality)
    stated(f"{ELEMENTS - INVERTED} valid elements", f"{INVERTED} inverted")
    assert number_of(quality, "Validity", lambda validity: validity == -1) == INVERTED
    return [view_inside(output(quality, 0), output(quality, 7), "imr")]


def understand():
    quality = made["quality"]
    inverted = simple.Threshold(Input=output(quality, 0), Scalars=["CELLS", "Validity"])
    inverted.ThresholdMethod, inverted.LowerThreshold = "Below Lower Threshold", -1
    inverted.UpdatePipeline()
    assert inverted.GetDataInformation().GetNumberOfCells() == INVERTED
    histogram = servermanager.Fetch(quality, idx=5)
    counts = histogram.GetColumnByName("imr count")
    total = sum(counts.GetValue(row) for row in range(counts.GetNumberOfTuples()))
    assert total == ELEMENTS - INVERTED, total  # inverted ones are counted apart
    return [view_inside(output(quality, 0), inverted, "imr")]


def untangle():
    made["valid"] = simple.UntangleMesh(Input=made["mesh"])
    assert summary(made["valid"]).startswith(f"All elements are valid; {INVERTED} were not.")
    checked = simple.ElementQuality(Input=output(made["valid"], 0))
    assert "0 inverted" in summary(checked)
    bad = re.search(r"(\d+) of 8140 outside the acceptable range", checked.Summary)
    stated(f"{bad[1]} elements are outside")
    return [view_inside(output(checked, 0), output(checked, 7), "imr")]


def optimize():
    made["better"] = simple.OptimizeMesh(Input=output(made["valid"], 0), Boundary="Slide on flat parts")
    found = re.search(r"worst ([\d.e+]+) to ([\d.e+]+)\.\s", summary(made["better"]) + "\n")
    before, after = (f"{float(value):.3g}" for value in found.groups())
    stated(f"{before} before, {after} after")
    checked = simple.ElementQuality(Input=output(made["better"], 0))
    assert "0 inverted" in summary(checked) and "0 of 8140 outside" in checked.Summary, checked.Summary
    return [view_inside(output(checked, 0), output(checked, 7), "imr")]


def compare():
    changes = simple.CompareMeshes(Input=output(made["valid"], 0), Other=output(made["better"], 0))
    words = re.search(r"(\d+) better, (\d+) worse", summary(changes))
    stated(f"{words[1]} elements became better and {words[2]} worse")
    views = []
    for mesh in (made["valid"], made["better"]):
        half = cut(output(simple.ElementQuality(Input=output(mesh, 0)), 0))
        view = new_view(OBLIQUE)
        draw(half, view, "imr", light=LIT)
        views.append(fit(view, 1.2))
    return views


def report():
    """The tables that a report contains: a row for each metric, before and after."""
    table = servermanager.Fetch(made["better"], idx=2)
    names = [table.GetColumnName(column) for column in range(table.GetNumberOfColumns())]
    before, after = (table.GetColumnByName(name).GetValue(0) for name in ("MeanBefore", "MeanAfter"))
    assert after < before, names
    return []


def warp():
    plate = simple.OpenDataFile(str(DATA / "plate.vtu"))
    turned = simple.WarpMesh(Input=plate, TransformKind="Rotation", Angle=ANGLE)
    summary(turned)
    assert turned.GetPropertyValue("Inverted") == 0
    stated(f"{ANGLE} degrees")
    view = new_view()
    draw(output(turned, 0), view, "TMP shape")
    return [fit(view, 1.5)]


def condition():
    estimate = simple.ConditionEstimator(Input=simple.OpenDataFile(str(DATA / "bracket.vtu")))
    words = re.search(r"\d+ of 8140 elements? ha(?:ve|s) \d+ % of the largest eigenvalue", summary(estimate))
    share = servermanager.Fetch(output(estimate, 0)).GetCellData().GetArray("Share").GetRange()[1]
    stated(f"One element has {round(100 * share)} % of the largest eigenvalue", words[0])
    bad = simple.Threshold(Input=output(estimate, 0), Scalars=["CELLS", "Excess"])
    bad.ThresholdMethod, bad.UpperThreshold = "Above Upper Threshold", 1
    return [view_inside(output(estimate, 0), bad, "Excess")]


def automate():
    """The script of the page, which Testing/Docs/run_examples.py runs."""
    stated("<!-- test: pvpython -->")
    return []


def openfoam_mesh():
    """What openfoam-mesh.md shows: the failing faces of a case, and its repaired mesh. The numbers are checkMesh's."""
    case = simple.OpenFOAMMeshReader(FileName=str(DATA / "elbow-failing" / "elbow-failing.foam"))
    measures = {"Metrics": ["Non-orthogonality"], "Criteria": "openfoam"}
    quality = simple.ElementQuality(Input=case, **measures)
    assert "checkMesh: Failed 5 mesh checks." in summary(quality), quality.Summary
    faces = simple.Threshold(Input=output(quality, 8), Scalars=["CELLS", "non_orthogonality"])
    faces.LowerThreshold, faces.UpperThreshold = BEYOND
    faces.UpdatePipeline()
    assert faces.GetDataInformation().GetNumberOfCells() == 25
    failing = new_view(OBLIQUE)
    draw_around(output(quality, 0), failing)
    draw(faces, failing, color=RED, light=LIT)
    better = simple.OptimizeMesh(Input=case, Preset="Finite volumes")
    assert "checkMesh before: Failed 5 mesh checks. After: Mesh OK." in summary(better), better.Summary
    checked = simple.ElementQuality(Input=output(better, 0), **measures)
    assert "checkMesh: Mesh OK." in summary(checked), checked.Summary
    repaired = new_view(OBLIQUE)
    draw(output(checked, 0), repaired, "non_orthogonality", light=LIT)
    return [fit(failing, 1.2), fit(repaired, 1.2)]


STEPS = (open_mesh, find, understand, untangle, optimize, compare, report, warp, condition, automate)


def save_state(name: str) -> None:
    """The state without the place of this checkout."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "state.pvsm"
        simple.SaveState(str(file))
        text = shortened(file.read_text(encoding="utf-8").replace(f"{DATA}/", ""))
    assert str(HERE.parents[1]) not in text
    (DATA / f"{name}.pvsm").write_text(text, encoding="utf-8")


def main(plugin: str, write: bool) -> None:
    simple.LoadPlugin(plugin, ns=vars(simple))
    for number, step in enumerate(STEPS, 1):
        views = step()
        print(f"step {number}, {step.__name__}: passed", flush=True)
        if not (write and views):
            continue
        side_by_side(*views)
        if number in STATES:
            save_state(f"tutorial_{number}")
        for view in views:
            simple.Delete(view)
    simple.ResetSession()
    views = openfoam_mesh()
    print("openfoam_mesh: passed", flush=True)
    if write:
        side_by_side(*views)
        save_state("openfoam_mesh")


if __name__ == "__main__":
    main(sys.argv[1], "--write" in sys.argv)
