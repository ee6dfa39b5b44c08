# SPDX-License-Identifier: BSD-3-Clause
"""ranks.py PVBATCH [--cells N] [--ranks 1,2] [--filters quality,...]: filters on MPI ranks against one process.

Prints for each filter and number of ranks the peak memory of a rank (VmHWM of the filter's execution, with the input
and ParaView itself), CPU seconds of all ranks, and both relative to one rank. CPU seconds count what a rank does while
it waits for another, as MPI waits in a loop: the most of a rank is the time that an idle machine with as many cores
would take. The environment names the plugin: eval "$(./run env)" sets PV_PLUGIN_PATH.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
FILTERS = ("quality", "optimize", "optimize-first", "optimize-first-redistributed", "untangle", "warp", "solve",
           "solve-first", "solve-first-redistributed", "condition", "condition-first", "condition-first-redistributed",
           "perturb", "improve")  # fmt: skip
MOST_MEMORY = 0.6  # of one process, for each of two ranks
SECONDS = 3600


def run(pvbatch: str, ranks: int, name: str, cells: int) -> list[dict]:
    """The resources that each rank needed."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_MCA_btl_vader_single_copy_mechanism="none")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found"
        command = [] if ranks == 1 else ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)]
        command += [pvbatch, "--symmetric", str(HERE / "rank_filter.py"), name, str(cells), str(file)]
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=SECONDS)  # fmt: skip
        files = [Path(f"{file}.{rank}") for rank in range(ranks)]
        if done.returncode != 0 or not all(f.exists() for f in files):
            sys.exit(f"{name} on {ranks} ranks has failed:\n{done.stdout}")
        return [json.loads(f.read_text(encoding="utf-8")) for f in files]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pvbatch")
    parser.add_argument("--cells", type=int, default=2_000_000)
    parser.add_argument("--ranks", default="1,2")
    parser.add_argument("--filters", default=",".join(FILTERS))
    options = parser.parse_args()
    if not shutil.which("mpirun"):
        print("there is no mpirun")
        return 77
    plugin = Path(os.environ.get("PV_PLUGIN_PATH", "")) / "Tautline" / "Tautline.so"
    os.environ.setdefault("TAUTLINE_PLUGIN", str(plugin))
    print("| filter | tetrahedra | ranks | peak MiB of a rank | of one | CPU s, most of a rank | one over it | all |")
    print("|---|---|---|---|---|---|---|---|")
    exceeded = False
    for name in options.filters.split(","):
        one: dict[str, float] = {}
        for ranks in map(int, options.ranks.split(",")):
            found = run(options.pvbatch, ranks, name, options.cells)
            memory = max(rank["peak MiB"] for rank in found)
            seconds = max(rank["cpu s"] for rank in found)
            one = one or {"memory": memory, "seconds": seconds}
            ratio = memory / one["memory"]
            exceeded = exceeded or (ranks == 2 and ratio > MOST_MEMORY)
            print(f"| {name} | {found[0]['cells']:,} | {ranks} | {memory:.0f} | {ratio:.2f} | {seconds:.1f} "
                  f"| {one['seconds'] / seconds:.2f} | {sum(rank['cpu s'] for rank in found):.1f} |", flush=True)
    return int(exceeded)


if __name__ == "__main__":
    sys.exit(main())
