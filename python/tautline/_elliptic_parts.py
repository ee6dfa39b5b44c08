# SPDX-License-Identifier: BSD-3-Clause
"""The results of solve(), condition() and solver_study(), and their arguments that are not one property each."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar, Iterable, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import flag, number, picked, sequence, sets
from ._arrays import POINTS, Array, InputArrays, Values, cell_array, columns, has_array, point_array, table_rows
from ._choices import PDES, SOLVE_TIME_SCHEMES
from ._errors import Error, checked, wrong_usage
from ._results import Result
from ._tables import align

_TABLE_2_5 = 16  # the first combinations of solver and preconditioner are in the dissertation's Table 2.5
_FIXED, _SOURCE, _GIVEN, _INITIAL, _VELOCITY = 0, 1, 2, 5, 6  # input arrays of vtkEllipticSolver
_CONSTANT, _ARRAY, _EXPRESSION = range(3)  # its types of functions
_WHOLE, _PART, _CHOSEN = range(3)  # its fixed parts of the boundary
_STUDY_COLUMNS = {
    "Block": "block",
    "Combination": "name",
    "N combination": "number",
    "Total time (s)": "seconds",
    "Result": "result",
    "Time set-up (s)": "setup_seconds",
    "Time solve (s)": "solve_seconds",
    "Time CPU (s)": "cpu_seconds",
    "N iterations": "iterations",
    "N condition": "condition",
    "N true residual": "true_residual",
    "N converged": "converged",
    "Reason": "reason",
}

#: A function on the points: a number (elasticity: 2 or 3 of them), the name or the values of a point array, or an
#: expression of x, y, z and of point arrays by name.
Function = Union[float, Values]


@dataclass(frozen=True, repr=False, eq=False)
class SolveResult(Result):
    """The result of solve(). For composite data, numbers cover all blocks; the reason is for the last block.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the solution on the points and, on the cells, `Gradient`, or `Stress` and `VonMises`.
    solution : Array
        The solution per point, n; for elasticity the displacement, n x 3.
    gradient : Array
        Per cell the gradient, m x 3; for elasticity the stress, m x 6 (xx yy zz xy yz xz). Empty if not computed.
    times, series : Array | None
        The times of the steps and the solution at each of them, (steps + 1) x n or n x 3; None for stationary problems;
        the solutions also None unless requested.
    history : dict[str, Any]
        With time steps, per step `time`, `iterations`, `residual`. Otherwise per iteration (0 is the start) `residual`,
        the norm that the method uses, and `log10_residual`, relative to the first one. For composite data also `block`.
    converged, reason, iterations : bool, str, int
        Whether the method converged, and the stopping criterion that ended it.
    unknowns : int
        Number of unknowns.
    assembly_seconds, setup_seconds, solve_seconds : float
        Times of the assembly, of the set-up of the preconditioner or factorization, and of the solution.
    solution_error, gradient_error : float
        With `exact`, the norms in L2 of the error and of its gradient; otherwise nan.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("solution", "gradient", "series")
    mesh: vtkDataObject
    solution: Array
    gradient: Array
    times: Array | None
    series: Array | None
    history: dict[str, Any]
    converged: bool
    reason: str
    iterations: int
    unknowns: int
    assembly_seconds: float
    setup_seconds: float
    solve_seconds: float
    solution_error: float
    gradient_error: float
    summary: str


@dataclass(frozen=True, repr=False, eq=False)
class ConditionResult(Result):
    """The result of condition().

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the cell arrays `LargestEigenvalue`, `Excess` (its log10 over the geometric mean) and `Share`.
    condition, preconditioned_condition : float
        Condition numbers of A and of P^-1 A, for composite data the largest; nan where they are unknown.
    spectrum : list[dict[str, Any]]
        A row (dict) for A and one for P^-1 A: matrix, smallest, largest, condition, smallest_error, largest_error
        (relative bounds; nan: unknown), converged, iterations, seconds, method, message; for composite data also block.
    largest_eigenvalue, share : Array
        Per cell, m: the largest eigenvalue of its matrix, and its share of the largest eigenvalue of A; the shares add
        up to 1. `share` is empty if not computed, also for lack of time.
    unknowns : int
        Number of unknowns.
    summary : str
        The result in words.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("largest_eigenvalue", "share")
    mesh: vtkDataObject
    condition: float
    preconditioned_condition: float
    spectrum: list[dict[str, Any]]
    largest_eigenvalue: Array
    share: Array
    unknowns: int
    summary: str


@dataclass(frozen=True, repr=False, eq=False)
class SolverStudyResult(Result):
    """The result of solver_study().

    Attributes
    ----------
    rows : list[dict[str, Any]]
        A row (dict) per combination: name, number (1 to 16: Table 2.5), seconds (total; nan if it failed),
        result (the same as text; "*" if it failed, "-" if no time was left), setup_seconds, solve_seconds, cpu_seconds
        (of the process for both), iterations, condition (of P^-1 A; nan: unknown), true_residual, converged, reason;
        for composite data also block.
    recommended, why : str
        The name of the recommended combination and the reason for it; "" if none converged or the times of the fastest
        do not differ by more than a tenth or a millisecond.
    unknowns : int
        Number of unknowns.
    summary : str
        The result in words.
    """

    rows: list[dict[str, Any]]
    recommended: str
    why: str
    unknowns: int
    summary: str


@sets("solve condition solver_study", "SourceType", "SourceValue", "BodyForce", "SourceArray", "SourceExpression")
def set_source(filter_: Any, inputs: InputArrays, source: Function | None = None, *, pde: str) -> None:
    """Set the source.

    source: f, by default 1 (elasticity: (1, 0, 0)): a number (elasticity: 2 or 3 of them), the name or the values of a
        point array, or an expression of x, y, z and point arrays: "sin(x)*y" (elasticity: "x*iHat - jHat").
    """
    if source is not None:
        _set_function(filter_, inputs, pde, "source", source, _SOURCE)


@sets("solve condition solver_study", "FixedPart", "FixedWhere", "FixedPoints")
def set_fixed(filter_: Any, inputs: InputArrays, fixed: Values | None = None) -> None:
    """Set where the solution is given.

    fixed: the points with a given solution. None: the boundary. An expression: the points of the boundary where it
        holds, such as "x < 0.1". Name or values of a point or cell array: where it is not 0 (at the points of these
        cells), and only there.
    """
    if isinstance(fixed, str) and not has_array(inputs.mesh, fixed):
        filter_.SetFixedPart(_PART)
        filter_.SetFixedWhere(fixed)
    elif fixed is not None:
        filter_.SetFixedPart(_CHOSEN)
        inputs.use(_FIXED, fixed, "fixed")


@sets("solve condition solver_study", "GivenType", "GivenValue", "GivenDisplacement", "GivenArray", "GivenExpression")
def set_given(filter_: Any, inputs: InputArrays, given: Function = 0.0, *, pde: str) -> None:
    """Set the given solution.

    given: the solution at the fixed points; in the same form as the source.
    """
    _set_function(filter_, inputs, pde, "given", given, _GIVEN)


@sets("solve", "InitialType", "InitialValue", "InitialDisplacement", "InitialArray", "InitialExpression")
def set_initial(filter_: Any, inputs: InputArrays, initial: Function = 0.0, *, pde: str, time_scheme: str) -> None:
    """Set the solution at time 0.

    initial: the solution at time 0; in the same form as the source.
    """
    if _is_transient(time_scheme):
        _set_function(filter_, inputs, pde, "initial", initial, _INITIAL)


@sets("solve", "VelocityType", "VelocityValue", "VelocityVector", "VelocityArray", "VelocityExpression")
def set_velocity(filter_: Any, inputs: InputArrays, velocity: Function = 0.0, *, pde: str, time_scheme: str) -> None:
    """Set the time derivative at time 0.

    velocity: the time derivative of the solution at time 0, of "newmark"; in the same form as the source.
    """
    if _is_transient(time_scheme):
        _set_function(filter_, inputs, pde, "velocity", velocity, _VELOCITY)


def _is_transient(time_scheme: str) -> bool:
    return picked("time_scheme", time_scheme, SOLVE_TIME_SCHEMES) != "stationary"


def _set_function(filter_: Any, inputs: InputArrays, pde: str, name: str, value: Function, index: int) -> None:
    elastic = picked("pde", pde, PDES) == "elasticity"
    (_set_vector_function if elastic else _set_scalar_function)(filter_, inputs, name, value, index)


def _set_scalar_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` of a scalar equation."""
    _check_function(name, value)
    if not isinstance(value, str) and np.size(value) == 1 and np.ndim(value) < 2:
        getattr(filter_, f"Set{name.capitalize()}Value")(number(name, np.asarray(value).item()))
    else:
        _set_variable_function(filter_, inputs, name, value, index)


#: The setters of constant vectors.
_VECTOR_SETTERS = {"source": "SetBodyForce", "given": "SetGivenDisplacement", "initial": "SetInitialDisplacement",
                   "velocity": "SetVelocityVector"}  # fmt: skip


def _set_vector_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` of elasticity: a constant vector by a setter of its own; the number 0 is the vector 0."""
    _check_function(name, value)
    if isinstance(value, str) or np.size(value) > 3 or np.ndim(value) > 1:
        _set_variable_function(filter_, inputs, name, value, index)
        return
    if np.size(value) == 1 and np.all(np.asarray(value, float) == 0):
        value = (0.0, 0.0, 0.0)
    if np.size(value) not in (2, 3):
        raise Error(f"{name} is {value!r}; for elasticity it is a vector of two or three numbers")
    getattr(filter_, _VECTOR_SETTERS[name])(*(number(name, v) for v in [*np.ravel(value), 0.0][:3]))


def _check_function(name: str, value: Any) -> None:
    """Raise Error for a value that is neither a text nor numbers."""
    try:
        if isinstance(value, str) or np.asarray(value).dtype.kind in "iufb":
            return
    except ValueError:  # rows of different lengths
        pass
    raise Error(f"{name} is {value!r}; a number, a vector, an expression or an array is expected")


def _set_variable_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` as an expression, or as a point array by name or by values."""
    setter = f"Set{name.capitalize()}"
    if isinstance(value, str) and not has_array(inputs.mesh, value, POINTS):
        getattr(filter_, f"{setter}Type")(_EXPRESSION)
        getattr(filter_, f"{setter}Expression")(value)
    else:
        getattr(filter_, f"{setter}Type")(_ARRAY)
        inputs.use(index, value, name, POINTS)


@checked
def solver_combinations() -> dict[int, str]:
    """The combinations of solver and preconditioner of solver_study() by number; 1 to 16 are in Table 2.5.

    Returns
    -------
    dict[int, str]
    """
    study = _vtk.vtkSolverStudy
    return {number: study.GetCombinationName(number) for number in range(1, study.GetNumberOfCombinations() + 1)}


@sets("solver_study", "Combinations")
def choose_combinations(filter_: Any, combinations: Iterable[int | str] | None = None) -> None:
    """Choose the combinations.

    combinations: numbers or names, see solver_combinations(). None: 1 to 16, from the dissertation's Table 2.5.
    """
    known = solver_combinations()
    for chosen in known if combinations is None else sequence("combinations", combinations):
        found = {name.lower(): key for key, name in known.items()}.get(str(chosen).lower(), chosen)
        if not isinstance(found, (int, np.integer)) or found not in known:
            listed = ", ".join(f"{k}: {v}" for k, v in known.items())
            raise wrong_usage(f"there is no combination {chosen!r}; there are {listed}")
        if combinations is not None or int(found) <= _TABLE_2_5:
            filter_.AddCombination(int(found))


def solve_result(filter_: Any, output: vtkDataObject, series: bool = False) -> SolveResult:
    """The result of a filter that has run.

    series: whether the result has the solution at all times; the mesh has the last one.
    """
    elastic = PDES[filter_.GetEquation()] == "elasticity"
    fields = "Stress" if elastic else "Gradient"
    history = columns(filter_.GetHistory())
    names = {"Log10 residual": "log10_residual", "N residual": "residual", "Block": "block", "Time": "time",
             "N iterations": "iterations"}  # fmt: skip
    times = None
    if filter_.GetTimeScheme():  # fewer times if a step did not converge
        times = np.arange(filter_.GetComputedTimeSteps() + 1) * filter_.GetTimeStep()
    name = filter_.GetSolutionName() or ("Displacement" if elastic else "Solution")
    return SolveResult(
        mesh=output,
        solution=point_array(output, name),
        gradient=cell_array(output, fields) if filter_.GetComputeGradient() else np.zeros(0),
        times=times,
        series=_series(filter_, name, times) if flag("series", series) and times is not None else None,
        history={names[name]: values for name, values in history.items()},
        converged=bool(filter_.GetConverged()),
        reason=filter_.GetReason(),
        iterations=filter_.GetIterations(),
        unknowns=filter_.GetUnknowns(),
        assembly_seconds=filter_.GetAssemblySeconds(),
        setup_seconds=filter_.GetSetupSeconds(),
        solve_seconds=filter_.GetSolveSeconds(),
        solution_error=filter_.GetSolutionError() if filter_.GetExactSolution() else np.nan,
        gradient_error=filter_.GetGradientError() if filter_.GetExactSolution() else np.nan,
        summary=filter_.GetSummary(),
    )


def condition_result(filter_: Any, output: vtkDataObject) -> ConditionResult:
    """The result of a filter that has run."""
    spectrum = _rows(filter_.GetSpectrum(), {"SmallestError": "smallest_error", "LargestError": "largest_error"})
    for row in spectrum:
        row["condition"] = row["condition"] or np.nan
        row["converged"] = bool(row["converged"])
        for name in ("smallest_error", "largest_error"):
            row[name] = row[name] if row[name] >= 0 else np.nan
    return ConditionResult(
        mesh=output,
        condition=filter_.GetCondition() or np.nan,
        preconditioned_condition=filter_.GetPreconditionedCondition() or np.nan,
        spectrum=spectrum,
        largest_eigenvalue=cell_array(output, "LargestEigenvalue"),
        share=cell_array(output, "Share") if filter_.GetComputeShares() and has_array(output, "Share") else np.zeros(0),
        unknowns=filter_.GetUnknowns(),
        summary=filter_.GetSummary(),
    )


def solver_study_result(filter_: Any, _output: vtkDataObject) -> SolverStudyResult:
    """The result of a filter that has run."""
    rows = _rows(filter_.GetStudy(), _STUDY_COLUMNS)
    for row in rows:
        row["number"], row["iterations"] = int(row["number"]), int(row["iterations"])
        row["converged"] = bool(row["converged"])
        row["seconds"] = row["seconds"] if row["converged"] else np.nan
        row["condition"] = row["condition"] or np.nan
    return SolverStudyResult(
        rows=rows,
        recommended=filter_.GetRecommended(),
        why=filter_.GetWhy(),
        unknowns=filter_.GetUnknowns(),
        summary=filter_.GetSummary(),
    )


def _series(filter_: Any, name: str, times: Array) -> Array:
    """The solution at all times; the filter's output is the last one afterwards."""
    found = []
    for step in times:
        filter_.UpdateTimeStep(float(step))
        found.append(point_array(filter_.GetOutputDataObject(0), name).copy())
    return np.array(found)


def _rows(table: Any, names: dict[str, str]) -> list[dict[str, Any]]:
    """The rows of a table as dicts of Python numbers and texts; columns are renamed by `names`, or to lower case."""
    data = {names.get(name, name.lower()): values for name, values in columns(table).items()}
    return table_rows({k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in data.items()})


# --- the shell ----------------------------------------------------------------------------------------------


def _add_problem(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--source", type=_function, metavar="F",
                        help="numbers, a point array or an expression (default: 1)")  # fmt: skip
    parser.add_argument("--fixed", metavar="WHERE", help="expression on the boundary, or array (default: the boundary)")
    parser.add_argument("--given", type=_function, default=0.0, metavar="U", help="the solution there (default: 0)")


def add_solve_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    _add_problem(parser)
    parser.add_argument("--initial", type=_function, default=0.0, metavar="U",
                        help="the solution at time 0 (default: 0)")  # fmt: skip
    parser.add_argument("--velocity", type=_function, default=0.0, metavar="V",
                        help="its time derivative there, of newmark (default: 0)")  # fmt: skip


def solve_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, (*_PROBLEM, "initial", "velocity"))


def add_condition_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    _add_problem(parser)


def condition_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, _PROBLEM)


def add_solver_study_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of these arguments."""
    _add_problem(parser)
    others = ", ".join(f"{number} {name}" for number, name in solver_combinations().items() if number > _TABLE_2_5)
    parser.add_argument("--combinations", type=_combinations, metavar="N,...",
                        help=f"numbers, 1 to {_TABLE_2_5} of Table 2.5 (the default) and above: {others}")  # fmt: skip


def solver_study_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, (*_PROBLEM, "combinations"))


def _function(text: str) -> float | list[float] | str:
    values: Any = _commands.numbers_or_text(text)
    made: float | list[float] | str = values[0] if isinstance(values, list) and len(values) == 1 else values
    return made


def _combinations(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


_PROBLEM = ("source", "fixed", "given")


def finish_solve(arguments: argparse.Namespace, result: SolveResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 0 if result.converged else 1


def finish_condition(arguments: argparse.Namespace, result: ConditionResult) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, result.spectrum)


def finish_solver_study(arguments: argparse.Namespace, result: SolverStudyResult) -> int:
    """Print the result of the command."""
    shown = ("number", "name", "result", "iterations", "condition", "reason")
    table = align([[row[key] for key in shown] for row in result.rows], shown)
    _commands.finish(arguments, result, f"{table}\n\n{result.summary}", result.rows)
    return 0 if any(row["converged"] for row in result.rows) else 1
