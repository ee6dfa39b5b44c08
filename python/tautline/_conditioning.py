"""The verbs solve, condition and solver_study: elliptic partial differential equations on a mesh."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, Iterable, Sequence, Union

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataObject

import tautline

from ._errors import Error, run, watch
from ._mesh import Mesh, as_mesh, cell_array, columns, leaves, point_array, with_array
from ._metrics import pick, within

PDES = ("poisson", "elliptic", "elasticity")
SOLVERS = ("cg", "gmres", "minres", "bicgstab", "direct")
PRECONDITIONERS = ("jacobi", "ssor", "ilu", "amg", "icc", "gamg", "none")
PLANES = ("strain", "stress")
METHODS = ("automatic", "ritz", "accurate")

_MOST_THREADS = 1024
_MOST_ITERATIONS = 2**31 - 1
_OWN = "given "  # arrays given in numbers go to the filter by names that begin so
_FIXED, _SOURCE, _GIVEN, _TENSOR, _STIFFNESS = range(5)  # arrays to process of vtkEllipticAlgorithm
_CONSTANT, _ARRAY, _EXPRESSION = range(3)
_WHOLE, _PART, _CHOSEN = range(3)
_STUDY_COLUMNS = {
    "Block": "block",
    "Combination": "name",
    "N combination": "number",
    "Total time (s)": "seconds",
    "Result": "result",
    "Time set-up (s)": "setup_seconds",
    "Time solve (s)": "solve_seconds",
    "N iterations": "iterations",
    "N condition": "condition",
    "N true residual": "true_residual",
    "N converged": "converged",
    "Reason": "reason",
}

#: A function on the points: a number (elasticity: 2 or 3 of them), the name or the values of a point array, or an
#: expression of x, y, z and the point arrays by name.
Function = Union[float, str, Sequence]


@dataclass(frozen=True)
class Solved:
    """What solve() found. Of composite data, numbers are of all blocks; the reason is that of the last."""

    #: The mesh with the solution at the points and, of the cells, `Gradient` or `Stress` and `VonMises`.
    mesh: vtkDataObject
    #: One value per point; of elasticity the displacement, n x 3.
    solution: np.ndarray
    #: Per cell: the gradient, m x 3; of elasticity the stress, m x 6 (xx yy zz xy yz xz). Empty if not asked for.
    gradient: np.ndarray
    #: `log10_residual`, relative to the first, and `residual`, the norm as the method measures it, per iteration; 0 is the
    #: start. Of composite data also `block`.
    history: dict[str, Any]
    #: Whether it converged, and how it ended.
    converged: bool
    reason: str
    iterations: int
    unknowns: int
    #: Of the assembly, of the set-up of the preconditioner or factorisation, and of the solve.
    assembly_seconds: float
    setup_seconds: float
    solve_seconds: float
    #: The result in words.
    summary: str


@dataclass(frozen=True)
class Conditioned:
    """What condition() found."""

    #: The mesh with the cell arrays `LargestEigenvalue`, `Excess` (its log10 over the geometric mean) and `Share`.
    mesh: vtkDataObject
    #: Condition numbers of A and of P^-1 A; nan where not known (of blocks, the largest).
    condition: float
    preconditioned_condition: float
    #: A row (dict) for A and one for P^-1 A: matrix, smallest, largest, condition, smallest_error, largest_error (relative
    #: bounds; nan: not known), converged, iterations, seconds, method, message; of composite data block.
    spectrum: list[dict[str, Any]]
    #: Per cell: the largest eigenvalue of its matrix, and its share of that of A, which add up to 1 (empty if not asked for).
    largest_eigenvalue: np.ndarray
    share: np.ndarray
    unknowns: int
    #: The result in words.
    summary: str


@dataclass(frozen=True)
class Study:
    """What solver_study() found."""

    #: A row (dict) per combination: name, number (of Table 2.5, or above 16), seconds (total; nan if it failed), result (the
    #: same as text, "*" if it failed, "-" if there was no time), setup_seconds, solve_seconds, iterations, condition (of
    #: P^-1 A; nan: not known), true_residual, converged, reason; of composite data block.
    rows: list[dict[str, Any]]
    #: The name of the combination recommended, "" if none converged, and why.
    recommended: str
    why: str
    unknowns: int
    #: The result in words.
    summary: str


def solve(
    mesh: Mesh,
    pde: str = "poisson",
    solver: str = "cg",
    preconditioner: str = "amg",
    *,
    relative_tolerance: float = 1e-5,
    absolute_tolerance: float = 1e-50,
    maximum_iterations: int = 10000,
    restart: int = 30,
    rigid_body_modes: bool = True,
    fast_multigrid: bool = True,
    solution_name: str = "",
    gradient: bool = True,
    **problem: Any,
) -> Solved:
    """Solve an elliptic partial differential equation on a mesh by linear finite elements.

    mesh: triangles, quadrilaterals, tetrahedra, hexahedra, wedges, pyramids: a vtkDataSet, a file name or (points, cells). Not changed.
    pde: "poisson", -laplace u = f; "elliptic", -alpha u_xx - beta u_yy - gamma u_zz + reaction u = f; "elasticity",
        linear, of the displacement u.
    solver: "cg", "gmres", "minres", "bicgstab", or "direct".
    preconditioner: "jacobi", "ssor", "ilu", "amg" (BoomerAMG), "icc", "gamg" (smoothed aggregation), "none".
    relative_tolerance, absolute_tolerance: of the preconditioned residual. restart: m of GMRES(m).
    rigid_body_modes: whether multigrid is told them (elasticity).
    fast_multigrid: whether "amg" coarsens aggressively: more iterations, less time. False: PETSc's defaults.
    solution_name: of the point array; "" is `Solution`, or `Displacement` of elasticity.
    gradient: whether to add the gradient or the stress of the cells.

    problem, for all three verbs:
        source: f, 1 (elasticity: (1, 0, 0)) by default, and given: the solution at fixed points, 0 by default. Each a
            number (elasticity: 2 or 3 of them), the name or the values of a point array, or an expression of x, y, z and point
            arrays: "sin(x)*y" (elasticity: "x*iHat - jHat").
        fixed: where the solution is given. None: on the boundary. An expression: where it holds on the boundary, such as
            "x < 0.1". Name or values of a point or cell array: where it is not 0 (at the cells' points), and nowhere else.
        alpha, beta, gamma, reaction: 1 each ("elliptic"); or tensor: name or values of a cell array with 6 (xx yy zz xy
            yz xz) or 9 components instead of the first three.
        youngs_modulus (1), poisson_ratio (0.3), plane ("strain" or "stress"), stiffness: name or values of a cell array
            of factors of Young's modulus ("elasticity").
        omega: relaxation of SSOR (1). petsc_options: "-pc_hypre_boomeramg_strong_threshold 0.5".
        time_limit: seconds (600), 0 is none. threads: 0 is all cores; the result does not depend on it.

    A solve that does not converge tells so (converged, reason) and has the best solution so far. Raises Error for wrong
    arguments and whatever the filter refuses.

    >>> result = tautline.solve("plate.vtu", source="x*y", fixed="x < 0.01")
    >>> result.solution.max(), result.iterations
    """
    filter_ = tautline.vtkEllipticSolver()
    elastic = pde == "elasticity"
    filter_.SetSolver(pick("solver", solver, SOLVERS))
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    _set_tolerances(filter_, relative_tolerance, absolute_tolerance, maximum_iterations, restart)
    filter_.SetRigidBodyModes(bool(rigid_body_modes))
    filter_.SetFastMultigrid(bool(fast_multigrid))
    filter_.SetSolutionName(solution_name)
    filter_.SetComputeGradient(bool(gradient))
    output = _execute(filter_, mesh, pde, problem)
    fields = "Stress" if elastic else "Gradient"
    history = columns(filter_.GetHistory())
    names = {"Log10 residual": "log10_residual", "N residual": "residual", "Block": "block"}
    return Solved(
        mesh=output,
        solution=point_array(output, solution_name or ("Displacement" if elastic else "Solution")),
        gradient=cell_array(output, fields) if gradient else np.zeros(0),
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


def condition(
    mesh: Mesh,
    pde: str = "poisson",
    preconditioner: str = "amg",
    *,
    method: str = "automatic",
    tolerance: float = 1e-6,
    maximum_iterations: int = 10000,
    shares: bool = True,
    **problem: Any,
) -> Conditioned:
    """Condition number of the matrix A of a partial differential equation on a mesh, and the elements that cause it.

    mesh, pde, problem: as for solve().
    preconditioner: P; P^-1 A is looked at, too, unless it is "none".
    method: "ritz" values of a Krylov method, cheap and without error bounds; "accurate" to the tolerance; "automatic".
    shares: whether to find each cell's share of the largest eigenvalue.
    """
    filter_ = tautline.vtkConditionEstimator()
    filter_.SetPreconditioner(pick("preconditioner", preconditioner, PRECONDITIONERS))
    filter_.SetMethod(pick("method", method, METHODS))
    filter_.SetTolerance(within("tolerance", tolerance, 1e-15, 1))
    filter_.SetMaximumIterations(int(within("maximum_iterations", maximum_iterations, 1, _MOST_ITERATIONS)))
    filter_.SetComputeShares(bool(shares))
    output = _execute(filter_, mesh, pde, problem)
    spectrum = _rows(filter_.GetSpectrum(), {"SmallestError": "smallest_error", "LargestError": "largest_error"})
    for row in spectrum:
        row["condition"] = row["condition"] or np.nan
        row["converged"] = bool(row["converged"])
        for name in ("smallest_error", "largest_error"):
            row[name] = row[name] if row[name] >= 0 else np.nan
    return Conditioned(
        mesh=output,
        condition=filter_.GetCondition() or np.nan,
        preconditioned_condition=filter_.GetPreconditionedCondition() or np.nan,
        spectrum=spectrum,
        largest_eigenvalue=cell_array(output, "LargestEigenvalue"),
        share=cell_array(output, "Share") if shares else np.zeros(0),
        unknowns=filter_.GetUnknowns(),
        summary=filter_.GetSummary(),
    )


def solver_combinations() -> dict[int, str]:
    """The combinations of solver and preconditioner of solver_study(), by number; 1 to 16 are Table 2.5."""
    study = tautline.vtkSolverStudy
    return {number: study.GetCombinationName(number) for number in range(1, study.GetNumberOfCombinations() + 1)}


def solver_study(
    mesh: Mesh,
    pde: str = "poisson",
    combinations: Iterable[int | str] | None = None,
    *,
    relative_tolerance: float = 1e-5,
    absolute_tolerance: float = 1e-50,
    maximum_iterations: int = 10000,
    restart: int = 30,
    conditions: bool = True,
    repetitions: int = 1,
    combination_time_limit: float = 60.0,
    **problem: Any,
) -> Study:
    """Solve by many combinations of solver and preconditioner and recommend one.

    mesh, pde, problem: as for solve(); time_limit is that of the whole study.
    combinations: numbers or names, see solver_combinations(); None: 1 to 16, those of dissertation Table 2.5.
    conditions: whether to estimate the condition number of each P^-1 A.
    repetitions: how often each is run; the best time counts.
    combination_time_limit: seconds after which a combination has failed; 0 is none.
    """
    filter_ = tautline.vtkSolverStudy()
    known = solver_combinations()
    for chosen in known if combinations is None else combinations:
        number = {name.lower(): key for key, name in known.items()}.get(str(chosen).lower(), chosen)
        if number not in known:
            raise Error(f"there is no combination {chosen!r}; there are {', '.join(f'{k}: {v}' for k, v in known.items())}")
        if combinations is not None or number <= 16:
            filter_.AddCombination(number)
    _set_tolerances(filter_, relative_tolerance, absolute_tolerance, maximum_iterations, restart)
    filter_.SetEstimateConditions(bool(conditions))
    filter_.SetRepetitions(int(within("repetitions", repetitions, 1, 100)))
    filter_.SetCombinationTimeLimit(within("combination_time_limit", combination_time_limit, 0, np.inf))
    _execute(filter_, mesh, pde, problem)
    rows = _rows(filter_.GetStudy(), _STUDY_COLUMNS)
    for row in rows:
        row["number"], row["iterations"] = int(row["number"]), int(row["iterations"])
        row["converged"] = bool(row["converged"])
        row["seconds"] = row["seconds"] if row["converged"] else np.nan
        row["condition"] = row["condition"] or np.nan
    return Study(
        rows=rows,
        recommended=filter_.GetRecommended(),
        why=filter_.GetWhy(),
        unknowns=filter_.GetUnknowns(),
        summary=filter_.GetSummary(),
    )


def _set_tolerances(filter_: Any, relative: float, absolute: float, iterations: int, restart: int) -> None:
    filter_.SetRelativeTolerance(within("relative_tolerance", relative, 0, 1))
    filter_.SetAbsoluteTolerance(within("absolute_tolerance", absolute, 0, np.inf))
    filter_.SetMaximumIterations(int(within("maximum_iterations", iterations, 0, _MOST_ITERATIONS)))
    filter_.SetRestart(int(within("restart", restart, 1, _MOST_ITERATIONS)))


def _execute(filter_: Any, mesh: Mesh, pde: str, problem: dict[str, Any]) -> vtkDataObject:
    """Set the problem, run the filter; its first output without the arrays that were given in numbers."""
    messages = watch(filter_)
    data = _set_problem(filter_, as_mesh(mesh), pde, **problem)
    filter_.SetInputDataObject(0, data)
    run(filter_, messages)
    output = filter_.GetOutputDataObject(0)
    for leaf in leaves(output):
        for fields in (leaf.GetPointData(), leaf.GetCellData()):
            names = [fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())]
            for name in names:
                if name and name.startswith(_OWN):
                    fields.RemoveArray(name)
    return output


def _set_problem(
    filter_: Any,
    data: vtkDataObject,
    pde: str,
    *,
    source: Function | None = None,
    given: Function = 0.0,
    fixed: str | Sequence | None = None,
    alpha: float = 1.0,
    beta: float = 1.0,
    gamma: float = 1.0,
    reaction: float = 1.0,
    tensor: str | Sequence | None = None,
    youngs_modulus: float = 1.0,
    poisson_ratio: float = 0.3,
    plane: str = "strain",
    stiffness: str | Sequence | None = None,
    omega: float = 1.0,
    petsc_options: str = "",
    time_limit: float = 600.0,
    threads: int = 0,
) -> vtkDataObject:
    """Hand a problem to a filter; the mesh with the arrays given in numbers."""
    number = pick("pde", pde, PDES)
    filter_.SetEquation(number)
    filter_.SetAlpha(float(alpha))
    filter_.SetBeta(float(beta))
    filter_.SetGamma(float(gamma))
    filter_.SetReaction(float(reaction))
    filter_.SetYoungsModulus(float(youngs_modulus))
    filter_.SetPoissonRatio(float(poisson_ratio))
    filter_.SetPlaneState(pick("plane", plane, PLANES))
    filter_.SetOmega(float(omega))
    filter_.SetPETScOptions(petsc_options)
    filter_.SetTimeLimit(within("time_limit", time_limit, 0, np.inf))
    filter_.SetThreads(int(within("threads", threads, 0, _MOST_THREADS)))
    elastic = pde == "elasticity"

    def use(slot: int, values: Any, name: str, points_only: bool = False) -> None:
        nonlocal data
        data, where, found = with_array(data, values, _OWN + name, points_only)
        filter_.SetInputArrayToProcess(slot, 0, 0, where, found)

    def set_function(name: str, value: Function, slot: int, constant: str) -> None:
        """A constant goes by the setter of its own name, the rest by type, array and expression."""
        prefix = name.capitalize()
        if isinstance(value, str) and not _has_array(data, value, points_only=True):
            getattr(filter_, f"Set{prefix}Type")(_EXPRESSION)
            getattr(filter_, f"Set{prefix}Expression")(value)
        elif isinstance(value, str) or np.size(value) > 3 or np.ndim(value) > 1:
            getattr(filter_, f"Set{prefix}Type")(_ARRAY)
            use(slot, value, name, points_only=True)
        elif elastic:
            if np.size(value) == 1 and np.all(np.asarray(value, float) == 0):
                value = (0.0, 0.0, 0.0)
            if np.size(value) not in (2, 3):
                raise Error(f"{name} is {value!r}; of elasticity it is a vector of two or three numbers")
            getattr(filter_, f"Set{constant}")(*(float(v) for v in (*value, 0.0)[:3]))
        elif np.size(value) == 1:
            getattr(filter_, f"Set{prefix}Value")(float(np.asarray(value).item()))
        else:
            use(slot, value, name, points_only=True)
            getattr(filter_, f"Set{prefix}Type")(_ARRAY)

    if source is not None:
        set_function("source", source, _SOURCE, "BodyForce")
    set_function("given", given, _GIVEN, "GivenDisplacement")
    if isinstance(fixed, str) and not _has_array(data, fixed):
        filter_.SetFixedPart(_PART)
        filter_.SetFixedWhere(fixed)
    elif fixed is not None:
        filter_.SetFixedPart(_CHOSEN)
        use(_FIXED, fixed, "fixed")
    if tensor is not None:
        use(_TENSOR, tensor, "tensor")
    if stiffness is not None:
        use(_STIFFNESS, stiffness, "stiffness")
    return data


def _has_array(data: vtkDataObject, name: str, points_only: bool = False) -> bool:
    return any(
        leaf.GetPointData().GetArray(name) or (not points_only and leaf.GetCellData().GetArray(name))
        for leaf in leaves(data)
    )


def _rows(table: Any, names: dict[str, str]) -> list[dict[str, Any]]:
    """The rows of a table as dicts, of plain numbers and texts."""
    data = {names.get(name, name.lower()): values for name, values in columns(table).items()}
    lists = [values.tolist() if isinstance(values, np.ndarray) else values for values in data.values()]
    return [dict(zip(data, row)) for row in zip(*lists)]


def add_commands(commands: Any) -> None:
    """Add `solve`, `condition` and `solver-study` to the subparsers of the command line; each sets `run`."""
    made = commands.add_parser("solve", help="solve a partial differential equation on a mesh")
    _add_problem(made)
    made.add_argument("-o", "--output", metavar="FILE", help="write the mesh with the solution")
    made.add_argument("--csv", metavar="FILE", help="write the residuals, a row per iteration")
    made.add_argument("--solver", choices=SOLVERS, default="cg")
    made.add_argument("--preconditioner", choices=PRECONDITIONERS, default="amg")
    made.add_argument("--tolerance", type=float, default=1e-5, dest="relative_tolerance",
                      help="of the preconditioned residual, relative (default: 1e-5)")  # fmt: skip
    made.add_argument("--iterations", type=int, default=10000, dest="maximum_iterations", help="(default: 10000)")
    made.add_argument("--restart", type=int, default=30, help="m of GMRES(m) (default: 30)")
    made.set_defaults(run=_run_solve)

    made = commands.add_parser("condition", help="condition number of a linear system, and the elements that cause it")
    _add_problem(made)
    made.add_argument("-o", "--output", metavar="FILE", help="write the mesh with each element's share")
    made.add_argument("--csv", metavar="FILE", help="write the spectrum, a row for A and one for P^-1 A")
    made.add_argument("--preconditioner", choices=PRECONDITIONERS, default="amg")
    made.add_argument("--method", choices=METHODS, default="automatic")
    made.add_argument("--tolerance", type=float, default=1e-6, help="of the eigenvalues (default: 1e-6)")
    made.set_defaults(run=_run_condition)

    made = commands.add_parser("solver-study", help="run many combinations of solver and preconditioner, recommend one")
    _add_problem(made)
    made.add_argument("--csv", metavar="FILE", help="write the table, a row per combination")
    made.add_argument("--combinations", type=_numbers, metavar="N,...",
                      help="numbers, 1 to 16 of Table 2.5 (the default) and above: "
                      + ", ".join(f"{k} {v}" for k, v in solver_combinations().items() if k > 16))  # fmt: skip
    made.add_argument("--restart", type=int, default=30, help="m of GMRES(m) (default: 30)")
    made.add_argument("--repetitions", type=int, default=1, help="the best time counts (default: 1)")
    made.set_defaults(run=_run_study)


def _add_problem(made: argparse.ArgumentParser) -> None:
    made.add_argument("mesh", metavar="FILE")
    made.add_argument("--pde", choices=PDES, default="poisson")
    made.add_argument("--source", type=_function, metavar="F", help="numbers, a point array or an expression (default: 1)")
    made.add_argument("--fixed", metavar="WHERE", help="expression on the boundary, or array (default: the boundary)")
    made.add_argument("--given", type=_function, default=0.0, metavar="U", help="the solution there (default: 0)")
    for name, default in (("alpha", 1.0), ("beta", 1.0), ("gamma", 1.0), ("reaction", 1.0)):
        made.add_argument(f"--{name}", type=float, default=default, help=f"of elliptic (default: {default:g})")
    made.add_argument("--tensor", metavar="ARRAY", help="of elliptic: cell array instead of alpha, beta, gamma")
    made.add_argument("--youngs-modulus", type=float, default=1.0, help="of elasticity (default: 1)")
    made.add_argument("--poisson-ratio", type=float, default=0.3, help="of elasticity (default: 0.3)")
    made.add_argument("--plane", choices=PLANES, default="strain", help="of elasticity, planar meshes")
    made.add_argument("--stiffness", metavar="ARRAY", help="of elasticity: cell array of factors")
    made.add_argument("--omega", type=float, default=1.0, help="of SSOR (default: 1)")
    made.add_argument("--petsc-options", default="", metavar="TEXT")
    made.add_argument("--time-limit", type=float, default=600.0, metavar="SECONDS")
    made.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")


def _function(text: str) -> float | list[float] | str:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        return text
    return numbers[0] if len(numbers) == 1 else numbers


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


_PROBLEM = (
    *("source", "fixed", "given", "alpha", "beta", "gamma", "reaction", "tensor", "youngs_modulus", "poisson_ratio"),
    *("plane", "stiffness", "omega", "petsc_options", "time_limit", "threads"),
)


def _call(verb: Any, arguments: argparse.Namespace, *names: str) -> Any:
    return verb(arguments.mesh, arguments.pde, **{name: getattr(arguments, name) for name in (*names, *_PROBLEM)})


def _finish(result: Any, arguments: argparse.Namespace, rows: list[dict[str, Any]]) -> None:
    from ._tables import csv_text

    print(result.summary)
    if getattr(arguments, "output", None):
        print("\n".join(tautline.write(result, arguments.output)))
    if arguments.csv:
        try:
            with open(arguments.csv, "w", encoding="utf-8", newline="") as out:
                out.write(csv_text(rows))
        except OSError as error:
            raise Error(f"{arguments.csv}: cannot be written: {error.strerror}") from None
        print(arguments.csv)


def _run_solve(arguments: argparse.Namespace) -> int:
    names = ("solver", "preconditioner", "relative_tolerance", "maximum_iterations", "restart")
    result = _call(solve, arguments, *names)
    rows = [dict(zip(result.history, values)) for values in zip(*result.history.values())]
    _finish(result, arguments, rows)
    return 0 if result.converged else 1


def _run_condition(arguments: argparse.Namespace) -> int:
    result = _call(condition, arguments, "preconditioner", "method", "tolerance")
    _finish(result, arguments, result.spectrum)
    return 0


def _run_study(arguments: argparse.Namespace) -> int:
    from ._tables import align

    result = _call(solver_study, arguments, "combinations", "restart", "repetitions")
    shown = ("number", "name", "result", "iterations", "condition", "reason")
    print(align([[row[key] for key in shown] for row in result.rows], shown), end="\n\n")
    _finish(result, arguments, result.rows)
    return 0 if result.recommended else 1
