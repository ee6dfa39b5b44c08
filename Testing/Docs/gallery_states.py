# SPDX-License-Identifier: BSD-3-Clause
"""pvpython gallery_states.py PLUGIN EXAMPLES OUTPUT: the filters that the gallery names for ParaView take its meshes.

EXAMPLES is python/examples, OUTPUT has a folder with before.vtu for each of them, which their tests write.
"""

import re
import sys
from pathlib import Path

from paraview import simple

simple.LoadPlugin(sys.argv[1], remote=False, ns=globals())
LEAST = 20  # examples that are shown in ParaView
MOST_BYTES = 40_000  # of a picture
EXAMPLES = 30  # at least

folder, output = Path(sys.argv[2]), Path(sys.argv[3])
scripts = sorted(folder.glob("[0-9]*.py"))
assert len(scripts) >= EXAMPLES, len(scripts)
count = 0
for script in scripts:
    text = script.read_text(encoding="utf-8")
    for label in ("Look at", "Picture"):
        assert re.search(rf"^{label}: .+$", text, re.MULTILINE), f"{script.name} has no line '{label}:'"
    size = (folder / "pictures" / f"{script.stem}.png").stat().st_size
    assert 0 < size <= MOST_BYTES, f"the picture of {script.name} has {size} bytes"
    state = re.search(r"^State: (.+)$", text, re.MULTILINE)
    if state is None:
        continue
    before = simple.OpenDataFile(str(output / script.stem / "before.vtu"))
    after = eval(state[1], {**globals(), **vars(simple), "before": before})
    after.UpdatePipeline()
    cells = after.GetDataInformation().GetNumberOfCells()
    print(script.stem, state[1], cells, flush=True)
    assert cells > 0 or "SolverStudy" in state[1], script.name
    simple.Delete(after)
    simple.Delete(before)
    count += 1
assert count >= LEAST, count
