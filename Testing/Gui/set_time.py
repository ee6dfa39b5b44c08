# SPDX-License-Identifier: BSD-3-Clause
"""set_time.py JUNIT [PROCESSES]: how long the tests of ParaView's window take, from the file of `ctest --output-junit`.

Prints the sum of their times, and its part for each of the PROCESSES that `ctest -j` ran at a time (2 if not given).
Exits with 1 if that is more than the limit of the whole set.
"""

import sys
import xml.etree.ElementTree as ElementTree

LIMIT = 360.0  # seconds
SETS = ("Gui.", "GuiServer.", "GuiServer2.")

processes = int(sys.argv[2]) if len(sys.argv) > 2 else 2
times = {test.get("name", ""): float(test.get("time", 0)) for test in ElementTree.parse(sys.argv[1]).iter("testcase")}
window = {name: time for name, time in times.items() if name.startswith(SETS)}
if window:
    total = sum(window.values())
    share = total / processes
    slowest = ", ".join(f"{name} {window[name]:.0f} s" for name in sorted(window, key=window.get, reverse=True)[:3])
    print(f"GUI tests: {len(window)}, {total:.0f} s in all, {share:.0f} s with {processes} at a time "
          f"(limit {LIMIT:.0f} s); longest: {slowest}")  # fmt: skip
    if share > LIMIT:
        sys.exit(f"The GUI tests take more than {LIMIT:.0f} s: join sessions, or make their work smaller.")
