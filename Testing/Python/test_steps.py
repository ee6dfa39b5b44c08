# SPDX-License-Identifier: BSD-3-Clause
"""run_steps and the command run: files of steps are checked before they run, and give what the functions give."""

import json
import sys
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, SKIPPED, points, rejected, run_tests, shell, wording

FOLDER = OUT / "steps"
FOLDER.mkdir(exist_ok=True)
STEPS = f"""
[[step]]
do = "read"
file = "{DATA / 'bracket-tangled.vtu'}"
[[step]]
do = "criteria"
criteria = "fem"
stop = false
[[step]]
do = "untangle"
effort = "Thorough"
[[step]]
do = "optimize"
preset = "best shape"
[[step]]
do = "warp"
transform = {{ bend = 10.0 }}
[[step]]
do = "report"
file = "report.html"
before = "input"
[[step]]
do = "write"
file = "better.vtu"
"""


def with_steps(text: str) -> Path:
    file = FOLDER / "steps.toml"
    file.write_text(text)
    return file


def wrong(text: str, step: str, *before: str) -> None:
    """A step that is wrong after `read`: rejected before anything is written."""
    (FOLDER / "better.vtu").unlink(missing_ok=True)
    head = f'[[step]]\ndo = "read"\nfile = "{DATA / "plate.vtu"}"\n[[step]]\ndo = "write"\nfile = "better.vtu"\n'
    rejected(text, tl.run_steps, with_steps(head + "[[step]]\n" + step))
    assert not (FOLDER / "better.vtu").exists(), "a step was run before all were checked"


def test_run():
    result = tl.run_steps(with_steps(STEPS))
    valid = tl.untangle(DATA / "bracket-tangled.vtu", "thorough")
    bent = tl.warp(tl.optimize(valid, preset="best shape"), transform={"bend": 10.0})
    assert (points(result.mesh) == points(bent.mesh)).all()
    assert [type(r).__name__ for r in result.results] == ["QualityResult", "UntangleResult", "OptimizeResult",
                                                          "WarpResult"]  # fmt: skip
    assert not result.passed and result.results[0].verdict == "failed"
    assert result.files == [str(FOLDER / "report.html"), str(FOLDER / "better.vtu")]
    assert wording("before-and-after") in (FOLDER / "report.html").read_text()
    assert (points(tl.read(FOLDER / "better.vtu")) == points(bent.mesh)).all()
    lines = result.summary.splitlines()
    assert len(lines) == 7 and lines[2] == f"3 untangle: {valid.summary.splitlines()[0]}", lines


def test_stop():
    (FOLDER / "better.vtu").unlink(missing_ok=True)
    stopped = tl.run_steps(with_steps(STEPS.replace("stop = false", "stop = true")))
    assert not stopped.passed and len(stopped.results) == 1 and wording("were-not-run") in stopped.summary
    assert not (FOLDER / "better.vtu").exists()
    assert tl.run_steps(with_steps(STEPS), check_only=True) is None and not (FOLDER / "better.vtu").exists()


def test_checks():
    wrong("step 3: there is no step 'untangel'; did you mean 'untangle'?", 'do = "untangel"')
    wrong("step 3: there is no key 'efort'; did you mean 'effort'?", 'do = "untangle"\nefort = "local"')
    wrong("step 3: effort is 'thorugh' (did you mean 'thorough'?)", 'do = "untangle"\neffort = "thorugh"')
    wrong("step 3: preset is 'best'", 'do = "optimize"\npreset = "best"')
    wrong("step 3: there is no key 'maximum_iteration'; did you mean 'maximum_iterations'?",
          'do = "optimize"\nmaximum_iteration = 3')  # fmt: skip
    wrong("step 3: time_limit is 'long'; a number is expected", 'do = "untangle"\ntime_limit = "long"')
    wrong("step 3: straighten is 1; true or false", 'do = "untangle"\nstraighten = 1')
    wrong("stop is 3; true or false", 'do = "criteria"\ncriteria = "fem"\nstop = 3')
    wrong("step 3: the key criteria is missing", 'do = "criteria"')
    wrong("step 3: there is no preset of quality criteria 'femm'; did you mean 'fem'?",
          'do = "criteria"\ncriteria = "femm"')  # fmt: skip
    wrong("limits.json: there is no such file", 'do = "report"\nfile = "r.html"\ncriteria = "limits.json"')
    wrong("step 3: There is no metric 'imrr'", 'do = "quality"\nmetrics = ["imrr"]')
    wrong("step 3: the key file is missing", 'do = "report"')
    wrong("step 3: the key do is missing", 'file = "x.vtu"')
    wrong("absent.vtu: there is no such file", 'do = "warp"\ntarget = "absent.vtu"')
    wrong("no writer for '.xyz'", 'do = "write"\nfile = "a.xyz"')
    wrong("there is no directory", 'do = "write"\nfile = "absent/a.vtu"')
    wrong("steps.toml: ", "do = ")
    rejected(wording("there-are-no-steps"), tl.run_steps, with_steps(""))
    rejected(wording("there-is-no-key-of-the-file"), tl.run_steps, {"steps": []})
    rejected(wording("the-first-step-has-to-be-read"), tl.run_steps, {"step": [{"do": "untangle"}]})
    rejected(wording("there-is-no-such-file"), tl.run_steps, FOLDER / "absent.toml")
    # Errors that only the run can find also have the number of the step.
    rejected(wording("step-2-warp-nothing-is-given"), tl.run_steps,
            {"step": [{"do": "read", "file": str(DATA / "plate.vtu")}, {"do": "warp"}]})  # fmt: skip
    # Lists are taken where a function takes them.
    read = {"do": "read", "file": str(DATA / "plate.vtu")}
    tl.run_steps({"step": [read, {"do": "quality", "metrics": ["imr"], "size": 0.1},
                           {"do": "warp", "transform": {"rotate": 5}, "moved": [1], "values": [1.0]}]},
                 check_only=True)  # fmt: skip
    # A file that an earlier step writes may be read.
    made = str(FOLDER / "made.vtu")
    tl.run_steps({"step": [{"do": "read", "file": str(DATA / "plate.vtu")}, {"do": "perturb", "seed": 4},
                           {"do": "write", "file": made}, {"do": "read", "file": made}]})  # fmt: skip
    assert (points(tl.read(made)) == points(tl.perturb(DATA / "plate.vtu", seed=4).mesh)).all()


def test_shell():
    file = with_steps(STEPS)
    text = shell("run", file, code=3)
    assert wording("3-untangle-all-elements-are-valid") in text and str(FOLDER / "better.vtu") in text, text
    assert shell("run", file, "--check") == "the steps are correct\n"
    facts = json.loads(shell("run", file, "--json", code=3))
    assert facts["results"][1]["inverted_before"] == 41 and not facts["passed"], facts.keys()
    assert wording("did-you-mean-step") in shell("run", with_steps("[[stp]]\n"), code=1)


if sys.version_info < (3, 11):
    print("skipped: needs Python 3.11")
    sys.exit(SKIPPED)
run_tests(globals())
