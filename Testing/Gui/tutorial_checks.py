# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of the tutorial's sessions, with the places to click, in ParaView's Python shell.

Each function is called at a moment of a session TutorialNAME.xml. Its picture tutorial-N-NAME.png becomes
Plugin/Documentation/tutorial_N_NAME.png (make_strips.py). The numbers in the panels are those of tutorial.md; the page
is searched for them.
"""

import os
import re
from pathlib import Path

from paraview import servermanager, simple
from screenshots import step
from session_checks import check, find
from vtkmodules.util.numpy_support import vtk_to_numpy

PAGE = Path(__file__).resolve().parents[2] / "Plugin" / "Documentation" / "tutorial.md"
BLUE = (13, 89, 255)  # of inverted elements
VALID = 1  # of the array Validity
PIPELINE, PANEL, NAVIGATOR = "pipelineBrowserDock/pipelineBrowser", "propertiesPanel", "TautlineNavigator"
RESULT, PLOT, APPLY = f"{PANEL}/Summary/Text", "tautline_histogram/Plot", f"{PANEL}/Accept"
TAUTLINE = "Filters/Tautline"  # the menu
TALL = {"high": 940, "browser": 300}  # pixels, so that the menu and all outputs are in the picture
SIDE, ABOVE = (0.9, -2, 1), (0, 0, 1)  # direction to the camera, and up
EYE = "|1"  # the column of the pipeline browser


def stated(*texts) -> None:
    """The page has these words."""
    page = " ".join(PAGE.read_text(encoding="utf-8").split())
    missing = [text for text in texts if text not in page]
    assert not missing, missing


def summary(name: str, *numbers) -> str:
    """The result of the last filter of this name; it contains the numbers."""
    filter_ = find(name)
    filter_.UpdatePropertyInformation()
    missing = [number for number in numbers if number not in filter_.Summary]
    assert not missing, (missing, filter_.Summary)
    return filter_.Summary


def turn() -> None:
    """Looks at the bracket from the side, as after a drag with the mouse."""
    view = simple.GetActiveViewOrCreate("RenderView")
    view.CameraViewUp = ABOVE
    view.CameraPosition = [at + way for at, way in zip(view.CameraFocalPoint, SIDE)]
    simple.ResetCamera(view)


@check
def start():
    simple.ResetCamera()
    step("tutorial-1-start", (PIPELINE, "bracket-tangled.vtu"), (PIPELINE, "ElementQuality1"))
    turn()


@check
def found():
    summary("ElementQuality", "8099 valid elements, 41 inverted")
    stated("8099 valid elements", "41 inverted")
    step("tutorial-2-found", RESULT)


@check
def selected():
    step("tutorial-3-histogram", (PLOT, "", BLUE), (NAVIGATOR, "Next"), (NAVIGATOR, "Isolate"))


@check
def isolated():
    step("tutorial-3-isolated", f"{NAVIGATOR}/Element")


@check
def hide_quality():
    """What a click on the eyes of Element Quality's outputs does."""
    view = simple.GetActiveViewOrCreate("RenderView")
    quality = find("ElementQuality")
    for shown in view.Representations:
        if getattr(shown, "Input", None) and shown.Input.SMProxy == quality.SMProxy:
            shown.Visibility = 0
    turn()


@check
def before_untangling():
    eyes = ((PIPELINE, f"ElementQuality1/{output}{EYE}") for output in ("Mesh", "Bad"))
    item = ("menuFilters/Tautline", "Untangle Mesh")
    step("tutorial-4-menu", *eyes, (PIPELINE, "bracket-tangled.vtu"), item, APPLY, menu=TAUTLINE, **TALL)


@check
def untangled():
    summary("MeshUntangler", "All elements are valid; 41 were not.")
    stated("All elements are valid; 41 were not.")


@check
def valid():
    result = summary("ElementQuality", "8140 valid", "0 inverted")
    bad = re.search(r"(\d+) of 8140 outside the acceptable range", result)
    stated(f"{bad[1]} elements are outside")
    step("tutorial-4-valid", RESULT)


@check
def before_optimizing():
    step("tutorial-5-boundary", (PIPELINE, "UntangleMesh1/Mesh"), f"{PANEL}/Boundary/ComboBox", APPLY)


@check
def optimized():
    summary("MeshOptimizer", "worst 18.1", "2.87")
    stated("18.1 before, 2.87 after")


@check
def good():
    summary("ElementQuality", "8140 valid", "0 of 8140 outside the acceptable range")
    step("tutorial-5-good", RESULT)


@check
def before_comparing():
    step("tutorial-6-button", (PIPELINE, "OptimizeMesh1"), f"{PANEL}/Summary/SideBySide")


@check
def compared():
    step("tutorial-6-compared")


@check
def reported():
    step("tutorial-7-report", (PIPELINE, "OptimizeMesh1"), f"{PANEL}/Summary/SaveReport")


@check
def before_turning():
    step("tutorial-8-angle", "InteractiveBox/rotateZ", APPLY)


@check
def turned():
    validity = vtk_to_numpy(servermanager.Fetch(find("MeshWarp")).GetCellData().GetArray("Validity"))
    assert validity.min() == VALID, validity.min()
    step("tutorial-8-turned", RESULT)


@check
def estimated():
    summary("ConditionEstimator", "")
    step("tutorial-9-shares", RESULT, (NAVIGATOR, "Isolate"))


@check
def stiffest():
    step("tutorial-9-isolated", f"{NAVIGATOR}/Element")
