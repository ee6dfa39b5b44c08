# SPDX-License-Identifier: BSD-3-Clause
"""The studies of linear solvers and condition numbers in the small size: their files and numbers."""

import math

import numpy as np
import tautline as tl
from checks import OUT
from study_checks import Studies
from tautline.studies import _solver_tables, _solvers, _verdicts, smoothing_times, solution_error, solver_orders
from tautline.studies import solver_perturbation
from wrong_data import verdicts

studies = Studies(OUT / "studies_elliptic")
# Per study: its options, findings, pictures, and rows of its tables.
STUDIES = {
    "solver_metrics": (["--domain", "wrench"], 31, ("poisson_wrench", "elasticity_wrench"),
                       {"poisson_wrench_iterations": 4, "elliptic_wrench_seconds": 4, "total_poisson_wrench": 4}),
    "solver_perturbation": (["--domain", "wrench"], 8, ("pi_poisson_wrench",),
                            {"poisson_wrench_iterations": 5, "pi_poisson_wrench": 16}),
    "solver_restart": ([], 2, ("figure_2_3",), {"iterations": 5, "seconds": 5}),
    "solver_orders": (["--pde", "poisson"], 7, ("figure_2_5", "figure_2_6"),
                      {"poisson_wrench": 16, "poisson_orders_iterations": 16, "eigenvalues_wrench": 4}),
    "time_stepping": ([], 12, (), {"orders": 4, "seconds": 8}),
    "solution_error": ([], 33, (), {"orders_smooth": 2, "metrics_corner": 5, "solvers_smooth": 14}),
    "solver_coefficients": ([], 8, (), {"wrench_0": 16, "wrench_5": 16}),
    "mesh_independence": (["--domain", "wrench"], 4, (), {"angles_wrench": 3, "poisson_wrench_size": 1}),
    "conditioning": ([], 9, (), {"table_3_8": 5, "table_3_9": 6, "table_3_10": 6}),
}


LEAST = 1e-3  # seconds
#: What the dissertation states and its printed numbers show.
CLAIMED = (
    "AMG with any solver is faster than everything else", "Jacobi with GMRES is the slowest",
    "s is below 0.1 with AMG", "s is near 0.5 with the other combinations (within 0.15)",
    "SI alone leaves inverted elements: no valid solution",
    "SI alone and the objective product leave inverted elements: no valid solution",
    "Size alone has the largest condition number", "The exponential sum has the smallest condition number",
    "The same combinations fail as in the dissertation",
    "CG and MINRES fail on perturbed meshes where GMRES and Bi-CGSTAB do not",
    "The solver time of the best combination is 97% less than that of the worst one",
    "The solver time of the best combination is 95% less than that of the worst one",
    "The solver time of the best combination is 92% less than that of the worst one",
    "The total time of AMG + CG with IMR is 90% less than with SS",
    "The total time of Jacobi + GMRES with IMR is 45% less than with SS",
    "The total time of ILU(0) + MINRES with IMR is 71% less than with SS",
    "The total time of Jacobi + GMRES with IMR is 16% less than with SS",
)


def run_all():
    for study, (options, *expected) in STUDIES.items():
        printed = studies.run(study, *options)
        assert (studies.directory / study / f"{study}.txt").read_text(encoding="utf-8") in printed
        theirs = OTHERS[study](studies.calls[study]) if study in OTHERS else ()
        studies.check(study, *expected, theirs)
        found = verdicts(theirs, studies.directory / "dissertation")
        for (source, sentence), verdict in found.items():
            if sentence in CLAIMED:
                assert verdict == "holds", f"{study}, {source}: by the dissertation's numbers {sentence}: {verdict}"


def dissertation(calls):
    """The calls with the dissertation's numbers; a multigrid that it does not have is given the least time."""
    made = []
    for function, (pde, domain, rows, *rest), named in calls:
        if function.__name__ not in ("findings", "total_findings", "sensitivity_findings"):
            continue
        known, more = rest[0] if rest else None, rest[1:]
        tables = _solver_tables.BY_METRIC if "imr" in rows else _solver_tables.BY_PERTURBATION
        theirs = tables.get((pde, domain))
        if theirs is None:
            continue  # no table of Figure 2.7
        printed = {}
        for key, row in rows.items():
            seconds, iterations = theirs.get(key, theirs[min(theirs)])
            printed[key] = {n: solved(n, seconds[n - 1], iterations[n - 1]) if n in _solver_tables.COMBINATIONS
                            else solved(n, LEAST, 1) for n in row}
        if function.__name__ == "total_findings":
            smooth = dict(zip(_solver_tables.METRICS, smoothing_times.TABLE_2_6[domain]))
            known = {metric: _verdicts.Times((float(seconds),)) for metric, seconds in smooth.items()}
        elif "imr" not in rows:
            known = solver_perturbation.increases(printed)
        made.append((function, (pde, domain, printed, *([known, *more] if rest else [])), named))
    return made


def stated(calls):
    """The calls on orders with those that the dissertation states: s of each group of combinations."""
    orders = {n: 0.05 if n in _solvers.AMG else 0.5 for n in _solver_tables.COMBINATIONS}
    orders[solver_orders.JACOBI_GMRES] = 0.8
    return [(function, (arguments[0], dict.fromkeys(arguments[1], orders)), named)
            for function, arguments, named in calls if function.__name__ == "findings"]


def alike(calls):
    """The calls on errors of the solution with the same error of all metrics."""
    return [(function, (name, dict.fromkeys(found, (1.0, 1.0))), named)
            for function, (name, found, *_), named in calls if function.__name__ == "metric_findings"]


def same(calls):
    """The calls on mesh independence with solutions and angles that are the same on all meshes."""
    made = []
    for function, (domain, found, shares), named in calls:
        equal = {pde: {what: dict.fromkeys(values, 1.0) for what, values in parts.items()}
                 for pde, parts in found.items()}
        made.append((function, (domain, equal, dict.fromkeys(shares, [20.0] * 5)), named))
    return made


def printed(calls):
    """The calls on Tables 3.8 to 3.10 with the dissertation's numbers; the start of the last one is not in it."""
    tables = {"brain_findings": _solver_tables.TABLE_3_8, "bore_findings": _solver_tables.TABLE_3_9,
              "disk_findings": _solver_tables.TABLE_3_10}
    made = []
    for function, (found,), named in calls:
        rows = {name: [math.nan if v is None else v for v in row] for name, row in tables[function.__name__].items()}
        made.append((function, ({**found, **rows},), named))
    return made


def solved(number, seconds, iterations):
    converged = seconds is not None and iterations is not None
    times = _verdicts.Times((seconds if converged else 1.0,))
    return _solvers.Solve(number, times, int(iterations or 0), converged, False, "")


OTHERS = {"solver_metrics": dissertation, "solver_perturbation": dissertation, "solver_orders": stated,
          "mesh_independence": same, "solution_error": alike,
          "conditioning": printed}


def test_tables():
    """The dissertation's numbers, against marginal facts its text states."""
    wrench = _solver_tables.BY_METRIC["poisson", "wrench"]["imr"]
    assert 1 - wrench[0][12] / wrench[0][1] > 0.97  # "97% faster"
    failures = sum(v is None for row in _solver_tables.BY_METRIC["poisson", "hinge"].values() for v in row[1])
    assert failures == 10
    for name, table in (("3.8", _solver_tables.TABLE_3_8), ("3.10", _solver_tables.TABLE_3_10)):
        for largest, smallest, condition, _ in table.values():
            assert largest is None or abs(largest / smallest / condition - 1) < 0.015, name


def test_metrics():
    """Iterations are those of solve() on the same mesh; those of multigrid are few."""
    row = {r["metric"]: r for r in studies.rows("solver_metrics", "poisson_wrench_iterations")}["imr"]
    assert all(row[f"{n} converged"] == "yes" for n in _solver_tables.COMBINATIONS)
    assert all(int(row[f"{n} iterations"]) <= 6 for n in _solvers.AMG)
    assert min(int(row[f"{n} iterations"]) for n in _solvers.JACOBI) > 30
    mesh = _solvers.smoothed(_solvers.initial_mesh("wrench", _solvers.SMALL), "imr", 1)
    solved = tl.solve(mesh, solver="cg", preconditioner="ssor", threads=1)
    assert solved.iterations == int(row["5 iterations"])
    elastic = {r["metric"]: r for r in studies.rows("solver_metrics", "elasticity_wrench_iterations")}["imr"]
    assert int(elastic["19 iterations"]) < int(elastic["9 iterations"])


def test_conditioning():
    """Where CG converged, eigenvalues and condition numbers belong together, and iterations to them."""
    for table in ("table_3_8", "table_3_9", "table_3_10"):
        for row in studies.rows("conditioning", table):
            largest, smallest, condition, iterations = (
                float(row[key] or "nan") for key in ("largest", "smallest", "condition", "iterations"))
            if math.isnan(largest):
                continue
            assert 0 < smallest < 1 < largest < 4, row
            assert abs(largest / smallest / condition - 1) < 1e-6, row
            assert iterations < 3 + 0.5 * math.sqrt(condition) * math.log(2 / 1e-7), row


def test_time_stepping():
    """Orders in time are those of the schemes; each combination solves all equations."""
    for row in studies.rows("time_stepping", "orders"):
        expected = 1 if row["scheme"] == "backward euler" else 2
        assert abs(float(row["order"]) - expected) < 0.1, row
        coarse, fine = float(row["20 steps"]), float(row["80 steps"])
        assert coarse / fine > (3.5 if expected == 1 else 14), row
    for row in studies.rows("time_stepping", "iterations"):
        if row["combination"] != "direct":
            assert float(row["heat, 100 steps"]) >= 100 and float(row["wave, 100 steps"]) >= 100, row


def test_solution_error():
    """Errors decrease by the orders of linear elements; the quadrature is exact for polynomials of degree 5."""
    for name, (_, h1) in (("smooth", (2, 1)), ("corner", (4 / 3, 2 / 3))):
        coarse, fine = studies.rows("solution_error", f"orders_{name}")
        assert abs(math.log2(float(coarse["H1"]) / float(fine["H1"])) - h1) < 0.15, name
        assert float(coarse["L2"]) / float(fine["L2"]) > 2, name
    assert abs(sum(weight for _, weight in solution_error.RULE) - 1) < 1e-14
    value = sum(weight * point[0] ** 3 * point[1] ** 2 for point, weight in solution_error.RULE)
    assert abs(value - 2 * 6 * 2 / math.factorial(7)) < 1e-14  # a! b! 2 / (a + b + 2)!
    for sentence in ("reduces", "CG with AMG"):
        assert any(sentence in row["finding"] for row in studies.rows("solution_error", "findings"))


def test_arguments():
    assert _solvers.vertices("500K") == 500_000 and _solvers.vertices("1234") == 1234
    sizes, values = np.array([10.0, 100.0, 1000.0]), np.array([2.0, 20.0, 200.0])
    assert abs(_solvers.order(sizes, values) - 1) < 1e-12
    for wrong in ("0", "x", "-5"):
        try:
            _solvers.vertices(wrong)
        except Exception as error:
            assert wrong in str(error)
        else:
            raise AssertionError(wrong)


if __name__ == "__main__":
    run_all()
    for test in (test_tables, test_metrics, test_conditioning, test_time_stepping, test_solution_error, test_arguments):
        test()
