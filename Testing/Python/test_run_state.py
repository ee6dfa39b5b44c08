# SPDX-License-Identifier: BSD-3-Clause
"""A ParaView state runs without its window: the same numbers as from the functions, other meshes, errors."""

import json
import os
import shutil
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from tautline._choices import OPTIMIZE_PRESETS as PRESETS

os.environ["PV_PLUGIN_PATH"] = str(Path(os.environ["TAUTLINE_PLUGIN"]).parent.parent)
os.environ.pop("DISPLAY", None)  # views of the state are not made
STATES = Path(__file__).parent.parent / "States/0.1.0"
FOLDER = OUT / "run-state"
shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir()
STATE = FOLDER / "optimized.pvsm"
shutil.copy(STATES / "tutorial_5.pvsm", STATE)
TANGLED = DATA / "bracket-tangled.vtu"


def test_missing_mesh():
    rejected(wording("the-file-that-it-reads-is-not"), tl.run_state, STATE)


def test_same_numbers():
    """The chain of the tutorial, its mesh beside the state."""
    shutil.copy(TANGLED, FOLDER)
    result = tl.run_state(STATE, filter="Optimize Mesh")
    rejected(wording("the-state-has-several-ends-choose-a"), tl.run_state, STATE)
    rejected(wording("no-filter-optimise-there-are"), tl.run_state, STATE, filter="Optimise")
    (FOLDER / TANGLED.name).unlink()
    labels = [each["label"] for each in result.filters]
    assert wording("untangle-mesh") in labels and wording("optimize-mesh") in labels, labels
    expected = tl.optimize(tl.untangle(TANGLED), preset=PRESETS[7])  # as the state has it
    assert abs(points(result.mesh) - points(expected.mesh)).max() == 0
    summary = result.filters[labels.index("Untangle Mesh")]["summary"]
    assert "41" in summary and result.summary.count("\n") == len(labels) - 1, result.summary


def test_other_mesh():
    """Another mesh, in another format, in the place of the one that the state reads."""
    tl.write(TANGLED, FOLDER / "other.msh")
    text = shell("run", STATE, "--mesh", FOLDER / "other.msh", "--filter", "Optimize Mesh", "-o", FOLDER / "better.vtu")
    assert wording("untangle-mesh-2") in text and str(FOLDER / "better.vtu") in text, text
    assert tl.quality(FOLDER / "better.vtu").inverted == 0
    facts = json.loads(shell("run", STATE, "--mesh", TANGLED, "--filter", "Untangle Mesh", "--json"))
    assert {"name", "label", "summary"} == set(facts["filters"][0]), facts


def test_errors():
    rejected(wording("there-is-no-such-file"), tl.run_state, FOLDER / "absent.pvsm")
    (FOLDER / "text.pvsm").write_text("no state")
    rejected(wording("not-a-state-of-paraview"), tl.run_state, FOLDER / "text.pvsm")
    (FOLDER / "other.pvsm").write_text("<a/>")
    rejected(wording("it-has-no-servermanagerstate"), tl.run_state, FOLDER / "other.pvsm")
    (FOLDER / "broken.vtu").write_text("no mesh")
    rejected("", tl.run_state, STATE, mesh=FOLDER / "broken.vtu", filter="Optimize Mesh")
    assert wording("mesh-is-for-states") in shell("run", STATE.with_suffix(".toml"), "--mesh", TANGLED, code=1)
    path, os.environ["PATH"] = os.environ["PATH"], str(FOLDER)
    try:
        rejected(wording("needs-pvpython-which-is-not-on"), tl.run_state, STATE, mesh=TANGLED, filter="Optimize Mesh")
    finally:
        os.environ["PATH"] = path


run_tests(globals())
