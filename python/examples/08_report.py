# SPDX-License-Identifier: BSD-3-Clause
"""Write a report.

One HTML file with pictures, histograms and tables, before and after. It needs no display.

Shell: tautline optimize before.vtu -o after.vtu
Shell: tautline report after.vtu --before before.vtu -o report.html
Look at: the file in a browser.
Picture: imr clip
"""

import sys
from pathlib import Path

import tautline as tl

data = Path(sys.argv[1] if len(sys.argv) > 1 else "Data")
tangled = data / "bracket-tangled.vtu"
tl.write(tangled, "before.vtu")
tl.write(tl.optimize("before.vtu"), "after.vtu")
tl.report("after.vtu", "report.html", before="before.vtu")
text = Path("report.html").read_text(encoding="utf-8")
print("report.html has", len(text), "characters")
assert "<svg" in text or "<img" in text
