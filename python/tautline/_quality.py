"""The verb quality: measure every element of a mesh."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

import tautline

from ._errors import Error, run, watch
from ._mesh import Mesh, as_mesh, cell_array, columns, leaves, point_array, with_array
from ._metrics import Metrics, choose, metrics as known_metrics, pick, within

COMBINATIONS = ("mean", "worst", "power mean")
TARGETS = ("ideal", "reference", "size", "tensor")
REVERSED = ("measure as given", "measure flipped", "flip output")
_MOST_THREADS = 1024
_NOT_NUMBERS = ("Metric", "WorstCells", "WorstPositions")  # columns of the statistics
_OWN = "given target"  # the name of the array a target given in numbers goes to the filter in


@dataclass(frozen=True)
class Quality:
    """What quality() found. Dicts are by the names of the metrics, in the order they were asked for."""

    #: The mesh with a cell array per metric and `Validity`; shares the other arrays with the input.
    mesh: vtkDataObject
    #: Values per cell (of composite data, block after block); 0 where a metric is not defined.
    values: dict[str, np.ndarray]
    #: Per cell 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    validity: np.ndarray
    #: Per metric: label, measured, minimum, maximum, mean, rms, standard_deviation, quantile_01 to
    #: quantile_99, outside_acceptable, acceptable_low, acceptable_high, inverted, degenerate,
    #: not_measured, non_finite; worst (the worst value; nan if nothing was measured), and arrays of at
    #: most ten, worst first: worst_cells (k), worst_values (k), worst_positions (k x 3).
    statistics: dict[str, dict[str, Any]]
    #: Per metric the histogram of valid elements: value (middles of the bins) and count.
    distribution: dict[str, dict[str, np.ndarray]]
    #: Angles (dihedral angles of volumes) in the five bins of Table 2.7: from, to (degrees), count, percent.
    angles: dict[str, np.ndarray]
    #: A point at the centre of each of the worst elements: arrays Metric, Rank, CellId, Value, Validity.
    worst: vtkPolyData
    #: How many elements are inverted, and how many have no area or volume.
    inverted: int
    degenerate: int
    #: What is to be known of how the mesh was taken (orientation, cells left out), or "".
    notice: str
    #: The result in a few lines.
    summary: str


def quality(
    mesh: Mesh,
    metrics: Metrics = ("imr",),
    *,
    combination: str = "mean",
    power: float = 2.0,
    target: str = "ideal",
    reference: Mesh | None = None,
    size: str | float | Sequence | None = None,
    tensor: str | Sequence | None = None,
    beta: float = 0.0,
    epsilon: float = 1e-4,
    reversed_mesh: str = "measure flipped",
    histogram_bins: int = 32,
    threads: int = 0,
) -> Quality:
    """Measure every element of a mesh by one or more metrics.

    mesh: a vtkDataSet, a file name or (points, cells); see from_arrays(). It is not changed.
    metrics: names, labels, symbols or aliases; see metrics(). The default is the inverse mean ratio.
    combination: how target metrics combine the corners of cells other than simplices: "mean",
        "worst" or "power mean" with the exponent power, from 1 to 100.
    target: what the wanted element is, for target metrics: "ideal", "reference", "size" or "tensor".
        Giving one of the next three chooses it.
    reference: a mesh with the same cells: each is the target of its twin.
    size: the area or volume wanted: a number, a row per cell or point, or the name of an array.
    tensor: the metric tensor in which the ideal shape has edges of length 1: 6 numbers
        (xx yy zz xy yz xz) or 9 per cell or point, or the name of an array.
    beta: of the untangling metric, the area or volume every element should have at least, length^n.
    epsilon: of mu_211 and mu_311, above 0.
    reversed_mesh: if all cells list their points in the opposite order: "measure as given" (all
        inverted), "measure flipped" or "flip output".
    histogram_bins: from 1 to 100000.
    threads: 0 is all cores. Results do not depend on it.

    Raises Error for wrong arguments and whatever the filter refuses.

    >>> result = tautline.quality("part.vtu", ["imr", "scaled_jacobian"])
    >>> result.statistics["imr"]["worst"], result.inverted
    """
    data = as_mesh(mesh)
    measure = tautline.vtkElementQuality()
    messages = watch(measure)
    choose(measure, metrics)
    messages.raise_errors()
    measure.SetCombination(pick("combination", combination, COMBINATIONS))
    measure.SetPower(within("power", power, 1, 100))
    measure.SetBeta(within("beta", beta, -np.inf, np.inf))
    measure.SetEpsilon(within("epsilon", epsilon, np.nextafter(0, 1), np.inf))
    measure.SetReversedMesh(pick("reversed_mesh", reversed_mesh, REVERSED))
    measure.SetHistogramBins(int(within("histogram_bins", histogram_bins, 1, 100000)))
    measure.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    data = _set_target(measure, data, target, {"reference": reference, "size": size, "tensor": tensor})
    measure.SetInputDataObject(0, data)
    run(measure, messages)
    for fields in ("GetCellData", "GetPointData"):
        for leaf in leaves(measure.GetOutputDataObject(0)):
            getattr(leaf, fields)().RemoveArray(_OWN)
    return _result(measure)


def _set_target(measure: Any, data: vtkDataObject, target: str, given: dict[str, Any]) -> vtkDataObject:
    """Set the target on the filter; returns the mesh, with the array of the target if there is one."""
    pick("target", target, TARGETS)
    chosen = [name for name, value in given.items() if value is not None]
    if len(chosen) > 1:
        raise Error(f"only one target is possible, not {' and '.join(chosen)}")
    if chosen and target not in ("ideal", chosen[0]):
        raise Error(f"the target is {target!r} but {chosen[0]!r} is given")
    if not chosen and target != "ideal":
        raise Error(f"the target is {target!r} but {target!r} is not given")
    if not chosen:
        return data
    kind, value = chosen[0], given[chosen[0]]
    measure.SetTargetType(TARGETS.index(kind))
    if kind == "reference":
        measure.SetInputDataObject(1, as_mesh(value))
        return data
    if kind == "size" and not isinstance(value, str) and np.ndim(value) == 0:
        value = np.full(data.GetNumberOfCells(), value)
    data, where, name = with_array(data, value, _OWN)
    measure.SetInputArrayToProcess(0 if kind == "size" else 1, 0, 0, where, name)
    return data


def _result(measure: Any) -> Quality:
    mesh = measure.GetOutputDataObject(0)
    worst = measure.GetWorst()
    statistics = _statistics(columns(measure.GetStatistics()), worst)
    bins = columns(measure.GetDistribution())
    totals = next(iter(statistics.values()))
    return Quality(
        mesh=mesh,
        values={name: cell_array(mesh, name) for name in statistics},
        validity=cell_array(mesh, "Validity"),
        statistics=statistics,
        distribution={n: {"value": bins[f"{n} value"], "count": bins[f"{n} count"]} for n in statistics},
        angles={name.lower(): column for name, column in columns(measure.GetAngles()).items()},
        worst=worst,
        inverted=totals["inverted"],
        degenerate=totals["degenerate"],
        notice=measure.GetNotice(),
        summary=measure.GetSummary(),
    )


def _statistics(table: dict[str, Any], worst: vtkPolyData) -> dict[str, dict[str, Any]]:
    numbers = {metric["name"]: metric["number"] for metric in known_metrics()}
    of, ids, values = (point_array(worst, name) for name in ("Metric", "CellId", "Value"))
    result = {}
    for row, name in enumerate(table["Metric"]):
        facts = {snake(key): _plain(table[key][row]) for key in table if key not in _NOT_NUMBERS}
        mine = np.flatnonzero(of == numbers[name])
        positions = np.asarray(table["WorstPositions"][row]).reshape(-1, 3)
        facts["worst"] = float(values[mine[0]]) if len(mine) else float("nan")
        facts["worst_cells"] = ids[mine]
        facts["worst_values"] = values[mine]
        facts["worst_positions"] = positions[: len(mine)].copy()
        result[name] = facts
    return result


def snake(name: str) -> str:
    """A VTK column name in snake case: StandardDeviation is standard_deviation, Quantile01 quantile_01."""
    return re.sub(r"(?<=[a-z])(?=[A-Z0-9])", "_", name).lower()


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
