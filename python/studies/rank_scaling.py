# SPDX-License-Identifier: BSD-3-Clause
"""Wall-clock times of optimize(), solve() and quality() by the number of MPI ranks (chapter 6)."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Sequence

import numpy as np

from tautline._errors import Error

from . import _rank_worker
from ._memory import remembered
from ._report import Report, parser
from ._verdicts import Open, Verdict, all_of

_CELLS, _SMALL_CELLS = 200_000, 5_000
_REPEATS = 3
WORKS = ("optimize", "solve", "quality")
#: Relative difference of results that is due to rounding: sums in another order, by preconditioned solves to 1e-11.
ROUNDING = 1e-7
_SECONDS = 3600  # of a run


@remembered
def measured(work: str, cells: int, ranks: int, repeats: int) -> tuple[float, np.ndarray]:
    """The least wall-clock seconds of several runs, and the result by the numbers of points or cells."""
    programs = [shutil.which(name) for name in ("mpirun", "pvbatch")]
    # Also as root, and where processes may not read each other's memory; ranks that wait leave the cores to others.
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
                   "OMPI_MCA_mpi_yield_when_idle": "1"}
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "result"
        done = subprocess.run(
            [programs[0] or "", *root, "--oversubscribe", "--bind-to", "none", "-np", str(ranks), programs[1] or "",
             "--sym", _rank_worker.__file__, str(file), work, str(cells), str(repeats)],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=_SECONDS, check=False)
        files = [Path(f"{file}.{rank}.npz") for rank in range(ranks)]
        if not all(part.is_file() for part in files):
            raise Error(f"{work} on {ranks} ranks has failed:\n{done.stdout}")
        parts = [dict(np.load(part)) for part in files]
    numbers = np.concatenate([part["numbers"] for part in parts])
    values = np.concatenate([part["values"] for part in parts])
    _, first = np.unique(numbers, return_index=True)
    return max(float(part["seconds"]) for part in parts), values[first]


def main(arguments: Sequence[str]) -> int:
    made = parser("rank_scaling", __doc__, cells=_CELLS, threads=None, repeats=_REPEATS)
    made.add_argument("--ranks", type=int, nargs="+", metavar="N",
                      help="numbers of ranks, the first one 1 (default: 1, 2, 4 and so on up to the number of cores)")
    given = made.parse_args(arguments)
    cores = os.cpu_count() or 1
    counts = given.ranks or [2**k for k in range(max(2, cores.bit_length())) if 2**k <= max(2, cores)]
    if counts[0] != 1 or sorted(set(counts)) != counts:
        raise Error(f"--ranks is {' '.join(map(str, counts))}; increasing numbers are needed, the first one 1")
    missing = [name for name in ("mpirun", "pvbatch") if not shutil.which(name)]
    if missing:
        raise Error(f"this study needs {' and '.join(missing)}")
    cells = given.cells or (_SMALL_CELLS if given.small else _CELLS)
    report = Report("rank_scaling", "Times by the number of MPI ranks (chapter 6)", given)
    report.text("Subject: the scaling of mesh optimization over processes. A square of triangles whose inner "
                "points are moved at random is cut in strips, one for each rank, which is worse than what the filters "
                f"can divide it into. Wall-clock seconds, the least of {given.repeats} runs, one thread for each rank; "
                f"the number of cores is {cores}. Speed-ups are of this machine; the criterion is that the results do "
                "not depend on the number of ranks.")
    found = {work: {n: measured(work, cells, n, given.repeats) for n in counts} for work in WORKS}
    tiny = np.finfo(float).tiny
    speedups = {work: [row[1][0] / max(seconds, tiny) for seconds, _ in row.values()] for work, row in found.items()}
    report.table("seconds", f"Wall-clock seconds by the number of ranks, about {cells:,} triangles",
                 ["function", *map(str, counts), *(f"speed-up {n}" for n in counts[1:])],
                 [[work, *(s for s, _ in row.values()), *speedups[work][1:]] for work, row in found.items()])
    report.lines("rank_scaling", [("speed-up", "ranks", "times", {work: (counts, speedups[work]) for work in found})],
                 columns=1)
    same_findings(report, {work: {n: result for n, (_, result) in row.items()} for work, row in found.items()})
    return report.finish()


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """The largest difference over the largest value; infinite where a result has other points or cells."""
    if one.shape != other.shape:
        return float("inf")
    return float(np.max(np.abs(one - other)) / max(float(np.max(np.abs(one))), np.finfo(float).tiny))


def same(results: dict[int, np.ndarray]) -> Verdict:
    """Whether results are the same up to rounding with each number of ranks."""
    first, *others = results.values()
    return all_of(difference(first, other) <= ROUNDING for other in others) if others else Open("there is one number")


def same_findings(report: Report, found: dict[str, dict[int, np.ndarray]]) -> None:
    """The results by the number of ranks."""
    for work, results in found.items():
        first = next(iter(results.values()))
        apart = max((difference(first, other) for other in results.values()), default=0.0)
        report.finding("6", f"{work}(): the result does not depend on the number of ranks", same(results),
                       f"largest difference {apart:.3g} with {', '.join(map(str, results))} ranks", own=True,
                       criterion=f"the same up to rounding, {ROUNDING:g} of the largest value")
