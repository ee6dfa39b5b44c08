# SPDX-License-Identifier: BSD-3-Clause
"""Conventions of the shell: help, version, info, several files, the output as the last argument, exit codes."""

import contextlib
import io
import json
import os
import re

import tautline as tl
from checks import DATA, OUT, run_tests, wording
from checks import shell as process
from tautline.__main__ import _parser, main

PLATE, TANGLED = DATA / "plate.vtu", DATA / "bracket-tangled.vtu"
FOLDER = OUT / "habits"
FOLDER.mkdir(exist_ok=True)


def shell(*arguments, code: int = 0, folder=None) -> str:
    """The output of a command in this process; checks the exit code, and that stderr is empty after success."""
    here = os.getcwd()
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as errors:
        os.chdir(folder or here)
        try:
            found = main(list(map(str, arguments)))
        except SystemExit as end:
            found = end.code or 0
        finally:
            os.chdir(here)
    assert found == code, (arguments, found, out.getvalue(), errors.getvalue())
    assert code or not errors.getvalue(), (arguments, errors.getvalue())
    return out.getvalue() + errors.getvalue()


def commands() -> dict:
    return dict(next(a for a in _parser()._actions if isinstance(a.choices, dict)).choices)


def test_help() -> None:
    """help and -V; the commands in groups, the five main ones first; every command is in one group."""
    text = shell("help")
    assert process("-V") == f"tautline {tl.__version__}\n" and process("help", "quality").startswith("usage: ")
    assert shell("-V") == shell("--version") and text == shell("--help")
    assert shell("help", "QUALITY") == shell("quality", "--help")
    listed = re.findall(r"^    ([a-z-]+) ", text, re.MULTILINE)
    assert listed[:5] == ["info", "quality", "untangle", "optimize", "convert"]
    assert sorted(name for name in listed if not name.startswith("-")) == sorted(set(commands()) - {"field"})
    assert wording("did-you-mean-quality") in shell("help", "qualty", code=2)
    assert wording("did-you-mean-quality") in shell("qualty", code=2)


def test_help_all() -> None:
    """--help has the most used options, and the number of further ones; --help-all has all."""
    for name, parser in commands().items():
        if name in ("help", "study"):
            continue
        text = parser.format_help()
        parser._shows_all = True
        full = parser.format_help()
        shown = [action for action in parser._actions if action.help != "==SUPPRESS=="]
        options = {option for action in shown for option in action.option_strings}
        assert all(option in full for option in options), name
        more = re.search(r"^(\d+) more options: .* --help-all$", text, re.MULTILINE)
        head = text.partition("\nexample:")[0].partition("\noptions:")[2]
        words = set(re.findall(r"(?<!\S)--?[\w-]+", head))
        left_out = sum(not words.intersection(a.option_strings) for a in shown if a.option_strings)
        assert left_out == (int(more[1]) if more else 0), (name, left_out, more)
        assert text.startswith("usage: ") and text.splitlines()[1] == "", text.splitlines()[:2]
    assert "--culling" not in shell("optimize", "--help") and "--culling" in shell("optimize", "--help-all")
    assert len(shell("optimize", "--help").splitlines()) < 60


def test_errors() -> None:
    """One line of usage and one of the error; unknown names end with 2, files that are absent with 1."""
    for line in (["optimize"], ["quality"], ["optimize", PLATE], ["untangle", "a", "b", "c"], ["compare", PLATE], [],
                 ["optimize", PLATE, "x.vtu", "--boundry", "free"], ["quality", PLATE, "--worst", "many"]):  # fmt: skip
        text = shell(*line, code=2)
        assert len(text.splitlines()) == 2 and text.startswith("usage: ") and ": error: " in text, text
    assert wording("did-you-mean-boundary") in shell("optimize", PLATE, "x.vtu", "--boundry", "free", code=2)
    for line in (["quality", PLATE, "--metrics", "imrr"], ["quality", PLATE, "--criteria", "fen"], ["criteria", "fen"],
                 ["optimize", PLATE, "x.vtu", "--objective", "imrr"], ["improve", TANGLED, "x.vtu", "--metric", "nope"],
                 ["optimize", PLATE, "x.vtu", "--worst-metric", "imrr"], ["study", "nope"],
                 ["domain", "sqare", "x.vtu"],
                 ["solver-study", PLATE, "--combinations", "nope"], ["solve", PLATE, "--solver", "gc"],
                 ["metric-field", "f.vti", "--metrics", "nope"], ["report", PLATE, "r.html", "--criteria", "fen"],
                 ["quality", PLATE, TANGLED, "-o", "x.vtu"],
                 ["quality", PLATE, TANGLED, "--metrics", "imrr"]):  # fmt: skip
        text = shell(*line, code=2, folder=FOLDER)
        assert "Traceback" not in text and len(text.splitlines()) <= 2, text
    assert process("quality", code=2) == shell("quality", code=2).replace("test_habits.py", "python3 -m tautline")
    shell("quality", "absent.vtu", code=1)
    shell("quality", PLATE, "--criteria", "absent.json", code=1)


def test_output() -> None:
    """The file to write is -o or the last argument, before and after options, of every command that writes one."""
    given = FOLDER / "with-option.vtu"
    shell("optimize", PLATE, "-o", given, "--preset", "best shape")
    for line in (["optimize", PLATE, "out.vtu", "--preset", "best shape"],
                 ["optimize", PLATE, "--preset", "best shape", "out.vtu"],
                 ["optimize", "--preset", "best shape", PLATE, "out.vtu"]):  # fmt: skip
        (FOLDER / "out.vtu").unlink(missing_ok=True)
        assert "out.vtu" in shell(*line, folder=FOLDER)
        assert tl.compare(given, FOLDER / "out.vtu").displacement.max() == 0
    for line in (["convert", PLATE, "c.vtk"], ["convert", PLATE, "-o", "c.vtk"], ["convert", "-o", "c.vtk", PLATE]):
        (FOLDER / "c.vtk").unlink(missing_ok=True)
        shell(*line, folder=FOLDER)
        assert tl.read(FOLDER / "c.vtk").GetNumberOfCells() == 1913
    shell("report", PLATE, "r.html", folder=FOLDER)
    shell("domain", "square", "d.vtu", folder=FOLDER)
    shell("solve", PLATE, "s.vtu", folder=FOLDER)
    assert all((FOLDER / name).stat().st_size for name in ("r.html", "d.vtu", "s.vtu"))
    shell("optimize", PLATE, "x.vtu", "-o", "y.vtu", code=2)
    for name, parser in commands().items():
        if (output := getattr(parser, "output_action", lambda: None)()) is not None and not parser.takes_more:
            assert "OUTPUT" in parser.short_usage() and ("[OUTPUT]" in parser.short_usage()) != output.required, name


def test_several_files() -> None:
    """A row per mesh; exits with 3 if one fails, with 1 if one cannot be read, and shows the others."""
    tl.write(tl.optimize(PLATE), FOLDER / "good.vtu")
    good = FOLDER / "good.vtu"
    text = shell("quality", PLATE, "--metrics", "imr", TANGLED, "--csv", FOLDER / "several.csv")
    rows = text.splitlines()[2:4]
    assert str(PLATE) in rows[0] and str(TANGLED) in rows[1] and " 41 " in rows[1], text
    lines = (FOLDER / "several.csv").read_text().splitlines()
    assert lines[0].startswith("file,cells,inverted,") and len(lines) == 3
    shell("quality", good, good, "--criteria", "skewness")
    text = shell("quality", good, TANGLED, "--criteria", "skewness", code=3)
    assert "failed" in text and "verdict" in text and shell("quality", TANGLED, "--criteria", "skewness", code=3)
    text = shell("quality", PLATE, "absent.vtu", TANGLED, "--criteria", "fem", code=1)
    assert str(TANGLED) in text and wording("there-is-no-such-file") in text
    facts = json.loads(shell("quality", PLATE, TANGLED, "--json"))["meshes"]
    assert [mesh["inverted"] for mesh in facts] == [0, 41] and facts[1]["file"] == str(TANGLED)


def test_info() -> None:
    """Counts, types, bounds, regions, arrays and quality in at most ten lines; also of no elements, and of blocks."""
    mesh = tl.read(PLATE)
    mesh.cell_data["Material"] = [1 + (i > 900) for i in range(1913)]
    mesh.point_data["Velocity"] = mesh.points
    tl.write(mesh, FOLDER / "info.vtu")
    text = shell("info", FOLDER / "info.vtu")
    assert len(text.splitlines()) <= 10, text
    for words in ("1190", "1913: 288 quadrilaterals, 1625 triangles", "x -5 to 5, y -3 to 3", "Material 1, 2",
                  "Velocity (float64 x 3)", "1 connected piece", "0 inverted", "worst: element 622"):  # fmt: skip
        assert words in text, (words, text)
    facts = json.loads(shell("info", FOLDER / "info.vtu", "--json"))
    assert facts["types"] == {"quadrilateral": 288, "triangle": 1625} and facts["regions"] == {"Material": [1, 2]}
    assert facts["bounds"] == [[-5, 5], [-3, 3], [0, 0]] and facts["quality"]["inverted"] == 0
    assert "41 inverted" in shell("info", TANGLED)
    for name in ("house.off", "zoo.mesh", "quadratic.1.ele", "box.poly", "cube.1.node", "plate.poly"):
        text = shell("info", DATA / name)
        assert len(text.splitlines()) <= 10 and "points" in text, text
    text = shell("info", PLATE, "absent.vtu", TANGLED, code=1)
    assert wording("there-is-no-such-file") in text and "8140" in text and "1913" in text
    assert len(json.loads(shell("info", PLATE, TANGLED, "--json"))["meshes"]) == 2


run_tests(globals())
