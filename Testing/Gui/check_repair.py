# SPDX-License-Identifier: BSD-3-Clause
"""check_repair.py MESH REPORT: the report of the session JobRepair has the quality that the package tautline finds."""

import re
import sys
from pathlib import Path

import tautline as tl

mesh, report = sys.argv[1:]
untangled = tl.untangle(mesh).mesh
before = tl.quality(untangled, ["imr"])
after = tl.quality(tl.optimize(untangled).mesh, ["imr"])
assert before.inverted == after.inverted == 0

text = Path(report).read_text(encoding="utf-8")
found = re.search(r"Inverse mean ratio: mean (\S+) to (\S+), worst (\S+) to (\S+)\.(?:\s|<)", text)
assert found, "no sentence on the inverse mean ratio"
numbers = [float(number) for number in found.groups()]
expected = [m.statistics["imr"][key] for key in ("mean", "worst") for m in (before, after)]
for number, right in zip(numbers, expected):
    assert abs(number - float(right)) <= 1e-4 * float(right), (numbers, expected)
assert expected[3] < expected[2], "the worst element became worse"
print(f"worst {numbers[2]} to {numbers[3]}")
