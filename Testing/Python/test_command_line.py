# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m tautline: exit codes, tables and files against the results of the functions."""

import csv
import json

import tautline as tl
from checks import DATA, OUT, shell as run, wording

MESH, PLATE = DATA / "bracket-tangled.vtu", DATA / "plate.vtu"


# help and usage
text = run("--help")
assert all(f"    {name} " in text for name in ("quality", "perturb", "compare", "metric-field", "metrics")), text
assert "COMMAND" in run(code=2) and wording("invalid-choice-paint") in run("paint", code=2)
assert wording("required-file") in run("quality", code=2)
assert wording("invalid-float-value-x") in run("perturb", PLATE, "-o", OUT / "cli.vtu", "--fraction", "x", code=2)

# quality
mesh, table = OUT / "cli-quality.vtu", OUT / "cli-quality.csv"
text = run("quality", MESH, "--metrics", "imr,rr", "--worst", 2, "-o", mesh, "--csv", table)
result = tl.quality(MESH, ["imr", "rr"])
assert wording("8140-cells-8099-valid-41-inverted-0") in text, text
assert text.count("worst cell") == 2 and text.splitlines()[-2:] == [str(mesh), str(table)], text
assert f"{result.statistics['imr']['mean']:.5g}" in text
assert (tl.quality(mesh).values["imr"] == result.values["imr"]).all()
with open(table, newline="") as lines:
    rows = list(csv.DictReader(lines))
assert [row.pop("metric") for row in rows] == ["imr", "rr"]
for row, facts in zip(rows, result.statistics.values()):
    assert int(row.pop("worst_cell")) == facts["worst_cells"][0]
    assert row.pop("label") == facts["label"]
    for key, value in row.items():
        assert float(value) == facts[key], key
assert wording("no-metric-nope") in run("quality", MESH, "--metrics", "nope", code=2)
assert run("quality", "absent.vtu", code=1) == "tautline: absent.vtu: there is no such file\n"
assert wording("cannot-be-written") in run("quality", PLATE, "--csv", OUT / "absent" / "x.csv", code=1)
run("quality", PLATE, "--metrics", "mu_size", "--size", "0.03")
assert wording("no-array-h") in run("quality", PLATE, "--size", "h", code=1)

# criteria: the exit code is the verdict, and --json prints nothing but JSON
rules = OUT / "cli-criteria.json"
rules.write_text(run("criteria", "fem"))
assert wording("failed-by-the-criteria") in run("quality", MESH, "--criteria", rules, code=3)
facts = json.loads(run("quality", MESH, "--criteria", "fem", "--json", code=3))
graded = tl.quality(MESH, criteria="fem")
assert facts["verdict"] == "failed" and facts["index"] == graded.index and facts["inverted"] == 41
assert facts["criteria"]["imr"]["failed"] == graded.criteria["imr"]["failed"] > 0
assert facts["statistics"]["imr"]["worst_cells"] == graded.statistics["imr"]["worst_cells"].tolist()
loose = json.loads(rules.read_text())
loose["criteria"] = [{"metric": "equiangle_skew", "limits": {"all": dict(ideal=0, good=1, warn=1, fail=1, worst=2)}}]
rules.write_text(json.dumps(loose))
assert wording("passed-by-the-criteria") in run("quality", PLATE, "--criteria", rules)
assert wording("neither-a-file") in run("quality", PLATE, "--criteria", "absent.json", code=1)
assert wording("did-you-mean-fem") in run("criteria", "fen", code=2)

# perturb, compare, field
moved = OUT / "cli-perturbed.vtu"
assert wording("0-before-19-after") in run("perturb", PLATE, "-o", moved, "--tangle", 0.01, "--seed", 3)
assert (tl.quality(moved).values["imr"] == tl.quality(tl.perturb(PLATE, tangle=0.01, seed=3)).values["imr"]).all()
table = OUT / "cli-compare.csv"
text = run("compare", PLATE, moved, "--csv", table)
facts = tl.compare(PLATE, moved).statistics["imr"]
assert wording("inverted-0-before-19-after") in text, text
with open(table, newline="") as lines:
    assert [int(row["worse"]) for row in csv.DictReader(lines)] == [facts["worse"]]
run("compare", PLATE, MESH, code=1)
image = OUT / "cli-field.vti"
run("field", "-o", image, "--metrics", "imr,si", "--dimensions", 7, 5, 1)
assert tl.read(image).GetPointData().HasArray("si")

# metrics
facts = tl.metrics()
assert len(run("metrics").splitlines()) == len(facts) + 2
assert len(run("metrics", "--markdown").splitlines()) == len(facts) + 2
assert [f["name"] for f in json.loads(run("metrics", "--json"))] == [f["name"] for f in facts]
