# SPDX-License-Identifier: BSD-3-Clause
"""The functions solve, condition and solver_study, and their commands."""

import csv
import math
import time

import checks
import numpy as np
import tautline as tl
from checks import DATA, points, quadratic_square, rejected, run_tests, shell, square, wording
from vtkmodules.util.numpy_support import vtk_to_numpy

OUT = checks.OUT / "conditioning"
OUT.mkdir(parents=True, exist_ok=True)


def test_solve():
    mesh = square(12)
    x, y, _ = points(mesh).T
    result = tl.solve(mesh)
    assert abs(result.solution.max() - 0.0737) < 1e-3  # of -laplace u = 1 on the unit square
    assert result.converged and result.unknowns == 121 and result.gradient.shape == (288, 3)
    assert len(result.history["residual"]) == result.iterations + 1 and result.history["log10_residual"][0] == 0
    assert result.history["log10_residual"][-1] <= -5 and "BoomerAMG" in result.summary
    tight = {"relative_tolerance": 1e-12}
    exact = tl.solve(mesh, solver="direct").solution
    for solver in ("cg", "gmres", "minres", "bicgstab"):
        for preconditioner in ("jacobi", "ssor", "ilu", "amg", "icc", "gamg", "none"):
            found = tl.solve(mesh, "poisson", solver, preconditioner, **tight).solution
            assert np.abs(found - exact).max() < 1e-8, (solver, preconditioner)

    # One source given in every way; the given solution, and where.
    wanted = tl.solve(mesh, source="x*y", **tight).solution
    for source in (x * y, (x * y).tolist()):
        again = tl.solve(mesh, source=source, **tight)
        assert np.abs(again.solution - wanted).max() < 1e-14
        assert again.mesh.GetPointData().GetArray("given source") is None
    named = tl.solve(result.mesh, source="Solution", solution_name="next", gradient=False)
    assert named.mesh.GetPointData().GetArray("next") and named.gradient.size == 0
    assert np.abs(named.solution - tl.solve(mesh, source=result.solution).solution).max() < 1e-14
    linear = tl.solve(mesh, source=0, given="2*x - y", **tight)
    assert np.abs(linear.solution - (2 * x - y)).max() < 1e-9
    assert np.abs(linear.gradient - (2, -1, 0)).max() < 1e-8
    bar = tl.solve(mesh, fixed="x < 0.01", **tight).solution
    assert np.abs(bar - (x - x**2 / 2)).max() < 1e-2
    assert np.abs(tl.solve(mesh, fixed=x < 0.01, **tight).solution - bar).max() < 1e-14
    assert np.abs(tl.solve(mesh, fixed="x < 0.01", given=3.0, **tight).solution - 3 - bar).max() < 1e-9

    elliptic = tl.solve(mesh, "elliptic", alpha=2, beta=3, reaction=100, **tight).solution
    tensor = tl.solve(mesh, "elliptic", tensor=[(2, 3, 1, 0, 0, 0)] * 288, reaction=100, **tight).solution
    assert np.abs(elliptic - tensor).max() < 1e-14 and 0 < elliptic.max() < 0.01
    assert tl.solve(mesh, threads=1).solution.tolist() == tl.solve(mesh, threads=2).solution.tolist()


def test_elasticity():
    mesh = square(12)
    x, y, _ = points(mesh).T
    for plane, stress in (("strain", (1.2, 0.4, 0.4)), ("stress", (16 / 15, 4 / 15, 0))):
        result = tl.solve(mesh, "elasticity", source=0, given="x*iHat + 0*y*jHat", poisson_ratio=0.25, plane=plane,
                          relative_tolerance=1e-12)  # fmt: skip
        assert np.abs(result.solution - np.stack([x, 0 * x, 0 * x], 1)).max() < 1e-9
        assert np.abs(result.gradient - (*stress, 0, 0, 0)).max() < 1e-8, result.gradient[0]
    soft = tl.solve(mesh, "elasticity", source=(0, -1), preconditioner="gamg", fixed="x < 0.01", youngs_modulus=2)
    stiff = tl.solve(mesh, "elasticity", source=(0, -1), preconditioner="gamg", fixed="x < 0.01", stiffness=[2.0] * 288)
    assert np.abs(soft.solution - stiff.solution).max() < 1e-12 and soft.solution[:, 1].min() < -0.5
    assert vtk_to_numpy(soft.mesh.GetCellData().GetArray("VonMises")).max() > 1


def quadratic_system(xy, cells, source):
    """The matrix and the load of Poisson's equation on triangles of 6 nodes, by Gauss points of a collapsed square."""
    at, weights = np.polynomial.legendre.leggauss(6)
    at, weights = (1 + at) / 2, weights / 2
    matrix, load = np.zeros((len(xy), len(xy))), np.zeros(len(xy))
    for u, wu in zip(at, weights):
        for s, ws in zip(at, weights):
            r = u * (1 - s)
            q = 1 - r - s
            value = [q * (2 * q - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * q * r, 4 * r * s, 4 * s * q]
            by_r = [1 - 4 * q, 4 * r - 1, 0, 4 * (q - r), 4 * s, -4 * s]
            by_s = [1 - 4 * q, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (q - s)]
            slopes = np.array([by_r, by_s])
            jacobian = np.einsum("dk,ckx->cxd", slopes, xy[cells])
            size = wu * ws * (1 - s) * np.linalg.det(jacobian)
            gradient = np.einsum("dk,cdx->ckx", slopes, np.linalg.inv(jacobian))
            entries = np.einsum("c,ckx,clx->ckl", size, gradient, gradient)
            np.add.at(matrix, (cells[:, :, None], cells[:, None, :]), entries)
            here = np.einsum("k,ck->c", value, source[cells])
            np.add.at(load, cells, (size * here)[:, None] * value)
    return matrix, load


def test_quadratic():
    """Against an assembly by numpy; the order of convergence; the errors."""
    for bend, tolerance in ((0.0, 1e-10), (0.08, 2e-5)):
        mesh = quadratic_square(6, bend)
        xy = points(mesh)[:, :2]
        source = np.sin(3 * xy[:, 0]) + xy[:, 1] ** 2
        matrix, load = quadratic_system(xy, vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 6), source)
        steps = 13
        inside = np.zeros((steps, steps), bool)
        inside[1:-1, 1:-1] = True
        free = np.flatnonzero(inside.ravel())
        expected = np.zeros(len(xy))
        expected[free] = np.linalg.solve(matrix[np.ix_(free, free)], load[free])
        found = tl.solve(mesh, source=source, solver="direct")
        assert found.unknowns == len(free) == 121
        assert np.abs(found.solution - expected).max() < tolerance * expected.max(), bend
    wave, errors = "exp(x)*sin(2*y)", []
    for n in (6, 12):
        mesh = quadratic_square(n, 0.08)
        x, y, _ = points(mesh).T
        found = tl.solve(mesh, source=f"3*{wave}", given=wave, relative_tolerance=1e-11)
        errors.append(np.sqrt(np.mean((found.solution - np.exp(x) * np.sin(2 * y)) ** 2)))
    assert np.log2(errors[0] / errors[1]) > 2.8, errors
    mesh = quadratic_square(4, 0.05)
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 6).copy()
    cells[::3] = cells[::3, [0, 2, 1, 5, 4, 3]]  # in the opposite order
    turned = tl.solve(tl.from_arrays(points(mesh)[:, :2], {"triangle6": cells}), solver="direct")
    assert wording("as-if-listed-in-the-opposite-order") in turned.summary and "corners" not in turned.summary
    assert np.abs(turned.solution - tl.solve(mesh, solver="direct").solution).max() < 1e-12
    assert tl.condition(mesh).condition > 1
    assert tl.solver_study(mesh, combinations=[1, 13]).summary
    rejected(wording("choose-the-consistent-mass-matrix"), tl.solve, mesh, time_scheme="newmark", mass="lumped")
    folded = points(mesh).copy()
    folded[1] = folded[0] + 0.05 * (folded[2] - folded[0])  # the middle of an edge next to its end
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 6)
    curved = tl.from_arrays(folded[:, :2], {"triangle6": cells})
    rejected(wording("inverted-against-the-rest"), tl.solve, curved)


def test_exact():
    """Errors in closed form: of x^2, whose solution on right triangles is its interpolation; in space, on a slope."""
    n = 8
    flat = square(n)
    known = np.array([n**-2 / np.sqrt(30), 1 / (n * np.sqrt(3))])
    found = tl.solve(flat, source=-2.0, given="x^2", exact="x^2", solver="direct")
    errors = [found.solution_error, found.gradient_error]
    assert np.allclose(errors, known, rtol=1e-7), errors
    assert all(f"{error:.3g}"[:4] in found.summary for error in errors), found.summary
    s, t, _ = points(flat).T
    triangles = vtk_to_numpy(flat.GetCells().GetConnectivityArray()).reshape(-1, 3)
    slope = tl.from_arrays(np.column_stack([s, t, s]) / np.sqrt([2, 1, 2]), {"triangle": triangles})
    found = tl.solve(slope, source=-2.0, given="2*x^2", exact="2*x^2", solver="direct")
    assert np.allclose([found.solution_error, found.gradient_error], known, rtol=1e-7)  # the normal part does not count
    body = {"pde": "elasticity", "source": 0, "given": "x*iHat", "solver": "direct"}
    for mesh in (flat, DATA / "bracket.vtu"):
        found = tl.solve(mesh, exact="x*iHat + 0.5*jHat", **body)
        volume = np.abs(tl.quality(mesh, ["size"]).values["size"]).sum()
        assert abs(found.solution_error - 0.5 * np.sqrt(volume)) < 1e-9 and found.gradient_error < 1e-9
    assert np.isnan(tl.solve(flat).solution_error)
    rejected(wording("is-a-number-a-vector-is-expected"), tl.solve, flat, exact="x", **body)
    rejected(wording("is-not-understood"), tl.solve, flat, exact="q + 1")
    rejected(wording("is-not-finite-at-point"), tl.solve, flat, exact="sqrt(x - 0.5)")
    rejected(wording("an-exact-solution-can-be-compared"), tl.solve, flat, exact="x", time_scheme="bdf2")
    assert wording("errors-in-l2") in shell("solve", DATA / "plate.vtu", "--exact", "x*y")


def test_time_steps():
    """Heat and wave equations: eigenmodes in closed form, all solutions, histories, what is rejected."""
    n, steps, dt = 8, 5, 0.02
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    cells = np.stack([corner, corner + 1, corner + n + 2, corner, corner + n + 2, corner + n + 1], 1).reshape(-1, 3)
    mesh = tl.from_arrays(np.column_stack([x.ravel(), y.ravel()]), {"triangle": cells})
    mode = (np.sin(np.pi * x) * np.sin(np.pi * y)).ravel()
    value = 8 * n**2 * np.sin(np.pi / (2 * n)) ** 2  # of the lumped mass matrix
    common = dict(source=0.0, time_step=dt, time_steps=steps, mass="lumped", relative_tolerance=1e-10, series=True)
    z = value * dt
    factors = {"backward euler": 1 / (1 + z), "crank-nicolson": (1 - z / 2) / (1 + z / 2)}
    for scheme, factor in factors.items():
        for initial in ("sin(3.14159265358979*x)*sin(3.14159265358979*y)", mode):
            found = tl.solve(mesh, time_scheme=scheme, initial=initial, **common)
            assert found.converged and np.allclose(found.times, dt * np.arange(steps + 1))
            assert np.abs(found.series - np.outer(factor ** np.arange(steps + 1), mode)).max() < 1e-7, scheme
            assert np.array_equal(found.solution, found.series[-1])
            assert len(found.history["time"]) == steps and found.history["iterations"].sum() == found.iterations
    wave = tl.solve(mesh, time_scheme="newmark", velocity=mode, **common)
    frequency = 2 * np.arctan(np.sqrt(value) * dt / 2) / dt
    amplitude = np.sin(frequency * wave.times) / np.sqrt(value)
    assert np.abs(wave.series - np.outer(amplitude, mode)).max() < 1e-7
    still = tl.solve(mesh, relative_tolerance=1e-10)
    assert still.times is None and still.series is None
    late = tl.solve(mesh, time_scheme="bdf2", time_step=0.5, time_steps=10, relative_tolerance=1e-10)
    assert np.abs(late.solution - still.solution).max() < 1e-6 and late.series is None
    elastic = tl.solve(mesh, "elasticity", time_scheme="newmark", source=0, fixed="x < 0.01", initial="0.1*x*iHat",
                       time_steps=3, series=True)
    assert elastic.series.shape == (4, len(mode), 3) and abs(elastic.series[0, :, 0].max() - 0.1) < 1e-12
    short = tl.solve(mesh, time_scheme="backward euler", initial=mode**3, preconditioner="none", maximum_iterations=1,
                     relative_tolerance=1e-12, series=True)
    assert not short.converged and len(short.times) == len(short.series) == 1
    rejected("above 0", tl.solve, mesh, time_scheme="bdf2", time_step=0)
    rejected("density", tl.solve, mesh, time_scheme="bdf2", density=-1)
    rejected("time_scheme", tl.solve, mesh, time_scheme="rk4")
    rejected("time_steps", tl.solve, mesh, time_scheme="bdf2", time_steps=0)


def test_condition():
    mesh = square(12)
    result = tl.condition(mesh, preconditioner="jacobi")
    known = math.tan(math.pi / 24) ** -2  # of the five-point matrix
    assert abs(result.condition / known - 1) < 1e-6 and abs(result.preconditioned_condition / known - 1) < 1e-6
    assert [row["matrix"] for row in result.spectrum] == ["A", "P^-1 A (Jacobi)"]
    assert result.spectrum[0]["converged"] and 0 <= result.spectrum[0]["largest_error"] < 1e-5
    assert abs(result.share.sum() - 1) < 1e-9 and result.largest_eigenvalue.shape == (288,)
    ritz = tl.condition(mesh, preconditioner="none", method="ritz", shares=False)
    assert math.isnan(ritz.preconditioned_condition) and math.isnan(ritz.spectrum[0]["largest_error"])
    assert 0.9 * known < ritz.condition <= known * (1 + 1e-9) and ritz.share.size == 0
    assert tl.condition(mesh, "elasticity").preconditioned_condition < tl.condition(mesh, "elasticity").condition
    # A mesh with poor elements: few contribute most of the largest eigenvalue.
    plate = tl.condition(DATA / "plate.vtu")
    assert np.sort(plate.share)[-10:].sum() > 0.9 and wording("of-1913-elements-have-90") in plate.summary


def test_study():
    study = tl.solver_study(square(12))
    assert [row["number"] for row in study.rows] == list(range(1, 17)) and study.rows[9]["name"] == "GMRES + ILU(0)"
    best, second = sorted(study.rows, key=lambda row: row["seconds"])[:2]
    clear = second["seconds"] > best["seconds"] + max(0.1 * best["seconds"], 1e-3)
    assert study.recommended == (best["name"] if clear else "") and f"{best['name']}: " in study.why
    assert study.why.startswith(best["name"] if clear else "No clear recommendation: ")
    assert all(row["converged"] and row["result"].endswith(" s") and row["condition"] >= 1 for row in study.rows)
    few = tl.solver_study(square(12), "elasticity", [17, "CG + GAMG", 1], maximum_iterations=1)
    assert [row["number"] for row in few.rows] == [17, 19, 1]
    assert [row["result"] == "*" for row in few.rows] == [False, True, True] and math.isnan(few.rows[1]["seconds"])
    assert few.recommended == tl.solver_combinations()[17] and len(tl.solver_combinations()) == 25


def test_false_convergence():
    """An indefinite matrix: preconditioned residuals become small without a solution; that is no convergence."""
    study = tl.solver_study(DATA / "plate.vtu", "elliptic", range(1, 20), reaction=-100.0, maximum_iterations=500)
    assert study.recommended in ("direct solver", "") and wording("direct-solver") in study.why
    assert all(row["true_residual"] < 1e-2 for row in study.rows if row["converged"])
    failed = [row for row in study.rows if not row["converged"]]
    assert len(failed) > 3 and all(row["result"] == "*" and len(row["reason"]) > 10 for row in failed)


def test_rejections():
    mesh = square(12)
    rejected(wording("there-are-poisson-elliptic-elasticity"), tl.solve, mesh, "heat")
    rejected(wording("there-are-cg"), tl.solve, mesh, solver="lu")
    rejected(wording("undefined-symbol-q"), tl.solve, mesh, source="q")
    rejected(wording("of-elasticity-it-is-a-vector"), tl.solve, mesh, "elasticity", source=2.0)
    rejected(wording("source-has-the-shape-12-one-row"), tl.solve, mesh, source=np.ones(12))
    rejected(wording("without-a-fixed-point"), tl.solve, mesh, fixed="x > 5")
    rejected("-nonsense", tl.solve, mesh, petsc_options="-nonsense 1")
    rejected(wording("ksp-view-is-not-permitted"), tl.solve, mesh, petsc_options="-ksp_view ascii:written.txt")
    rejected(wording("options-file-is-not-permitted"), tl.solver_study, mesh, petsc_options="-options_file written.txt")
    rejected("-nonsense", tl.condition, mesh, petsc_options="-nonsense 1")
    rejected(wording("must-be-a-number-from"), tl.solve, mesh, time_limit=-1)
    rejected(wording("there-is-no-combination-99"), tl.solver_study, mesh, combinations=[99])
    tangled = DATA / "bracket-tangled.vtu"
    for function in (tl.solve, tl.condition, tl.solver_study):
        rejected("inverted", function, tangled)
    stopped = tl.solve(mesh, preconditioner="none", maximum_iterations=3)
    assert not stopped.converged and stopped.iterations == 3 and wording("limit-of-iterations") in stopped.reason


def test_keywords():
    """An unknown keyword: all of the function, and all of the problem, are listed."""
    problem = ("source", "fixed", "youngs_modulus", "petsc_options", "time_limit", "threads")
    own = {tl.solve: ("solver", "relative_tolerance", "restart", "gradient"), tl.condition: ("tolerance", "shares"),
           tl.solver_study: ("combinations", "relative_tolerance", "combination_time_limit")}  # fmt: skip
    for function, names in own.items():
        for name in (*problem, *names):
            rejected(f", {name}", function, square(3), nonsense=1)
    rejected(wording("did-you-mean-relative-tolerance"), tl.solve, square(3), relative_tolerence=1)


def test_time_limit():
    """A factorization of some seconds is given up at the limit; then other systems are solved."""
    n = 40
    corners = np.stack(np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    first = np.arange((n + 1) ** 3).reshape([n + 1] * 3)[:-1, :-1, :-1].ravel()[:, None]
    steps = [0, (n + 1) ** 2, (n + 1) ** 2 + n + 1, n + 1]
    cube = tl.from_arrays(corners / n, {"hexahedron": first + np.array([*steps, *[s + 1 for s in steps]])})
    for limit in (0.2, 0.4, 0.8, 1.6):  # the assembly alone may take as long on a busy machine: that is an error
        begin = time.monotonic()
        try:
            result = tl.solve(cube, solver="direct", time_limit=limit)
            break
        except tl.Error as error:
            assert f"The time limit of {limit} s is reached" in str(error), error
    assert time.monotonic() - begin < 10
    assert not result.converged and wording("time-limit") in result.reason and "factorization" in result.summary
    assert abs(tl.solve(square(12)).solution.max() - 0.0737) < 1e-3


def test_commands():
    plate = DATA / "plate.vtu"
    out = shell("solve", plate, "--source", "x*y", "--fixed", "x < 0", "-o", OUT / "s.vtu", "--csv", OUT / "s.csv")
    assert "Converged" in out and tl.read(OUT / "s.vtu").GetPointData().GetArray("Solution")
    with open(OUT / "s.csv", encoding="utf-8") as rows:
        assert [float(row["log10_residual"]) for row in csv.DictReader(rows)][0] == 0
    elastic = ("--pde", "elasticity", "--source", "0,-1", "--plane", "stress")
    out = shell("solve", plate, *elastic, "--iterations", 1, code=1)
    assert wording("limit-of-iterations") in out
    out = shell("condition", plate, "--preconditioner", "ilu", "-o", OUT / "c.vtu", "--csv", OUT / "c.csv")
    assert "P^-1 A (ILU(0))" in out and tl.read(OUT / "c.vtu").GetCellData().GetArray("Share")
    out = shell("solver-study", plate, "--combinations", "1,13,17", "--csv", OUT / "t.csv")
    assert wording("cg-boomeramg") in out and ("Recommended: " in out or wording("no-clear-recommendation") in out)
    with open(OUT / "t.csv", encoding="utf-8") as rows:
        assert [row["number"] for row in csv.DictReader(rows)] == ["1", "13", "17"]
    assert "inverted" in shell("solve", DATA / "bracket-tangled.vtu", code=1)


run_tests(globals())
