# SPDX-License-Identifier: BSD-3-Clause
"""pvpython gallery_states.py PLUGIN EXAMPLES OUTPUT: the lines "State:" of the gallery make what the scripts write.

EXAMPLES is python/examples, OUTPUT has a folder with the files of each script, which their tests write. The state of
the page is run there, and the mesh that it shows is compared with after.vtu, or the table of a study with study.csv.
"""

import csv
import os
import sys
from pathlib import Path

import tautline as tl
from gallery_arrays import differences, parts_of, state_of
from paraview import servermanager, simple

NAMES = dict(vars(simple))  # and the names of the plugin's proxies
simple.LoadPlugin(sys.argv[1], remote=False, ns=NAMES)
LEAST = 20  # examples that are shown in ParaView
MOST_BYTES = 40_000  # of a picture
EXAMPLES = 30  # at least
#: Columns of the table of a solver study that are compared: their names in study.csv, and in ParaView.
STUDY = {"number": "N combination", "iterations": "N iterations", "converged": "N converged"}
NUMBERS = {"True": 1, "False": 0}


def table_differences(study, file: Path) -> list[str]:
    """How the table of a solver study differs from the script's, which has other names for the columns."""
    study.UpdatePipeline()
    table = study.GetClientSideObject().GetOutputDataObject(1)
    columns = [table.GetColumnByName(name) for name in STUDY.values()]
    found = [[int(column.GetValue(row)) for column in columns] for row in range(table.GetNumberOfRows())]
    with file.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    expected = [[int(NUMBERS.get(row[name], row[name])) for name in STUDY] for row in rows]
    return [] if found == expected else [f"the study has {found} instead of {expected}"]


def shown(source):
    """The data of a filter at the time of the view."""
    source.UpdatePipeline(simple.GetTimeKeeper().Time)
    return servermanager.Fetch(source)


def check(script: Path, output: Path) -> list[str]:
    """The errors of the state of an example."""
    title, _, lines = parts_of(script.read_text(encoding="utf-8"))
    names = {**NAMES}
    os.chdir(output)
    exec(state_of(title, lines["State"][0]), names)
    if (output / "study.csv").exists():
        return table_differences(names["after"], output / "study.csv")
    return differences(shown(names["after"]), tl.read(output / "after.vtu"))


def main(examples: Path, output: Path) -> None:
    scripts = sorted(examples.glob("[0-9]*.py"))
    assert len(scripts) >= EXAMPLES, len(scripts)
    count, wrong = 0, []
    for script in scripts:
        _, _, lines = parts_of(script.read_text(encoding="utf-8"))
        for label in ("Look at", "Picture"):
            assert label in lines, f"{script.name} has no line '{label}:'"
        size = (examples / "pictures" / f"{script.stem}.png").stat().st_size
        assert 0 < size <= MOST_BYTES, f"the picture of {script.name} has {size} bytes"
        if "State" in lines:
            print(script.stem, lines["State"][0], flush=True)
            wrong += [f"{script.name}: {line}" for line in check(script, output / script.stem)]
            simple.ResetSession()
            count += 1
    assert not wrong, "\n".join(wrong)
    assert count >= LEAST, count


main(*(Path(argument).resolve() for argument in sys.argv[2:]))
