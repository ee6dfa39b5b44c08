# SPDX-License-Identifier: BSD-3-Clause
"""Divisions of a mesh for MPI ranks: halos, messages and balance by partitioner, and a model of weak scaling."""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkDataSet, vtkTable

import tautline
from tautline._errors import Messages

from ._common import Method, _configured, _timed
from ._meshes import cells_of, points_of
from ._memory import remembered
from ._report import Report, parser
from ._verdicts import Open, Verdict, all_of

PARTS, SMALL_PARTS = (2, 4, 8, 16, 32, 64), (2, 4, 8)
#: Numbers of parts beyond the weak series, which the model predicts.
BEYOND, SMALL_BEYOND = 256, 16
CELLS, SMALL_CELLS = {"disk3d": 400_000, "disk2d": 200_000}, {"disk3d": 3_000, "disk2d": 1_500}
#: Cells of each part in the weak series, in space.
PER_PART, SMALL_PER_PART = 2_000, 250
#: Cells per part, parts: of the series that shows how a halo grows with the size of a part.
SIZES, SMALL_SIZES = (1_000, 2_000, 4_000, 8_000, 16_000), (200, 400, 800)
SIZE_PARTS, SMALL_SIZE_PARTS = 27, 8
#: The data that a rank sends of a point that has moved: x y z and a flag, in double precision.
POINT_BYTES = 32
#: Exchanges of one number with all ranks at the end of a sweep (LocalSweeper), their bytes per rank, and the collective
#: operations of each: one for lengths, one for values.
REDUCTIONS, REDUCED_BYTES, OPERATIONS = 6, 16, 2
#: Assumed of the network, not measured: seconds per message, bytes per second.
LATENCY, BANDWIDTH = 2e-6, 1e10
#: Divisions of a graph, whose parts PT-Scotch does not repeat; the one with the median halo counts.
RUNS = 3
SWEEPS = 6  # of which the time is measured
RANKS = (16, 64, 256, 1024)
RANK_CELLS = (1_000, 10_000, 100_000)
#: A mesh and cores as a parallel mesh optimizer of today has them: what the model says of it.
ANCHOR_CELLS, ANCHOR_RANKS = 160_000_000, 128
#: Seconds of a sweep with n cells on each of P ranks (Model.parts_of); Model.symbols names the others.
FORMULA = ("t * f * n + t * w * sqrt(f * n * S) + L * K * S + 32 * s * h * n**b / B "
           "+ 6 * (2 * ceil(log2(P)) * L + 16 * P / B)")
BALANCE, WIDEST, SAME_HALO, SAME_MODEL, EFFICIENT = 1.1, 32, 1.3, 0.2, 0.8
SURFACE, SURFACE_TOLERANCE = 2 / 3, 0.1
METHODS = ("slabs", "k-d tree", "curve", "graph", "random")
CURVE_BITS = 16  # per direction, of the places on the curve


@dataclass
class Division:
    """Counts of a mesh in parts; the largest of any part unless it is said otherwise."""

    cells: int  # of the whole mesh
    balance: float  # cells, over the mean
    halo: int
    mean_halo: float
    neighbors: int
    messages: int  # that a part sends in a sweep
    bytes: int
    sets: int
    free: int  # points that move, of the whole mesh
    slowest: int  # points of a sweep one after the other, where all wait for each other after each set
    seconds: float  # CPU, for the division
    halos: list[int]  # of all divisions by the same method


# --- divisions ------------------------------------------------------------------------------------------------


def bisected(centres: np.ndarray, parts: int, axis: int | None = None) -> np.ndarray:
    """Halves of equal numbers of cells across the longest direction, or always across an axis."""
    found = np.zeros(len(centres), np.int32)
    left = [(np.arange(len(centres)), 0, parts)]
    while left:
        cells, first, count = left.pop()
        if count == 1:
            found[cells] = first
            continue
        across = int(np.argmax(np.ptp(centres[cells], axis=0))) if axis is None else axis
        half = count // 2
        middle = len(cells) * half // count
        order = np.argpartition(centres[cells, across], middle)
        left += [(cells[order[:middle]], first, half), (cells[order[middle:]], first + half, count - half)]
    return found


def along_curve(centres: np.ndarray, parts: int) -> np.ndarray:
    """Pieces of equal length of Morton's space-filling curve."""
    low = centres.min(axis=0)
    grid = ((centres - low) / np.ptp(centres, axis=0).max() * (2**CURVE_BITS - 1)).astype(np.uint64)
    code = np.zeros(len(centres), np.uint64)
    for bit in range(CURVE_BITS):
        for axis in range(3):
            code |= (grid[:, axis] >> np.uint64(bit) & np.uint64(1)) << np.uint64(3 * bit + axis)
    found = np.empty(len(centres), np.int32)
    found[np.argsort(code, kind="stable")] = np.arange(len(centres)) * parts // len(centres)
    return found


def by_graph(mesh: vtkDataSet, parts: int) -> np.ndarray:
    """PT-Scotch on the graph of cells with common edges or faces."""
    decomposition = tautline.vtkMeshDecomposition()
    messages = Messages(decomposition)
    decomposition.SetNumberOfParts(parts)
    found = vtkIntArray()
    decomposition.DivideGraph(mesh, found)
    messages.raise_errors()
    return np.array(vtk_to_numpy(found))


def divided(mesh: vtkDataSet, method: str, parts: int) -> np.ndarray:
    """The number of the part of each cell."""
    centres = points_of(mesh)[cells_of(mesh)].mean(axis=1)
    ways: dict[str, Callable[[], np.ndarray]] = {
        "slabs": lambda: bisected(centres, parts, int(np.argmax(np.ptp(centres, axis=0)))),
        "k-d tree": lambda: bisected(centres, parts),
        "curve": lambda: along_curve(centres, parts),
        "graph": lambda: by_graph(mesh, parts),
        "random": lambda: np.random.default_rng(parts).integers(0, parts, len(centres)).astype(np.int32),
    }
    return ways[method]()


@remembered
def counted(mesh: vtkDataSet, method: str, parts: int) -> Division:
    """Divide a mesh and count what the kernel's sweeps would send; of several divisions, the median halo counts."""
    found = sorted((counted_once(mesh, method, parts) for _ in range(RUNS if method == "graph" else 1)),
                   key=lambda d: d.halo)
    chosen = found[len(found) // 2]
    chosen.halos = [d.halo for d in found]
    return chosen


def counted_once(mesh: vtkDataSet, method: str, parts: int) -> Division:
    began = time.process_time()
    of_cell = divided(mesh, method, parts)
    seconds = time.process_time() - began
    decomposition = tautline.vtkMeshDecomposition()
    messages = Messages(decomposition)
    decomposition.SetNumberOfParts(parts)
    table = vtkTable()
    decomposition.Count(mesh, numpy_to_vtk(np.ascontiguousarray(of_cell, np.int32), deep=True), table)
    messages.raise_errors()
    column = {name: vtk_to_numpy(table.GetColumnByName(name)) for name in
              ("Cells", "Halo Points", "Neighbours", "Messages", "Sent Points")}
    return Division(
        cells=int(column["Cells"].sum()),
        balance=float(column["Cells"].max() / column["Cells"].mean()),
        halo=int(column["Halo Points"].max()),
        mean_halo=float(column["Halo Points"].mean()),
        neighbors=int(column["Neighbours"].max()),
        messages=int(column["Messages"].max()),
        bytes=POINT_BYTES * int(column["Sent Points"].max()),
        sets=decomposition.GetNumberOfSets(),
        free=decomposition.GetFreePoints(),
        slowest=decomposition.GetSlowestPoints(),
        seconds=seconds,
        halos=[],
    )


# --- the model ------------------------------------------------------------------------------------------------


@dataclass
class Model:
    """The cost of a sweep for a rank with a number of cells."""

    halo: float  # points of the halo, of cells ** exponent
    exponent: float
    neighbors: float
    sets: float
    points: float  # free points per cell
    waiting: float  # points for which a rank waits for others, of (points x sets) ** 0.5
    sent: float  # points that a rank sends, relative to its halo
    second: float  # CPU, of a point in a sweep
    latency: float
    bandwidth: float

    def halo_of(self, cells: float) -> float:
        return self.halo * cells**self.exponent

    def slowest(self, cells: float) -> float:
        """Points that move one after the other."""
        free = self.points * cells
        return free + self.waiting * math.sqrt(free * self.sets)

    def parts_of(self, cells: float, ranks: int) -> dict[str, float]:
        """Seconds of a sweep: points, waiting for other ranks, messages, bytes, collective exchanges."""
        free = self.points * cells
        rounds = math.ceil(math.log2(max(2, ranks)))
        return {
            "points": self.second * free,
            "waiting": self.second * (self.slowest(cells) - free),
            "messages": self.latency * self.neighbors * self.sets,
            "bytes": POINT_BYTES * self.sent * self.halo_of(cells) / self.bandwidth,
            "collective": REDUCTIONS * (OPERATIONS * rounds * self.latency + ranks * REDUCED_BYTES / self.bandwidth),
        }

    def symbols(self) -> dict[str, float]:
        """The numbers of FORMULA."""
        return {"t": self.second, "f": self.points, "w": self.waiting, "S": self.sets, "L": self.latency,
                "K": self.neighbors, "s": self.sent, "h": self.halo, "b": self.exponent, "B": self.bandwidth}

    def efficiency(self, cells: float, ranks: int) -> float:
        """The ratio of the times of one rank and of many ranks, with as many cells each."""
        parts = self.parts_of(cells, ranks)
        return parts["points"] / max(sum(parts.values()), math.ulp(0.0))


def slope(sizes: Sequence[float], values: Sequence[float]) -> tuple[float, float]:
    """a and b of values = a sizes^b."""
    b, a = np.polyfit(np.log(sizes), np.log(np.maximum(values, 1)), 1)
    return float(np.exp(a)), float(b)


def fitted(sizes: dict[int, Division], weak: dict[int, Division], second: float, given: argparse.Namespace) -> Model:
    """The model from the halo by size of a part, and the counts of the weak series without its last."""
    last = weak[max(list(weak)[:-1])]
    parts = max(list(weak)[:-1])
    factor, exponent = slope(list(sizes), [d.halo for d in sizes.values()])
    free = last.free / parts
    return Model(factor, exponent, last.neighbors, last.sets, free / (last.cells / parts),
                 (last.slowest - free) / math.sqrt(free * last.sets), last.bytes / POINT_BYTES / max(1, last.halo),
                 second, given.latency, given.bandwidth)


@remembered
def second_per_point(mesh: vtkDataSet, free: int) -> float:
    """CPU seconds of a point in a sweep of Local Newton on inverse mean ratio, in the order of several ranks."""
    filter_, messages = _configured(mesh, Method("imr", "IMR", ("imr",)), SWEEPS, "newton", threads=1)
    filter_.SetReproducibleOrder(True)
    stamps = _timed(filter_, messages)
    return float((stamps[-1] - stamps[0]) / max(1, len(stamps) - 1) / free)


# --- the study ------------------------------------------------------------------------------------------------

COLUMNS = ("parts", "largest / mean cells", "largest halo", "mean halo", "neighbors", "messages", "kB", "waiting %",
           "CPU s")


def row(d: Division, parts: int) -> list:
    waiting = 100 * (d.slowest * parts / d.free - 1)
    return [parts, d.balance, d.halo, d.mean_halo, d.neighbors, d.messages, d.bytes / 1000, waiting, d.seconds]


def main(arguments: list[str]) -> int:
    made = parser("decomposition", __doc__, threads=None)
    made.add_argument("--latency", type=float, default=LATENCY, metavar="S",
                      help="of the model: seconds per message, an assumption (default: %(default)s)")
    made.add_argument("--bandwidth", type=float, default=BANDWIDTH, metavar="B",
                      help="of the model: bytes per second, an assumption (default: %(default)s)")
    given = made.parse_args(arguments)
    if not (0 < given.latency < math.inf and 0 < given.bandwidth < math.inf):
        raise tautline.Error(f"latency {given.latency}, bandwidth {given.bandwidth}: positive numbers are needed")
    report = Report("decomposition", "Divisions of a mesh for many ranks", given)
    parts = SMALL_PARTS if given.small else PARTS
    report.text(
        "Question (outlook of the dissertation): the best decomposition of the domain for an optimizer on many "
        "processes. Counts refer to the kernel's own order: independent sets move one after the other, after each "
        f"of them a rank sends its points ({POINT_BYTES} bytes each) in one message to every rank with a copy. They "
        "are the largest of any part, for one sweep. The boundary is fixed. The optimized points are the same "
        "for every division, to rounding, so that quality does not depend on it. Slabs, k-d tree and curve are divided "
        f"in numpy, the graph by PT-Scotch, {RUNS} times, as its parts are not reproducible: the division with the "
        "median of the largest halos counts. Not measured: energy, and times on a network; the model assumes "
        f"{given.latency:g} s per message and {given.bandwidth:g} bytes per second."
    )
    found: dict[str, dict[str, dict[int, Division]]] = {}
    for domain, cells in (SMALL_CELLS if given.small else CELLS).items():
        mesh = tautline.domain(domain, cells)
        found[domain] = {method: {n: counted(mesh, method, n) for n in parts} for method in METHODS}
        for method, counts in found[domain].items():
            file = f"{domain}_{method.replace(' ', '_').replace('-', '')}"
            title = f"{domain}, {mesh.GetNumberOfCells():,} cells, {method}"
            report.table(file, title, COLUMNS, [row(d, n) for n, d in counts.items()])
    division_findings(report, found)
    scaling(report, given, parts)
    pictures(report, found)
    return report.finish()


def scaling(report: Report, given: argparse.Namespace, parts: Sequence[int]) -> None:
    """The weak series, the model and its predictions."""
    per_part = SMALL_PER_PART if given.small else PER_PART
    beyond = SMALL_BEYOND if given.small else BEYOND
    weak, mesh = {}, None
    for n in (*parts, beyond):
        mesh = tautline.domain("disk3d", n * per_part)
        weak[n] = counted(mesh, "graph", n)
    report.table("weak", f"disk3d with about {per_part:,} cells per part, graph", COLUMNS,
                 [row(d, n) for n, d in weak.items()])
    count = SMALL_SIZE_PARTS if given.small else SIZE_PARTS
    sizes: dict[int, Division] = {}
    for n in SMALL_SIZES if given.small else SIZES:
        mesh = tautline.domain("disk3d", n * count)
        d = counted(mesh, "graph", count)
        sizes[d.cells // count] = d
    report.table("sizes", f"disk3d in {count} parts, graph", ["cells per part", *COLUMNS[1:]],
                 [[n, *row(d, count)[1:]] for n, d in sizes.items()])
    second = second_per_point(tautline.perturb(mesh, fraction=0.9).mesh, list(sizes.values())[-1].free)
    model = fitted(sizes, weak, second, given)
    report.table("model", "Parts of a sweep by the model, microseconds per rank, on 1,024 ranks",
                 ["cells per rank", *model.parts_of(1, 2)],
                 [[n, *(1e6 * s for s in model.parts_of(n, max(RANKS)).values())] for n in RANK_CELLS])
    report.table("efficiency", "Efficiency of weak scaling by the model", ["cells per rank", *map(str, RANKS)],
                 [[n, *(model.efficiency(n, ranks) for ranks in RANKS)] for n in RANK_CELLS])
    cells = ANCHOR_CELLS / ANCHOR_RANKS
    parts_of = model.parts_of(cells, ANCHOR_RANKS)
    efficiency = model.efficiency(cells, ANCHOR_RANKS)
    report.table("anchor", f"{ANCHOR_CELLS:,} cells on {ANCHOR_RANKS} ranks by the model, milliseconds per sweep",
                 ["cells per rank", *parts_of, "sweep", "efficiency", "speed-up"],
                 [[round(cells), *(1e3 * s for s in parts_of.values()), 1e3 * sum(parts_of.values()), efficiency,
                   ANCHOR_RANKS * efficiency]])
    on_each = weak[beyond].cells / beyond
    scaling_findings(report, weak, model.exponent, {"slowest": model.slowest(on_each), "halo": model.halo_of(on_each)},
                     {n: model.efficiency(n, max(RANKS)) for n in RANK_CELLS},
                     model.parts_of(RANK_CELLS[1], max(RANKS)))
    report.text(explained(model))


def explained(model: Model) -> str:
    """The limits of weak scaling, from the numbers."""
    rank_cells = RANK_CELLS[1]
    parts = model.parts_of(rank_cells, max(RANKS))
    rest = {name: seconds for name, seconds in parts.items() if name != "points"}
    others = ", ".join(f"{name} {1e6 * seconds:.3g} us" for name, seconds in rest.items())
    ranks = 2
    while model.parts_of(rank_cells, ranks)["collective"] < 0.1 * parts["points"] and ranks < 2**30:
        ranks *= 2
    return (
        f"The model: a point takes {1e6 * model.second:.3g} microseconds in a sweep; a part of n cells has "
        f"{model.points:.3g} n free points, a halo of {model.halo:.3g} n^{model.exponent:.3g} points and "
        f"{model.neighbors:g} neighbors; {model.sets:g} sets follow each other. All ranks wait for the slowest one "
        f"after each set, for {model.waiting:.3g} times the root of (free points x sets), in points. A rank sends "
        f"{model.sent:.3g} times the points of its halo. In seconds, with n cells on each of P ranks: {FORMULA}, where "
        f"{', '.join(f'{name} = {value:.4g}' for name, value in model.symbols().items())}. With "
        f"{rank_cells:,} cells on each of {max(RANKS):,} ranks, apart from moving own points, "
        f"{max(rest, key=lambda name: rest[name])} takes the most time: {others}. The halo is for {SIZE_PARTS} parts, "
        "most of which are at the boundary of the domain: parts inside have larger ones, whose bytes cost little.\n"
        "Its limits: (1) few cells per rank: waiting and messages do not shrink with the cells as the work does; "
        f"(2) exchanges of a number with all ranks send it from each rank to each: from about {ranks:,} ranks "
        "they take a tenth of the time of the points; (3) filters that gather the mesh on the first rank do not scale "
        "at all."
    )


# --- findings -------------------------------------------------------------------------------------------------


def smaller(values: Sequence[int], limit: int) -> Verdict:
    """Whether all values are below a limit: not decided if some are and some are not."""
    below = sum(v < limit for v in values)
    return Open("the runs of PT-Scotch are on both sides") if 0 < below < len(values) else below > 0


def division_findings(report: Report, found: dict[str, dict[str, dict[int, Division]]]) -> None:
    """Partitioners compared on one mesh in more and more parts."""
    def ratios(domain: str, one: str, other: str) -> dict[int, float]:
        return {n: d.halo / max(1, found[domain][other][n].halo) for n, d in found[domain][one].items()}

    def text(values: dict[int, float]) -> str:
        return ", ".join(f"{n}: {v:.2f}" for n, v in values.items())

    def finding(domain: str, claim: str, holds: Verdict, ours: str, criterion: str = "") -> None:
        report.finding(domain, claim, holds, ours, criterion=criterion, own=True)

    for domain, methods in found.items():
        for method in ("k-d tree", "graph"):
            balances = {n: d.balance for n, d in methods[method].items()}
            finding(domain, f"{method}: the largest part has at most {BALANCE:g} times the mean of the cells",
                    all_of(v <= BALANCE for v in balances.values()), text(balances))
        tree, spread = {n: max(1, d.halo) for n, d in methods["k-d tree"].items()}, methods["graph"]
        finding(domain, "The graph's largest halo is smaller than the k-d tree's, for every number of parts",
                all_of(smaller(d.halos, tree[n]) for n, d in spread.items()), "graph over k-d tree: " +
                ", ".join(f"{n}: {min(d.halos) / tree[n]:.2f} to {max(d.halos) / tree[n]:.2f}"
                          for n, d in spread.items()))
        values = ratios(domain, "k-d tree", "curve")
        finding(domain, "The k-d tree's largest halo is smaller than the curve's, for every number of parts",
                all_of(v < 1 for v in values.values()), "k-d tree over curve: " + text(values))
        values = {n: v for n, v in ratios(domain, "slabs", "k-d tree").items() if n > 4}
        finding(domain, "From 8 parts on slabs have larger halos than the k-d tree",
                all_of(v > 1 for v in values.values()),
                "slabs over k-d tree: " + text(values))
        values = {n: d.messages / max(1, methods["slabs"][n].messages) for n, d in methods["graph"].items() if n > 4}
        finding(domain, "From 8 parts on slabs send fewer messages than the graph's parts, in spite of halos",
                all_of(v > 1 for v in values.values()), "graph over slabs: " + text(values))
        values = {n: d.mean_halo * n / max(1, d.free) for n, d in methods["random"].items()}
        finding(domain, "At random, halos together have more points than move in the whole mesh",
                all_of(v > 1 for v in values.values()), "halo points over free points: " + text(values))


def scaling_findings(report: Report, weak: dict[int, Division], exponent: float, predicted: dict[str, float],
              efficiencies: dict[int, float], shares: dict[str, float]) -> None:
    """Parts of one size in more and more of them, and the model's prediction for 1,024 ranks.

    predicted: counts of the last of the series. efficiencies: by cells of a rank. shares: seconds of a sweep.
    """
    def finding(where: str, claim: str, holds: Verdict, ours: str, criterion: str = "") -> None:
        report.finding(where, claim, holds, ours, criterion=criterion, own=True)

    *parts, beyond = weak
    last, before = weak[parts[-1]], weak[parts[-2]]
    where = "weak scaling"
    finding(where, f"From {parts[-2]} to {parts[-1]} parts the largest halo grows at most {SAME_HALO:g} times",
            last.halo <= SAME_HALO * before.halo, f"{before.halo}, {last.halo} points")
    finding(where, f"A part has at most {WIDEST} neighbors, also with {beyond} parts",
            max(d.neighbors for d in weak.values()) <= WIDEST,
            ", ".join(f"{n}: {d.neighbors}" for n, d in weak.items()))
    finding(where, "Halos grow with the surface of a part, cells^(2/3)",
            abs(exponent - SURFACE) <= SURFACE_TOLERANCE, f"exponent {exponent:.3f}", f"within {SURFACE_TOLERANCE:g}")
    measured = weak[beyond].slowest
    same_model = f"within {SAME_MODEL:.0%} of what was counted"
    finding(where, f"The model predicts the points that move one after the other on {beyond} ranks, which it was not "
            "fitted to", abs(predicted["slowest"] / max(1, measured) - 1) <= SAME_MODEL,
            f"predicted {predicted['slowest']:.0f}, counted {measured}", same_model)
    measured = weak[beyond].halo
    finding(where, f"The model predicts the largest halo on {beyond} ranks",
            abs(predicted["halo"] / max(1, measured) - 1) <= SAME_MODEL,
            f"predicted {predicted['halo']:.0f}, counted {measured}", same_model)
    ranks = max(RANKS)
    for cells, value in efficiencies.items():
        finding("model", f"{ranks:,} ranks with {cells:,} cells each are {100 * EFFICIENT:g} % efficient",
                value >= EFFICIENT, f"{100 * value:.1f} %")
    finding("model", f"With {RANK_CELLS[1]:,} cells each messages cost more than the bytes in them",
            shares["messages"] > shares["bytes"],
            f"{1e6 * shares['messages']:.3g} and {1e6 * shares['bytes']:.3g} microseconds")
    finding("model", f"With {RANK_CELLS[1]:,} cells each ranks wait longer for each other than for the network",
            shares["waiting"] > shares["messages"] + shares["bytes"] + shares["collective"],
            ", ".join(f"{name} {1e6 * s:.3g} us" for name, s in shares.items()))


def pictures(report: Report, found: dict[str, dict[str, dict[int, Division]]]) -> None:
    panels = []
    for domain, methods in found.items():
        shown = {name: counts for name, counts in methods.items() if name != "random"}
        for quantity, label in (("halo", "points of the largest halo"), ("messages", "messages in a sweep")):
            curves = {name: (list(counts), [getattr(d, quantity) for d in counts.values()])
                      for name, counts in shown.items()}
            panels.append((domain, "parts", label, curves))
    report.lines("halos", panels)
