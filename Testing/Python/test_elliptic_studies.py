# SPDX-License-Identifier: BSD-3-Clause
"""The studies of linear solvers and condition numbers in the small size: their files and numbers."""

import dataclasses
import math

import numpy as np
import tautline as tl
from checks import OUT
from study_checks import Studies
from tautline.studies import _meshes, _own_mesh, _solver_claims, _solver_tables, _solvers, _verdicts, smoothing_times
from tautline.studies import conditioning, solver_meshes, solver_orders, solver_perturbation
from wrong_data import verdicts

studies = Studies(OUT / "studies_elliptic")
# Per study: its options, findings, pictures, and rows of its tables.
STUDIES = {
    "solver_metrics": (["--domain", "wrench"], 46, ("poisson_wrench", "elasticity_wrench"),
                       {"poisson_wrench_iterations": 4, "elliptic_wrench_seconds": 4, "total_poisson_wrench": 4,
                        "poisson_eigenvalues_wrench": 4}),
    "solver_perturbation": ([], 20, ("pi_poisson_wrench",),
                            {"poisson_wrench_iterations": 5, "pi_poisson_wrench": 16, "failures_poisson_hinge": 4}),
    "solver_restart": ([], 9, ("figure_2_3",), {"iterations_poisson_wrench": 5, "seconds_elasticity_wrench": 5}),
    "solver_orders": ([], 27, ("figure_2_5", "figure_2_12"),
                      {"poisson_wrench": 16, "poisson_orders_iterations": 16, "eigenvalues_wrench": 4}),
    "solver_meshes": ([], 7, ("tetrahedra_poisson", "mixed_elasticity"),
                      {"meshes": 4, "hexahedra_elliptic_iterations": 3, "triangles_anisotropic_seconds": 5}),
    "time_stepping": ([], 12, (), {"orders": 4, "seconds": 8}),
    "solution_error": ([], 33, (), {"orders_smooth": 2, "metrics_corner": 5, "solvers_smooth": 14}),
    "solver_coefficients": ([], 11, (), {"wrench_0": 16, "wrench_5": 16, "wrench_8": 16}),
    "mesh_independence": (["--domain", "wrench"], 5, (),
                          {"angles_wrench": 3, "poisson_wrench_size": 1, "table_2_4": 3}),
    "conditioning": ([], 20, (), {"table_3_8": 5, "table_3_9": 6, "table_3_10": 6}),
}


LEAST = 1e-3  # seconds
#: Statements of the dissertation that its printed numbers show.
CLAIMED = (
    "AMG with any solver is faster than everything else", "Jacobi with GMRES is the slowest",
    "s is below 0.1 with AMG", "s is around 0.5 with the other combinations",
    "SI alone leaves inverted elements: no valid solution",
    "The objective product leaves inverted elements: no valid solution",
    "The condition numbers are about the printed ones", "Size alone shows the slowest convergence",
    "Exponential and equal sum have a smaller condition number than untangling alone",
    "The multiobjective methods need fewer iterations than simultaneous untangling and smoothing",
    "Exponential and equal sum outperform the other methods",
    "The exponential sum has a 19 % smaller condition number than untangling alone",
    "Size alone has the largest condition number", "The exponential sum has the smallest condition number",
    "The same combinations fail as in the dissertation",
    "CG and MINRES fail in many cases, GMRES and Bi-CGSTAB do not",
    "More combinations solve the problem on the wrench than on the hinge",
    "The preconditioner matters the most for the solver time", "The metric matters the most for the total time",
    "The solver time with the best combination is 97% less than with the worst one",
    "The solver time with the best combination is 95% less than with the worst one",
    "The solver time with the best combination is 92% less than with the worst one",
    "The total time of AMG + CG with IMR is 90% less than with SS",
    "The total time of Jacobi + GMRES with IMR is 45% less than with SS",
    "The total time of ILU(0) + MINRES with IMR is 71% less than with SS",
    "The total time of Jacobi + GMRES with IMR is 16% less than with SS",
)
#: Findings that failures decide.
COUNTED = ("fail", "robust", "More combinations", "converge with all")


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
    for function, arguments, named in calls:
        name, (pde, domain) = function.__name__, arguments[:2]
        if name == "domain_findings":
            found = {d: (rows := perturbed(pde, d, found[0]), solver_perturbation.increases(rows))
                     for d, found in domain.items()} if pde != "elliptic" else None
            made += [(function, (pde, found), named)] if found else []
        elif name in ("rigid_findings", "eigenvalue_findings"):
            continue
        elif name == "ranking_findings" or 0.0 in arguments[2]:
            if pde != "elliptic" and name == "findings":  # no table of Figure 2.7
                rows = perturbed(pde, domain, arguments[2])
                made.append((function, (pde, domain, rows, solver_perturbation.increases(rows)), named))
        else:
            rows = _solver_claims.printed_rows(pde, domain)
            for row in rows.values():
                row |= {n: solved(n, LEAST, 1) for n in _solvers.NEAR_NULL_SPACE if n in arguments[2]["imr"]}
            if name == "metric_findings":  # the printed numbers leave ties
                rows["rr"] = {number: solved(number, LEAST, 1) for number in rows["rr"]}
                rows["ss"] = {number: solved(number, 1 / LEAST, 10_000) for number in rows["ss"]}
            rest = list(arguments[3:])
            if name in ("total_findings", "factor_findings"):
                rest[0] = {metric: _verdicts.Times((float(seconds),)) for metric, seconds in
                           zip(_solver_tables.METRICS, smoothing_times.TABLE_2_6[domain])}
            made.append((function, (pde, domain, rows, *rest), named))
    return made


def perturbed(pde, domain, ours):
    """The printed solves of Tables 2.9 and 2.12; a fraction that is not printed has the numbers of 0."""
    theirs = _solver_tables.BY_PERTURBATION[pde, domain]
    return {f: {n: solved(n, *(part[n - 1] for part in theirs.get(f, theirs[0.0]))) for n in row}
            for f, row in ours.items()}


def changed(value, change):
    """A copy of data in which each solve is another one."""
    if isinstance(value, _solvers.Solve):
        return change(value)
    if isinstance(value, dict):
        return {key: changed(part, change) for key, part in value.items()}
    return tuple(changed(part, change) for part in value) if isinstance(value, tuple) else value


def others(calls, change):
    """The verdicts by claim, of solves that are changed; findings without solves do not count."""
    made = [(function, changed(arguments, change), named) for function, arguments, named in calls
            if function.__name__ not in ("eigenvalue_findings", "ranking_findings")]
    return {claim: verdict for (_, claim), verdict in verdicts(made, studies.directory / "others").items()}


def check_failures():
    """No finding but on failures rests on runs that failed or did not finish, or on those that are left."""
    for study in ("solver_metrics", "solver_restart", "solver_coefficients", "solver_meshes"):
        for left in ((), (2,), (13,)):
            for unfinished in (False, True):
                found = others(studies.calls[study], lambda s: s if s.number in left else dataclasses.replace(
                    s, converged=False, unfinished=unfinished, reason="it diverged"))
                wrong = {claim: v for claim, v in found.items() if v != _verdicts.NOT_DECIDED
                         and not any(word in claim for word in (*COUNTED, *(_solvers.LABELS[n] for n in left)))}
                assert not wrong, (study, left, unfinished, wrong)


def check_ties():
    """No combination and no metric is better than another one where all are the same."""
    for study in ("solver_metrics", "solver_restart", "solver_coefficients", "solver_meshes"):
        found = others(studies.calls[study], lambda s: solved(s.number, 1.0, 10))
        holding = {claim for claim, v in found.items() if v == _verdicts.HOLDS
                   and not any(word in claim for word in (*COUNTED, "kappa"))}
        assert not holding, (study, holding)


def stated(calls):
    """The calls on orders with those that the dissertation states: s of each group of combinations."""
    made = []
    for function, arguments, named in calls:
        if function.__name__ == "findings":
            multigrid = 0.4 if arguments[0] == "elasticity" else 0.05
            orders = {n: multigrid if n in _solvers.AMG else 0.5 for n in _solver_tables.COMBINATIONS}
            orders[solver_orders.JACOBI_GMRES] = 0.8
            made.append((function, (arguments[0], dict.fromkeys(arguments[1], orders)), named))
    return made


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
    for function, (found, *rest), named in calls:
        if function.__name__ not in tables:
            continue  # our own
        rows = {name: [math.nan if v is None else v for v in row] for name, row in tables[function.__name__].items()}
        counts = [{name: float(math.isnan(row[0])) for name, row in rows.items()}] if rest else []
        made.append((function, ({**found, **rows}, *counts), named))
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
    """Iterations equal the iterations of solve() on the same mesh; multigrid takes few."""
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
    # Eigenvalues of a matrix of this test's own, dense.
    for mesh in conditioning.flattened((1.0, 1e-3)):
        points, cells = _meshes.points_of(mesh), _meshes.cells_of(mesh)
        edges = points[cells[:, 1:]] - points[cells[:, :1]]
        slopes = np.linalg.inv(edges).transpose(0, 2, 1)
        slopes = np.concatenate([-slopes.sum(axis=1, keepdims=True), slopes], axis=1)
        matrix = np.zeros((len(points), len(points)))
        np.add.at(matrix, (cells[:, :, None], cells[:, None, :]),
                  np.einsum("eik,ejk,e->eij", slopes, slopes, np.linalg.det(edges) / 6))
        free = np.flatnonzero(np.array(mesh.GetPointData().GetArray("Fixed")) == 0)
        matrix = matrix[np.ix_(free, free)]
        scale = 1 / np.sqrt(np.diag(matrix))
        values = np.linalg.eigvalsh(matrix * scale[:, None] * scale)
        largest, smallest, *_ = conditioning.spectrum(mesh, 1)
        assert abs(largest / values[-1] - 1) < conditioning.EXPECTED_ERROR
        assert abs(smallest / values[0] - 1) < conditioning.EXPECTED_ERROR


def check_conditioning():
    """No valid solution, a survivor only and a tie decide nothing."""
    def holding(change):
        made = [(function, ({n: change(n, row) for n, row in found.items()}, *rest), named)
                for function, (found, *rest), named in studies.calls["conditioning"]
                if function.__name__ in ("brain_findings", "bore_findings", "disk_findings")]
        return {claim for (_, claim), v in verdicts(made, studies.directory / "others").items()
                if v == _verdicts.HOLDS and "leave" not in claim}

    assert not holding(lambda n, row: [math.nan] * 4), "no run is left"
    assert not holding(lambda n, row: row if n == "exponential-sum" else [math.nan] * 4), "one run is left"
    assert not holding(lambda n, row: [2.0, 0.5, 4.0, 10.0]), "all are the same"


def test_time_stepping():
    """Orders in time match the schemes; each combination solves all equations."""
    for row in studies.rows("time_stepping", "orders"):
        expected = 1 if row["scheme"] == "backward euler" else 2
        assert abs(float(row["order"]) - expected) < 0.1, row
        coarse, fine = float(row["20 steps"]), float(row["80 steps"])
        assert coarse / fine > (3.5 if expected == 1 else 14), row
    for row in studies.rows("time_stepping", "iterations"):
        if row["combination"] != "direct":
            assert float(row["heat, 100 steps"]) >= 100 and float(row["wave, 100 steps"]) >= 100, row


def test_solution_error():
    """Errors decrease by the orders of linear elements."""
    for name, (_, h1) in (("smooth", (2, 1)), ("corner", (4 / 3, 2 / 3))):
        coarse, fine = studies.rows("solution_error", f"orders_{name}")
        assert abs(math.log2(float(coarse["H1"]) / float(fine["H1"])) - h1) < 0.15, name
        assert float(coarse["L2"]) / float(fine["L2"]) > 2, name
    for sentence in ("reduces", "CG with AMG"):
        assert any(sentence in row["claim"] for row in studies.rows("solution_error", "findings"))


def test_own_mesh():
    """A mesh of the user's has tables, without the dissertation's numbers and findings."""
    points, blocks = solver_meshes.cube("mixed", [5, 4, 4])
    mesh = tl.perturb(tl.from_arrays(points, blocks), fraction=0.4).mesh
    assert _own_mesh.cell_types(mesh) == {"hexahedron", "wedge"}
    file = studies.directory / "mixed.vtu"
    tl.write(mesh, file)
    options = ("--mesh", str(file), "--metrics", "imr", "condition_number")
    studies.run("smoothing_times", *options)
    studies.run("solver_metrics", *options, "--pde", "elliptic", "--alpha", "100", "--fixed", "x < 0.1", "--format",
                "tex")
    for study in ("smoothing_times", "solver_metrics"):
        assert not studies.rows(study, "findings"), study
    assert [row["smoothed by"] for row in studies.rows("smoothing_times", "quality_mixed")] == [
        "before", "imr", "condition_number"]
    rows = {row["metric"]: row for row in studies.rows("solver_metrics", "elliptic_mixed_iterations")}
    assert list(rows) == ["as given", "imr", "condition_number"] and not any(
        value for row in rows.values() for key, value in row.items() if "dissertation" in key)
    exact = tl.solve(mesh, "elliptic", solver="cg", preconditioner="jacobi", alpha=100.0, reaction=100.0, source=1.0,
                     fixed="x < 0.1", threads=1)
    assert exact.iterations == int(rows["as given"]["1 iterations"])
    assert (studies.directory / "solver_metrics" / "total_elliptic_mixed.tex").is_file()


def test_meshes():
    """The cells of a cube fill it; every mesh is valid."""
    for name in solver_meshes.SOLIDS:
        points, blocks = solver_meshes.cube(name, [3, 2, 4])
        assert len(points) == 4 * 3 * 5
        mesh = tl.from_arrays(points, blocks)
        sizes = tl.quality(mesh, ["size"])
        assert sizes.inverted == 0 and abs(sizes.values["size"].sum() - 1) < 1e-12, name


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
    check_failures()
    check_ties()
    check_conditioning()
    for test in (test_tables, test_metrics, test_conditioning, test_time_stepping, test_solution_error, test_meshes,
                 test_own_mesh, test_arguments):
        test()
