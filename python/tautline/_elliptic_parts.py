# SPDX-License-Identifier: BSD-3-Clause
"""The functions solve, condition and solver_study: elliptic partial differential equations on a mesh."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from inspect import signature
from typing import Any, Callable, ClassVar, Iterable, Literal, Union, get_args

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands, _vtk
from ._arguments import (
    PRECONDITIONERS, Preconditioner, Redistribution, check_options, number, pick, picked, set_redistribution,
    set_threads, set_time_limit, within,
)  # fmt: skip
from ._arrays import POINTS, Array, InputArrays, Values, cell_array, columns, has_array, point_array, table_rows
from ._errors import Error, checked, interruptible, run, watch
from ._interrupts import Progress
from ._io import Mesh, as_mesh
from ._results import Result
from ._tables import align

Pde = Literal["poisson", "elliptic", "elasticity"]
PDES: tuple[Pde, ...] = get_args(Pde)
Solver = Literal["cg", "gmres", "minres", "bicgstab", "direct"]
SOLVERS: tuple[Solver, ...] = get_args(Solver)
Plane = Literal["strain", "stress"]
PLANES: tuple[Plane, ...] = get_args(Plane)
TimeScheme = Literal["stationary", "backward euler", "bdf2", "crank-nicolson", "newmark"]
TIME_SCHEMES: tuple[TimeScheme, ...] = get_args(TimeScheme)
Mass = Literal["consistent", "lumped"]
MASSES: tuple[Mass, ...] = get_args(Mass)
Method = Literal["automatic", "ritz", "accurate"]
METHODS: tuple[Method, ...] = get_args(Method)

_MAX_ITERATIONS = 2**31 - 1
_MAX_TIME_STEPS = 1_000_000
_TABLE_2_5 = 16  # the first combinations of solver and preconditioner are those of the dissertation's Table 2.5
_FIXED, _SOURCE, _GIVEN, _TENSOR, _STIFFNESS, _INITIAL, _VELOCITY = range(7)  # input arrays of vtkEllipticSolver
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
    """The result of solve(). Of composite data, numbers are of all blocks; the reason is that of the last one.

    mesh: the mesh with the solution on the points and, on the cells, `Gradient`, or `Stress` and `VonMises`.
    solution: the solution per point, n; of elasticity the displacement, n x 3.
    gradient: per cell the gradient, m x 3; of elasticity the stress, m x 6 (xx yy zz xy yz xz). Empty if not computed.
    times, series: the times of the steps and the solution at each of them, (steps + 1) x n or n x 3; None of stationary
        problems, and the solutions also unless asked for.
    history: with time steps, per step `time`, `iterations`, `residual`. Else per iteration (0 is the start) `residual`,
        the norm that the method uses, and `log10_residual`, relative to the first one. Of composite data also `block`.
    converged, reason, iterations: whether the method converged, and the stopping criterion that ended it.
    unknowns: number of unknowns.
    assembly_seconds, setup_seconds, solve_seconds: times of the assembly, of the set-up of the preconditioner or
        factorization, and of the solution.
    summary: the result in words.
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
    summary: str


@dataclass(frozen=True, repr=False, eq=False)
class ConditionResult(Result):
    """The result of condition().

    mesh: the mesh with the cell arrays `LargestEigenvalue`, `Excess` (its log10 over the geometric mean) and `Share`.
    condition, preconditioned_condition: condition numbers of A and of P^-1 A, of composite data the largest; nan where
        they are unknown.
    spectrum: A row (dict) for A and one for P^-1 A: matrix, smallest, largest, condition, smallest_error, largest_error
        (relative bounds; nan: unknown), converged, iterations, seconds, method, message; of composite data also block.
    largest_eigenvalue, share: per cell, m: the largest eigenvalue of its matrix, and its share of the largest
        eigenvalue of A; the shares add up to 1. `share` is empty if not computed, for lack of time, too.
    unknowns: number of unknowns.
    summary: the result in words.
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

    rows: A row (dict) per combination: name, number (1 to 16 are those of Table 2.5), seconds (total; nan if it
        failed), result (the same as text; "*" if it failed, "-" if no time was left), setup_seconds, solve_seconds,
        cpu_seconds (of the process for both), iterations, condition (of P^-1 A; nan: unknown), true_residual,
        converged, reason; of composite data also block.
    recommended, why: the name of the recommended combination and the reason for it; "" if none converged or the times
        of the fastest do not differ by more than a tenth or a millisecond.
    unknowns: number of unknowns.
    summary: the result in words.
    """

    rows: list[dict[str, Any]]
    recommended: str
    why: str
    unknowns: int
    summary: str


@interruptible
def solve(
    mesh: Mesh,
    pde: Pde = "poisson",
    solver: Solver = "cg",
    preconditioner: Preconditioner = "boomeramg",
    *,
    relative_tolerance: float = 1e-5,
    absolute_tolerance: float = 1e-50,
    maximum_iterations: int = 10000,
    restart: int = 30,
    rigid_body_modes: bool = True,
    fast_multigrid: bool = True,
    solution_name: str = "",
    gradient: bool = True,
    time_scheme: TimeScheme = "stationary",
    time_step: float = 0.01,
    time_steps: int = 100,
    mass: Mass = "consistent",
    density: float = 1.0,
    initial: Function = 0.0,
    velocity: Function = 0.0,
    series: bool = False,
    progress: Progress | bool | None = None,
    **problem: Any,
) -> SolveResult:
    """Solve an elliptic partial differential equation on a mesh by linear finite elements, or a heat or wave equation.

    mesh: triangles, quadrilaterals, tetrahedra, hexahedra, wedges or pyramids: a vtkDataSet, a composite data set, a
        file name or (points, cells). It is not changed.
    pde: "poisson", -laplace u = f; "elliptic", -alpha u_xx - beta u_yy - gamma u_zz + reaction u = f; "elasticity",
        linear elasticity, u is the displacement.
    solver: "cg", "gmres", "minres", "bicgstab", or "direct".
    preconditioner: "jacobi", "ssor", "ilu", "boomeramg", "icc", "gamg" (smoothed aggregation), "none".
    relative_tolerance, absolute_tolerance: of the preconditioned residual, 0 to 1, and at least 0.
    maximum_iterations: at least 0.
    restart: m of GMRES(m), at least 1.
    rigid_body_modes: whether the rigid body modes are passed to the multigrid method (elasticity).
    fast_multigrid: whether "boomeramg" coarsens aggressively, which takes more iterations and less time; False: PETSc's
        defaults.
    solution_name: name of the point array of the solution; "" is `Solution`, or `Displacement` of elasticity.
    gradient: whether to compute the gradient or the stress of the cells.
    time_scheme: "stationary", L u = f; of the heat equation, density u_t + L u = f: "backward euler" (order 1), "bdf2",
        "crank-nicolson" (order 2); of the wave equation, density u_tt + L u = f: "newmark" (constant average
        acceleration, order 2). The source and the given solution do not depend on time.
    time_step: length of a time step, above 0. time_steps: number of them, 1 to 1,000,000.
    mass: the mass matrix, "consistent" or "lumped" (the sums of its rows on the diagonal).
    density: above 0.
    initial, velocity: the solution at time 0, and its time derivative there ("newmark"): see source.
    series: whether the result has the solution at all times; the mesh has that of the last one.

    problem: further options, the same for solve(), condition() and solver_study():
        source: f, by default 1 (elasticity: (1, 0, 0)).
        given: the solution at fixed points, by default 0.
            Both are a number (elasticity: 2 or 3 of them), the name or the values of a point array, or an expression of
            x, y, z and point arrays: "sin(x)*y" (elasticity: "x*iHat - jHat").
        fixed: the points with a given solution. None: the boundary. An expression: the points of the boundary where it
            holds, such as "x < 0.1". Name or values of a point or cell array: where it is not 0 (at the points of these
            cells), and nowhere else.
        alpha, beta, gamma, reaction: coefficients of "elliptic", each 1.
        tensor: name or values of a cell array with 6 (xx yy zz xy yz xz) or 9 components instead of alpha, beta, gamma.
        youngs_modulus (1), poisson_ratio (0.3), plane ("strain" or "stress", of planar meshes): of "elasticity".
        stiffness: name or values of a cell array of factors of Young's modulus.
        omega: relaxation of SSOR (1).
        petsc_options: options of PETSc that choose and tune methods and preconditioners, such as
            "-pc_hypre_boomeramg_strong_threshold 0.5". Others, which read, write or display something, are refused.
        time_limit: seconds; 0, the default, is no limit.
        threads: number of threads; 0, the default, is all cores. The result does not depend on it.
        merge_coincident_points: whether points at the same place on facets that match are treated as one (True), as on
            the seams of a mesh in pieces, and blocks with a seam between them as one mesh; the result keeps them all.
            False: they stay apart, as a crack or a contact needs it.
        redistribute: on several processes (pvbatch --sym under MPI, where each calls this function with its piece):
            divide the mesh anew among them, also where the first one has all of it; "off", "k-d tree" (or True),
            "pt-scotch". The result is that of the piece.

    A method that does not converge is not an error: see converged, reason and summary of the result, which has the best
    solution found. Raises Error for wrong arguments and for meshes that the filter refuses.

    >>> result = tautline.solve("plate.vtu", source="x*y", fixed="x < 0.01")
    >>> result.solution.max(), result.iterations
    """
    filter_ = _vtk.vtkEllipticSolver()
    elastic = picked("pde", pde, PDES) == "elasticity"
    filter_.SetSolver(pick("solver", solver, SOLVERS))
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    _set_tolerances(filter_, relative_tolerance, absolute_tolerance, maximum_iterations, restart)
    filter_.SetRigidBodyModes(bool(rigid_body_modes))
    filter_.SetFastMultigrid(bool(fast_multigrid))
    filter_.SetSolutionName(solution_name)
    filter_.SetComputeGradient(bool(gradient))
    scheme = pick("time_scheme", time_scheme, TIME_SCHEMES)
    filter_.SetTimeScheme(scheme)
    filter_.SetTimeStep(number("time_step", time_step))
    filter_.SetNumberOfTimeSteps(int(within("time_steps", time_steps, 1, _MAX_TIME_STEPS)))
    filter_.SetMassMatrix(pick("mass", mass, MASSES))
    filter_.SetDensity(number("density", density))
    start = {"initial": initial, "velocity": velocity} if scheme else {}
    output = _execute(solve, filter_, mesh, pde, problem, start)
    fields = "Stress" if elastic else "Gradient"
    history = columns(filter_.GetHistory())
    names = {"Log10 residual": "log10_residual", "N residual": "residual", "Block": "block", "Time": "time",
             "N iterations": "iterations"}  # fmt: skip
    times = np.arange(int(time_steps) + 1) * float(time_step) if scheme else None
    name = solution_name or ("Displacement" if elastic else "Solution")
    if times is not None:
        times = times[: filter_.GetComputedTimeSteps() + 1]  # fewer if one did not converge
    return SolveResult(
        mesh=output,
        solution=point_array(output, name),
        gradient=cell_array(output, fields) if gradient else np.zeros(0),
        times=times,
        series=_series(filter_, name, times) if series and times is not None else None,
        history={names[name]: values for name, values in history.items()},
        converged=bool(filter_.GetConverged()),
        reason=filter_.GetReason(),
        iterations=filter_.GetIterations(),
        unknowns=filter_.GetUnknowns(),
        assembly_seconds=filter_.GetAssemblySeconds(),
        setup_seconds=filter_.GetSetupSeconds(),
        solve_seconds=filter_.GetSolveSeconds(),
        summary=filter_.GetSummary(),
    )


@interruptible
def condition(
    mesh: Mesh,
    pde: Pde = "poisson",
    preconditioner: Preconditioner = "boomeramg",
    *,
    method: Method = "automatic",
    tolerance: float = 1e-6,
    maximum_iterations: int = 10000,
    shares: bool = True,
    progress: Progress | bool | None = None,
    **problem: Any,
) -> ConditionResult:
    """Estimate the condition number of the matrix A of a partial differential equation, and the share of each element.

    mesh, pde, problem: see solve().
    preconditioner: P; the condition number of P^-1 A is estimated, too, unless it is "none".
    method: "ritz" (Ritz values of a Krylov method: fast, without error bounds), "accurate" (to the tolerance), or
        "automatic".
    tolerance: relative, of the eigenvalues, 1e-15 to 1.
    maximum_iterations: at least 1.
    shares: whether to compute the share of each cell in the largest eigenvalue.

    Raises Error for wrong arguments and for meshes that the filter refuses.

    >>> result = tautline.condition("plate.vtu", preconditioner="jacobi")
    >>> result.condition, result.preconditioned_condition
    """
    filter_ = _vtk.vtkConditionEstimator()
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    filter_.SetMethod(pick("method", method, METHODS))
    filter_.SetTolerance(within("tolerance", tolerance, 1e-15, 1))
    filter_.SetMaximumIterations(int(within("maximum_iterations", maximum_iterations, 1, _MAX_ITERATIONS)))
    filter_.SetComputeShares(bool(shares))
    output = _execute(condition, filter_, mesh, pde, problem)
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
        share=cell_array(output, "Share") if shares and has_array(output, "Share") else np.zeros(0),
        unknowns=filter_.GetUnknowns(),
        summary=filter_.GetSummary(),
    )


@checked
def solver_combinations() -> dict[int, str]:
    """The combinations of solver and preconditioner of solver_study() by number; 1 to 16 are those of Table 2.5."""
    study = _vtk.vtkSolverStudy
    return {number: study.GetCombinationName(number) for number in range(1, study.GetNumberOfCombinations() + 1)}


@interruptible
def solver_study(
    mesh: Mesh,
    pde: Pde = "poisson",
    combinations: Iterable[int | str] | None = None,
    *,
    relative_tolerance: float = 1e-5,
    absolute_tolerance: float = 1e-50,
    maximum_iterations: int = 10000,
    restart: int = 30,
    conditions: bool = True,
    repetitions: int = 1,
    combination_time_limit: float = 60.0,
    progress: Progress | bool | None = None,
    **problem: Any,
) -> SolverStudyResult:
    """Solve by many combinations of solver and preconditioner and recommend one.

    mesh, pde, problem: see solve(); time_limit is that of the whole study.
    combinations: numbers or names, see solver_combinations(). None: 1 to 16, those of the dissertation's Table 2.5.
    relative_tolerance, absolute_tolerance, maximum_iterations, restart: see solve().
    conditions: whether to estimate the condition number of each P^-1 A.
    repetitions: number of runs of each combination, 1 to 100, of which the fastest counts.
    combination_time_limit: seconds after which a combination counts as failed; 0 is no limit.

    Raises Error for wrong arguments and for meshes that the filter refuses; combinations that fail are not an error.

    >>> study = tautline.solver_study("plate.vtu", combinations=[1, 13])
    >>> study.recommended, study.why
    """
    filter_ = _vtk.vtkSolverStudy()
    known = solver_combinations()
    for chosen in known if combinations is None else combinations:
        number = {name.lower(): key for key, name in known.items()}.get(str(chosen).lower(), chosen)
        if number not in known:
            listed = ", ".join(f"{k}: {v}" for k, v in known.items())
            raise Error(f"there is no combination {chosen!r}; there are {listed}")
        if combinations is not None or int(number) <= _TABLE_2_5:
            filter_.AddCombination(number)
    _set_tolerances(filter_, relative_tolerance, absolute_tolerance, maximum_iterations, restart)
    filter_.SetEstimateConditions(bool(conditions))
    filter_.SetRepetitions(int(within("repetitions", repetitions, 1, 100)))
    filter_.SetCombinationTimeLimit(within("combination_time_limit", combination_time_limit, 0, np.inf))
    _execute(solver_study, filter_, mesh, pde, problem)
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


def _set_tolerances(filter_: Any, relative: float, absolute: float, iterations: int, restart: int) -> None:
    filter_.SetRelativeTolerance(within("relative_tolerance", relative, 0, 1))
    filter_.SetAbsoluteTolerance(within("absolute_tolerance", absolute, 0, np.inf))
    filter_.SetMaximumIterations(int(within("maximum_iterations", iterations, 0, _MAX_ITERATIONS)))
    filter_.SetRestart(int(within("restart", restart, 1, _MAX_ITERATIONS)))


# The arguments of _set_problem() before those of the user.
_FILTER_ARGUMENTS = 3


def _execute(
    function: Callable[..., Any], filter_: Any, mesh: Mesh, pde: str, problem: dict[str, Any],
    start: dict[str, Function] | None = None,
) -> vtkDataObject:  # fmt: skip
    """Set the problem, run the filter of a function; returns its first output without the arrays given as numbers.

    start: functions at time 0 by name.
    """
    messages = watch(filter_)
    inputs = InputArrays(filter_, as_mesh(mesh))
    own = [p.name for p in signature(function).parameters.values() if p.kind is not p.VAR_KEYWORD]
    check_options(problem, [*own, *list(signature(_set_problem).parameters)[_FILTER_ARGUMENTS:]])
    _set_problem(filter_, inputs, pde, **problem)
    set_function = _set_vector_function if pde == "elasticity" else _set_scalar_function
    for name, value in (start or {}).items():
        set_function(filter_, inputs, name, value, {"initial": _INITIAL, "velocity": _VELOCITY}[name])
    filter_.SetInputDataObject(0, inputs.mesh)
    run(filter_, messages)
    return inputs.remove_from(filter_.GetOutputDataObject(0))


def _set_problem(
    filter_: Any,
    inputs: InputArrays,
    pde: str,
    *,
    source: Function | None = None,
    given: Function = 0.0,
    fixed: Values | None = None,
    alpha: float = 1.0,
    beta: float = 1.0,
    gamma: float = 1.0,
    reaction: float = 1.0,
    tensor: Values | None = None,
    youngs_modulus: float = 1.0,
    poisson_ratio: float = 0.3,
    plane: Plane = "strain",
    stiffness: Values | None = None,
    omega: float = 1.0,
    petsc_options: str = "",
    time_limit: float = 0.0,
    threads: int = 0,
    merge_coincident_points: bool = True,
    redistribute: Redistribution | bool = "off",
) -> None:
    """Set the equation with its functions and boundary conditions; see solve()."""
    filter_.SetEquation(pick("pde", pde, PDES))
    filter_.SetAlpha(float(alpha))
    filter_.SetBeta(float(beta))
    filter_.SetGamma(float(gamma))
    filter_.SetReaction(float(reaction))
    filter_.SetYoungsModulus(float(youngs_modulus))
    filter_.SetPoissonRatio(float(poisson_ratio))
    filter_.SetPlaneState(pick("plane", plane, PLANES))
    filter_.SetOmega(float(omega))
    filter_.SetPETScOptions(petsc_options)
    set_time_limit(filter_, time_limit)
    set_threads(filter_, threads)
    filter_.SetMergeCoincidentPoints(bool(merge_coincident_points))
    set_redistribution(filter_, redistribute)
    set_function = _set_vector_function if picked("pde", pde, PDES) == "elasticity" else _set_scalar_function
    if source is not None:
        set_function(filter_, inputs, "source", source, _SOURCE)
    set_function(filter_, inputs, "given", given, _GIVEN)
    if isinstance(fixed, str) and not has_array(inputs.mesh, fixed):
        filter_.SetFixedPart(_PART)
        filter_.SetFixedWhere(fixed)
    elif fixed is not None:
        filter_.SetFixedPart(_CHOSEN)
        inputs.use(_FIXED, fixed, "fixed")
    inputs.use(_TENSOR, tensor, "tensor")
    inputs.use(_STIFFNESS, stiffness, "stiffness")


def _set_scalar_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` of a scalar equation."""
    if not isinstance(value, str) and np.size(value) == 1 and np.ndim(value) < 2:
        getattr(filter_, f"Set{name.capitalize()}Value")(float(np.asarray(value).item()))
    else:
        _set_variable_function(filter_, inputs, name, value, index)


#: The setters of constant vectors.
_VECTOR_SETTERS = {"source": "SetBodyForce", "given": "SetGivenDisplacement", "initial": "SetInitialDisplacement",
                   "velocity": "SetVelocityVector"}  # fmt: skip


def _set_vector_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` of elasticity: a constant vector by a setter of its own; the number 0 is the vector 0."""
    if isinstance(value, str) or np.size(value) > 3 or np.ndim(value) > 1:
        _set_variable_function(filter_, inputs, name, value, index)
        return
    if np.size(value) == 1 and np.all(np.asarray(value, float) == 0):
        value = (0.0, 0.0, 0.0)
    if np.size(value) not in (2, 3):
        raise Error(f"{name} is {value!r}; of elasticity it is a vector of two or three numbers")
    getattr(filter_, _VECTOR_SETTERS[name])(*(float(v) for v in [*np.ravel(value), 0.0][:3]))


def _set_variable_function(filter_: Any, inputs: InputArrays, name: str, value: Function, index: int) -> None:
    """Set `source` or `given` as an expression, or as a point array by name or by values."""
    setter = f"Set{name.capitalize()}"
    if isinstance(value, str) and not has_array(inputs.mesh, value, POINTS):
        getattr(filter_, f"{setter}Type")(_EXPRESSION)
        getattr(filter_, f"{setter}Expression")(value)
    else:
        getattr(filter_, f"{setter}Type")(_ARRAY)
        inputs.use(index, value, name, POINTS)


def _series(filter_: Any, name: str, times: Array) -> Array:
    """The solution at all times; the output is then that of the last one."""
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


def add_commands(commands: Any) -> None:
    """Add `solve`, `condition` and `solver-study` to the subparsers of the command line."""
    made = _add_problem(commands, "solve", _run_solve, "solve a partial differential equation on a mesh")
    _commands.add_output(made, "write the mesh with the solution", False)
    made.add_argument("--csv", metavar="FILE", help="write the residuals, a row per iteration")
    made.add_argument("--solver", choices=SOLVERS, default="cg")
    made.add_argument("--preconditioner", choices=PRECONDITIONERS, default="boomeramg")
    made.add_argument("--relative-tolerance", "--tolerance", type=float, default=1e-5,
                      help="relative, of the preconditioned residual (default: 1e-5)")  # fmt: skip
    _add_maximum_iterations(made)
    made.add_argument("--restart", type=int, default=30, help="m of GMRES(m) (default: 30)")
    _add_absolute_tolerance(made)
    _commands.add_flag(made, "rigid_body_modes", "whether multigrid gets the rigid body modes, of elasticity")
    _commands.add_flag(made, "fast_multigrid", "whether boomeramg coarsens aggressively, or as PETSc has it")
    made.add_argument("--solution-name", default="", metavar="NAME",
                      help="of the array (default: Solution, of elasticity Displacement)")  # fmt: skip
    _commands.add_flag(made, "gradient", "whether the cells get the gradient or stress")
    made.add_argument("--time-scheme", choices=TIME_SCHEMES, default="stationary",
                      help="of the heat equation, or newmark of the wave equation (default: stationary)")  # fmt: skip
    made.add_argument("--time-step", type=float, default=0.01, help="length of a time step (default: 0.01)")
    made.add_argument("--time-steps", type=int, default=100, metavar="N", help="number of time steps (default: 100)")
    made.add_argument("--mass", choices=MASSES, default="consistent", help="the mass matrix (default: consistent)")
    made.add_argument("--density", type=float, default=1.0, help="factor of the time derivative (default: 1)")
    made.add_argument("--initial", type=_function, default=0.0, metavar="U", help="the solution at time 0 (default: 0)")
    made.add_argument("--velocity", type=_function, default=0.0, metavar="V",
                      help="its time derivative there, of newmark (default: 0)")  # fmt: skip

    made = _add_problem(commands, "condition", _run_condition,
                        "estimate the condition number of a linear system, and the share of each element")  # fmt: skip
    _commands.add_output(made, "write the mesh with each element's share", False)
    made.add_argument("--csv", metavar="FILE", help="write the spectrum, a row for A and one for P^-1 A")
    made.add_argument("--preconditioner", choices=PRECONDITIONERS, default="boomeramg")
    made.add_argument("--method", choices=METHODS, default="automatic")
    made.add_argument("--tolerance", type=float, default=1e-6, help="of the eigenvalues (default: 1e-6)")
    _add_maximum_iterations(made)
    _commands.add_flag(made, "shares", "whether the cells get their shares of the largest eigenvalue")

    made = _add_problem(commands, "solver-study", _run_study,
                        "run many combinations of solver and preconditioner, recommend one")  # fmt: skip
    made.add_argument("--csv", metavar="FILE", help="write the table, a row per combination")
    made.add_argument("--combinations", type=_combinations, metavar="N,...",
                      help=f"numbers, 1 to {_TABLE_2_5} of Table 2.5 (the default) and above: "
                      + ", ".join(f"{k} {v}" for k, v in solver_combinations().items() if k > _TABLE_2_5))  # fmt: skip
    made.add_argument("--relative-tolerance", type=float, default=1e-5,
                      help="of the preconditioned residual (default: 1e-5)")  # fmt: skip
    _add_absolute_tolerance(made)
    _add_maximum_iterations(made)
    made.add_argument("--restart", type=int, default=30, help="m of GMRES(m) (default: 30)")
    _commands.add_flag(made, "conditions", "whether to estimate the condition number of each combination")
    made.add_argument("--repetitions", type=int, default=1, help="the fastest run counts (default: 1)")
    made.add_argument("--combination-time-limit", type=float, default=60.0, metavar="SECONDS",
                      help="of each combination; 0 is no limit (default: 60)")  # fmt: skip


def _add_absolute_tolerance(made: argparse.ArgumentParser) -> None:
    made.add_argument("--absolute-tolerance", type=float, default=1e-50,
                      help="of the preconditioned residual (default: 1e-50)")  # fmt: skip


def _add_maximum_iterations(made: argparse.ArgumentParser) -> None:
    made.add_argument("--maximum-iterations", "--iterations", type=int, default=10000, help="(default: 10000)")


#: Example and further sentence of the help of the commands.
_HELP = {
    "solve": (
        'plate.vtu --source "x*y" --fixed "x < 0.01" -o solved.vtu',
        "By linear finite elements; exits with 1 if the solver does not converge.",
    ),
    "condition": ("plate.vtu --preconditioner jacobi -o shares.vtu", "A is the matrix, P the preconditioner."),
    "solver-study": ("plate.vtu --combinations 1,13 --csv study.csv", "Prints a row per combination."),
}


def _add_problem(commands: Any, name: str, run_command: _commands.Run, text: str) -> argparse.ArgumentParser:
    """Add a command with the mesh and the options of the problem."""
    example, details = _HELP[name]
    made = _commands.add_command(commands, name, run_command, text, example=example, details=details)
    _commands.add_mesh(made)
    made.add_argument("--pde", choices=PDES, default="poisson")
    made.add_argument("--source", type=_function, metavar="F",
                      help="numbers, a point array or an expression (default: 1)")  # fmt: skip
    made.add_argument("--fixed", metavar="WHERE", help="expression on the boundary, or array (default: the boundary)")
    made.add_argument("--given", type=_function, default=0.0, metavar="U", help="the solution there (default: 0)")
    for coefficient in ("alpha", "beta", "gamma", "reaction"):
        made.add_argument(f"--{coefficient}", type=float, default=1.0, help="of elliptic (default: 1)")
    made.add_argument("--tensor", metavar="ARRAY", help="of elliptic: cell array instead of alpha, beta, gamma")
    made.add_argument("--youngs-modulus", type=float, default=1.0, help="of elasticity (default: 1)")
    made.add_argument("--poisson-ratio", type=float, default=0.3, help="of elasticity (default: 0.3)")
    made.add_argument("--plane", choices=PLANES, default="strain", help="of elasticity, planar meshes")
    made.add_argument("--stiffness", metavar="ARRAY", help="of elasticity: cell array of factors of Young's modulus")
    made.add_argument("--omega", type=float, default=1.0, help="relaxation of SSOR (default: 1)")
    made.add_argument("--petsc-options", default="", metavar="TEXT")
    _commands.add_merge_points(made)
    _commands.add_time_limit(made)
    return made


def _function(text: str) -> float | list[float] | str:
    values: Any = _commands.numbers_or_text(text)
    made: float | list[float] | str = values[0] if isinstance(values, list) and len(values) == 1 else values
    return made


def _combinations(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


_PROBLEM = (
    *("source", "fixed", "given", "alpha", "beta", "gamma", "reaction", "tensor", "youngs_modulus", "poisson_ratio"),
    *("plane", "stiffness", "omega", "petsc_options", "time_limit", "threads", "merge_coincident_points"),
)


def _call(function: Callable[..., Any], arguments: argparse.Namespace, *names: str) -> Any:
    return function(arguments.mesh, arguments.pde, **_commands.given(arguments, (*names, *_PROBLEM)))


def _run_solve(arguments: argparse.Namespace) -> int:
    names = ("solver", "preconditioner", "relative_tolerance", "absolute_tolerance", "maximum_iterations", "restart",
             "rigid_body_modes", "fast_multigrid", "solution_name", "gradient", "time_scheme",
             "time_step", "time_steps", "mass", "density", "initial", "velocity")  # fmt: skip
    result = _call(solve, arguments, *names)
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 0 if result.converged else 1


def _run_condition(arguments: argparse.Namespace) -> None:
    result = _call(condition, arguments, "preconditioner", "method", "tolerance", "maximum_iterations", "shares")
    _commands.finish(arguments, result, result.summary, result.spectrum)


def _run_study(arguments: argparse.Namespace) -> int:
    names = ("combinations", "relative_tolerance", "absolute_tolerance", "maximum_iterations", "restart", "conditions",
             "repetitions", "combination_time_limit")  # fmt: skip
    result = _call(solver_study, arguments, *names)
    shown = ("number", "name", "result", "iterations", "condition", "reason")
    table = align([[row[key] for key in shown] for row in result.rows], shown)
    _commands.finish(arguments, result, f"{table}\n\n{result.summary}", result.rows)
    return 0 if any(row["converged"] for row in result.rows) else 1
