# SPDX-License-Identifier: BSD-3-Clause
"""Common features of all commands: help with an example that runs, --json, --quiet, pipes, the progress bar, exit
codes."""

import json
import os
import pty
import re
import shutil
import subprocess
import sys

import tautline as tl
from checks import DATA, OUT, points, run_tests, shell, slow, square, wording
from tautline.__main__ import _parser

FOLDER = OUT / "shell"
COMMANDS = [name for name in _parser()._subparsers._group_actions[0].choices if name not in ("study", "field", "help")]
BAR = re.compile(r"\[#*\.*\] +\d+% \d+ s ")


def piped(*commands, code: int = 0):
    """Commands with pipes between them; the output of the last one, and all of stderr."""
    content, errors = None, ""
    for arguments in commands:
        line = [sys.executable, "-m", "tautline", *map(str, arguments)]
        done = subprocess.run(line, input=content, capture_output=True, cwd=FOLDER)
        content, errors = done.stdout, errors + done.stderr.decode()
    assert done.returncode == code, (commands, errors)
    return content, errors


def on_terminal(*arguments) -> str:
    """The output of a command on stderr if that is a terminal."""
    main, other = pty.openpty()
    line = [sys.executable, "-m", "tautline", *map(str, arguments)]
    child = subprocess.Popen(line, cwd=FOLDER, stdout=subprocess.PIPE, stderr=other)
    os.close(other)
    seen = b""
    while True:
        try:
            part = os.read(main, 4096)
        except OSError:  # the end, on Linux
            break
        if not part:
            break
        seen += part
    child.communicate()
    os.close(main)
    assert child.returncode == 0, seen
    return seen.decode()


def test_examples():
    """Every help has a description, and an example that runs on meshes of these names."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    tl.write(tl.untangle(DATA / "bracket-tangled.vtu"), FOLDER / "part.vtu")
    shutil.copy(DATA / "bracket-tangled.vtu", FOLDER / "tangled.vtu")
    tl.write(tl.perturb(FOLDER / "part.vtu", fraction=0.2), FOLDER / "better.vtu")
    tl.write(square(6), FOLDER / "triangles.vtu")
    tl.write(tl.interaction_layer(square(6), 0.2), FOLDER / "square.vtu")
    for name in ("plate.vtu", "plate.poly", "cube.smesh", "fish.png", "fish-bent.png"):
        shutil.copy(DATA / name, FOLDER / name)
    (FOLDER / "steps.toml").write_text("""[[step]]
do = "read"
file = "tangled.vtu"
[[step]]
do = "untangle"
""")
    (FOLDER / "silhouettes.csv").write_text("file,class\nfish.png,fish\nfish-bent.png,fish\n")
    assert len(COMMANDS) >= 20
    for command in COMMANDS:
        text = shell(command, "--help")
        assert wording("exit-codes-see") in text and "--json" in text and "--quiet" in text, text
        example = re.search(r"^example:\n  python3 -m tautline (.*)$", text, re.MULTILINE)[1]
        done = subprocess.run(f"{sys.executable} -m tautline {example}", shell=True, cwd=FOLDER, capture_output=True,
                              text=True)  # fmt: skip
        assert done.returncode in ((0, 3) if command == "report" else (0,)), (example, done.stderr)
        assert done.stdout and not done.stderr, (example, done.stderr)
        for file in re.findall(r"(?:-o|--csv) (\S+)", example):
            assert file in done.stdout and (FOLDER / file).stat().st_size > 0, (example, done.stdout)
    text = shell("--help")
    assert all(f"\n  {code} " in text for code in (0, 1, 2, 3, 130)), text
    shell("field", "--dimensions", 3, 3, 1, "-o", FOLDER / "old-name.vti")


@slow
def test_json_and_quiet():
    lines = {
        "quality": ["part.vtu", "-o", "q.vtu"], "criteria": ["fem"], "perturb": ["part.vtu", "-o", "p.vtu"],
        "compare": ["plate.vtu", "turned.vtu"], "report": ["plate.vtu", "-o", "r.html"],
        "metric-field": ["-o", "f.vti", "--dimensions", "5", "4", "1"], "metrics": [], "optimize": ["plate.vtu", "-o",
        "o.vtu"], "untangle": ["tangled.vtu", "-o", "u.vtu"], "improve": ["part.vtu", "-o", "i.vtu"],
        "warp": ["plate.vtu", "--rotate", "9", "-o", "w.vtu"], "silhouette": ["fish.png", "-o", "s.vtu"],
        "match": ["fish.png", "fish-bent.png", "--locations", "contour"], "retrieval": ["silhouettes.csv"],
        "solve": ["plate.vtu", "-o", "so.vtu"], "condition": ["plate.vtu"], "solver-study": ["plate.vtu",
        "--combinations", "1"], "peridynamics": ["square.vtu"], "interaction-layer": ["triangles.vtu", "-o", "l.vtu"],
        "domain": ["rectangle", "--cells", "100", "-o", "d.vtu"], "convert": ["plate.vtu", "c.vtk"],
        "triangle-mesh": ["plate.poly", "-o", "t.vtu"], "tet-mesh": ["cube.smesh", "-o", "te.vtu"],
        "horizon-neighbors": ["square.vtu"], "metric": ["plate.vtu", "-o", "m.vtu"],
        "transfer": ["plate.vtu", "plate.vtu", "-o", "f.vtu"],
        "adapt": ["triangles.vtu", "--iterations", "1", "-o", "a.vtu"],
        "run": ["steps.toml"], "formats": [], "info": ["plate.vtu"],
    }  # fmt: skip
    for command in COMMANDS:
        arguments = lines[command]
        facts = json.loads(shell(command, *arguments, "--json", folder=FOLDER))
        assert facts, command
        if "-o" in arguments or command == "convert":
            assert facts["files"] == [arguments[arguments.index("-o") + 1] if "-o" in arguments else "c.vtk"], facts
        assert shell(command, *arguments, "--quiet", folder=FOLDER) == "" or command == "criteria", command
    assert set(COMMANDS) <= set(lines), set(COMMANDS) - set(lines)
    facts = json.loads(shell("untangle", "tangled.vtu", "-o", "u.vtu", "--json", folder=FOLDER))
    result = tl.untangle(FOLDER / "tangled.vtu")
    assert facts["inverted_before"] == result.inverted_before == 41 and facts["inverted"] == 0
    assert facts["history"]["inverted"] == result.history["inverted"].tolist()


def test_pipes():
    content, errors = piped(("untangle", "tangled.vtu", "-o", "-"), ("optimize", "-", "-o", "-"))
    (FOLDER / "piped.vtu").write_bytes(content)
    valid = tl.untangle(FOLDER / "tangled.vtu")
    assert (points(tl.read(FOLDER / "piped.vtu")) == points(tl.optimize(valid).mesh)).all()
    assert wording("all-elements-are-valid-2") in errors and wording("inverse-mean-ratio-mean-2") in errors, errors
    content, errors = piped(("convert", "plate.vtu", "-"), ("quality", "-", "--json"))
    assert json.loads(content)["inverted"] == 0 and errors.startswith("1190 points"), errors
    content, _ = piped(("quality", "plate.vtu", "--quiet", "--csv", "-"))
    assert content.decode().startswith("metric,") and content.count(b"\n") == 2
    content, errors = piped(("perturb", "plate.vtu", "-o", "-", "-q"))
    assert not errors and content.startswith(b"<")
    # A surface becomes a grid; what is no mesh, or empty, is an error.
    tl.write(square(3), FOLDER / "b.off")
    content, _ = piped(("convert", "b.off", "-"), ("convert", "-", "back.vtu"))
    assert tl.read(FOLDER / "back.vtu").GetNumberOfCells() == tl.read(FOLDER / "b.off").GetNumberOfCells()
    assert wording("the-file-is-empty") in piped(("quality", "-"), code=1)[1]
    assert wording("would-all-write-to-the-standard") in piped(("perturb", "plate.vtu", "-o", "-", "--json"), code=1)[1]
    assert wording("cannot-both-be-the-standard-input") in piped(("compare", "-", "-"), code=1)[1]
    assert wording("cannot-hold") in piped(("metric-field", "-o", "f.vtp"), code=1)[1]


def test_progress_bar():
    """On a terminal, for what takes long; erased at the end; never with --quiet or without a terminal."""
    work = ("domain", "cylinder", "--cells", 200000, "-o", "c.vtu")
    seen = on_terminal(*work)
    assert BAR.search(seen), repr(seen[:300])
    assert seen.endswith("\r\x1b[K"), repr(seen[-80:])
    assert on_terminal(*work, "--quiet") == ""
    assert piped(work)[1] == ""
    # In Python: nothing where stderr is no terminal; other values are rejected.
    assert tl.perturb(FOLDER / "plate.vtu", progress=True) == tl.perturb(FOLDER / "plate.vtu")
    assert tl.perturb(FOLDER / "plate.vtu", progress=False).moved > 0
    try:
        tl.perturb(FOLDER / "plate.vtu", progress=3)
        raise AssertionError("progress=3 was accepted")
    except tl.Error as error:
        assert wording("true-or-a-function-is-expected") in str(error)


run_tests(globals())
