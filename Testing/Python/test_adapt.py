# SPDX-License-Identifier: BSD-3-Clause
"""The function adapt and its command: functions and Solve PDE as solver, targets, the history, errors."""

import json

import numpy as np
import tautline as tl
from checks import OUT, rejected, run_tests, shell, square, wording

WIDTH = 0.05
LAYER = {"pde": "elliptic", "reaction": WIDTH**-2, "source": 0.0, "given": f"exp(-x/{WIDTH})",
         "exact": f"exp(-x/{WIDTH})"}  # fmt: skip


def front(mesh) -> np.ndarray:
    """A field that changes along a line only."""
    x, y = mesh.points[:, :2].T
    return np.tanh(20 * (x - 0.4 * y - 0.3))


def box(n: int):
    """The unit cube of 6 n^3 tetrahedra."""
    at = np.arange(n + 1) / n
    z, y, x = (each.ravel() for each in np.meshgrid(at, at, at, indexing="ij"))
    corner = (np.arange(n)[:, None, None] * (n + 1) ** 2 + np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    steps = (1, n + 1, (n + 1) ** 2)
    orders = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]
    cells = [[corner, corner + steps[a], corner + steps[a] + steps[b], corner + sum(steps)] for a, b, _ in orders]
    cells = [each if k < 3 else [each[0], each[2], each[1], each[3]] for k, each in enumerate(cells)]
    return tl.from_arrays(np.column_stack([x, y, z]), {"tetrahedron": np.concatenate([np.stack(c, 1) for c in cells])})


def longest_over_shortest(mesh) -> float:
    """The mean quotient of the extents of the triangles along x and along y."""
    corners = mesh.points[mesh.cells["triangle"]]
    sides = np.ptp(corners, axis=1)
    return float(np.mean(sides[:, 1] / sides[:, 0]))


def test_function():
    """A field from the coordinates: the interpolation error falls, the number of elements is near the target."""
    mesh = square(10)
    result = tl.adapt(mesh, front, 4, elements=1500)
    assert result.field == "Solution" and result.reason == wording("all-iterations-were-made")
    assert np.array_equal(result.solution, front(result.mesh)) and result.solution.shape == (len(result.points),)
    history, rows = result.history, result.table()
    assert len(rows) == 5 and list(history["iteration"]) == [0, 1, 2, 3, 4]
    assert history["elements"][0] == 200 and np.isnan(history["target"][0]) and (history["target"][1:] == 1500).all()
    assert (abs(history["elements"][2:] / 1500 - 1) < 0.25).all(), history["elements"]
    assert history["elements"][-1] == result.elements == len(result.cells["triangle"])
    assert history["points"][-1] == len(result.points)
    assert np.isnan(history["solution_error"]).all() and (history["seconds"] >= 0).all()
    assert history["edges_in_range"][-1] > 0.9 and 1 <= history["worst_in_metric"][-1] < 3, history
    assert result.estimated_error == history["estimated_error"][-1]
    uniform = tl.adapt(square(27), front, 1, elements=1458)  # row 0: a mesh of as many equal triangles
    assert result.estimated_error < uniform.history["estimated_error"][0] / 3
    # The names of arrays on the way are not left over, and the input has no arrays.
    assert list(result.point_data) == ["Solution"] and not list(result.cell_data) and not list(mesh.point_data)
    size = tl.quality(result, ["size"])
    assert abs(size.values["size"].sum() - 1) < 1e-9 and size.inverted == 0
    again = tl.adapt(mesh, front, 4, elements=1500, threads=1)
    assert again == result
    isotropic = tl.adapt(mesh, front, 4, elements=1500, anisotropic=False)
    assert isotropic.estimated_error > 1.5 * result.estimated_error
    assert tl.quality(isotropic).statistics["imr"]["mean"] < 1.3 < tl.quality(result).statistics["imr"]["mean"]


def test_estimate():
    """The estimated error of a field is about the true error of its interpolation."""
    for mesh in (square(12), box(6)):
        values = (mesh.points[:, :2] ** 2).sum(axis=1)
        found = tl.adapt(mesh, lambda given: (given.points[:, :2] ** 2).sum(axis=1), 1, error=1.0).history
        cells = next(iter(mesh.cells.values()))
        weights = np.random.default_rng(1).dirichlet(np.ones(cells.shape[1]), 400)
        corners, at = mesh.points[cells], values[cells]
        inner = np.einsum("sk,mkx->msx", weights, corners)
        error = (inner[..., :2] ** 2).sum(axis=-1) - np.einsum("sk,mk->ms", weights, at)
        true = np.sqrt((error**2).mean())  # all elements have the same size
        assert 0.8 < found["estimated_error"][0] / true < 1.1, (found["estimated_error"][0], true)


def test_targets():
    mesh = square(8)
    grown = tl.adapt(mesh, front, 3, elements=400, growth=1.5)
    assert np.allclose(grown.history["target"][1:], [400, 600, 900])
    listed = tl.adapt(mesh, front, 3, elements=[400, 600, 900])
    assert listed == grown
    assert tl.adapt(mesh, front, 1).history["target"][1] == 128
    first, second = (tl.adapt(mesh, front, 3, error=error) for error in (1e-3, 2.5e-4))
    assert np.isnan(first.history["target"]).all() and 1.4 < second.elements / first.elements < 5
    assert 0.3e-3 < first.estimated_error < 1.2e-3 and 0.3 < second.estimated_error / 2.5e-4 < 1.2


def test_meshes():
    """A solver that returns a mesh, a result, another mesh or a vector; regions and the boundary."""
    mesh = square(8)

    def named(given):
        given.point_data["u"] = front(given)
        given.point_data["other"] = given.points[:, 0]
        return given

    assert tl.adapt(mesh, named, 2, field="u", elements=300).field == "u"
    assert "u" not in mesh.point_data
    rejected(wording("several-new-point-arrays"), tl.adapt, mesh, named)
    vector = tl.adapt(mesh, lambda given: np.column_stack([front(given), given.points[:, 1] ** 2]), 2, elements=300)
    assert vector.solution.shape == (len(vector.points), 2)
    fixed = tl.adapt(mesh, front, 2, elements=600, boundary="fixed")
    slid = tl.adapt(mesh, front, 2, elements=600)
    sides = [sum((each.points[:, axis] == end).sum() for axis in (0, 1) for end in (0, 1)) for each in (fixed, slid)]
    assert sides[0] == 36 and sides[1] > 50, sides
    mesh.cell_data["material"] = (mesh.points[mesh.cells["triangle"]].mean(axis=1)[:, 0] > 0.5).astype(int)
    parts = tl.adapt(mesh, front, 2, elements=600, regions="material")
    some = tl.adapt(mesh, front, 2, elements=600, changing_cells="material")
    assert np.count_nonzero(some.cell_data["material"] == 0) == 64 < some.elements / 3
    corners = parts.points[parts.cells["triangle"]][:, :, 0]
    right = parts.cell_data["material"] == 1
    assert corners[right].min() >= 0.5 - 1e-12 and corners[~right].max() <= 0.5 + 1e-12


def test_tetrahedra():
    mesh = box(5)
    result = tl.adapt(mesh, lambda given: np.tanh(10 * (given.points[:, 0] - 0.4)), 3, elements=3000)
    assert abs(result.elements / 3000 - 1) < 0.35, result.history["elements"]
    assert result.estimated_error < result.history["estimated_error"][0] / 2
    assert result.history["edges_in_range"][-1] > 0.8 and 1 <= result.history["worst_in_metric"][-1] < 5
    assert np.isnan(result.history["edges_in_range"][0])
    assert abs(tl.quality(result, ["size"]).values["size"].sum() - 1) < 1e-9


def test_solve():
    """Solve PDE with a known solution, a boundary layer: the errors fall."""
    mesh = square(10)
    result = tl.adapt(mesh, LAYER, 3, elements=1200)
    history = result.history
    assert result.field == "Solution" and "Gradient" in result.cell_data
    assert history["solution_error"][-1] < history["solution_error"][0] / 10, history["solution_error"]
    assert history["gradient_error"][-1] < history["gradient_error"][0] / 3, history["gradient_error"]
    uniform = tl.solve(square(24), **LAYER)
    assert history["solution_error"][-1] < uniform.solution_error / 4
    assert longest_over_shortest(result) > 4
    assert wording("error-of-the-solution-in-l2") in result.summary
    # A function that calls solve() is the same.
    assert tl.adapt(mesh, lambda given: tl.solve(given, **LAYER), 3, elements=1200) == result
    beam = {"pde": "elasticity", "source": (0, -1), "fixed": "x < 0.001"}
    assert tl.adapt(mesh, beam, 1, elements=300).field == "Displacement"


def test_errors():
    mesh = square(4)
    rejected(wording("iterations-is-0"), tl.adapt, mesh, front, 0)
    rejected(wording("the-solver-returned-nothing"), tl.adapt, mesh, lambda given: None)
    rejected(wording("has-no-new-point-array"), tl.adapt, mesh, lambda given: given)
    rejected(wording("returned-has-no-point-array-u"), tl.adapt, mesh, lambda given: square(3), field="u")
    rejected(wording("the-solver-returned-no-mesh"), tl.adapt, mesh, lambda given: 7)
    rejected(wording("the-solver-returned-an-array"), tl.adapt, mesh, lambda given: np.zeros(3))
    rejected(wording("25-values-of-the-field-are-nan"), tl.adapt, mesh, lambda given: np.full(25, np.nan))
    rejected(wording("a-function-of-a-mesh-or"), tl.adapt, mesh, 7)
    rejected(wording("give-either-error-or-elements"), tl.adapt, mesh, front, elements=10, error=0.1)
    rejected(wording("elements-are-2-numbers"), tl.adapt, mesh, front, 3, elements=[10, 20])
    rejected(wording("growth-is-for-one-number"), tl.adapt, mesh, front, 2, elements=[10, 20], growth=2)
    rejected(wording("regions-give-the-name"), tl.adapt, mesh, front, regions=np.zeros(32))
    rejected(wording("solve-did-not-converge"), tl.adapt, mesh, {"maximum_iterations": 1, "preconditioner": "none"})
    rejected(wording("the-target-takes-about"), tl.adapt, mesh, front, 1, elements=1e12)
    points = [(0, 0), (1, 0), (1, 1), (0, 1)]
    rejected(wording("neither-triangles-nor-tetrahedra"), tl.adapt, (points, {"quadrilateral": [[0, 1, 2, 3]]}), front)
    rejected("pdee", tl.adapt, mesh, {"pdee": "poisson"})
    state = {"calls": 0}

    def failing(given):
        state["calls"] += 1
        if state["calls"] == 2:
            raise ZeroDivisionError("mine")
        return front(given)

    try:
        tl.adapt(mesh, failing, elements=50)
    except ZeroDivisionError as error:
        assert str(error) == "mine" and state["calls"] == 2
    else:
        raise AssertionError("the error of the solver is lost")


def test_interrupts():
    """Ctrl-C in the solver ends the iterations, a time limit ends them with the solution so far."""
    mesh = square(6)

    def interrupted(given):
        raise KeyboardInterrupt

    try:
        tl.adapt(mesh, interrupted)
    except KeyboardInterrupt:
        pass
    else:
        raise AssertionError("there was no KeyboardInterrupt")
    limited = tl.adapt(mesh, front, 50, elements=500, time_limit=1e-9)
    assert limited.reason == wording("the-time-limit-was-reached") and len(limited.table()) == 1
    reported = []
    tl.adapt(mesh, front, 3, elements=3000, progress=lambda fraction, text: reported.append(fraction))
    assert all(0 <= fraction <= 1 for fraction in reported) and reported == sorted(reported), reported
    try:
        tl.adapt(mesh, LAYER, 3, elements=2000, progress=lambda *_: False)
    except tl.Aborted:
        pass
    else:
        raise AssertionError("the operation was not cancelled")


def test_shell():
    source, out, table = OUT / "adapt.vtu", OUT / "adapted.vtu", OUT / "adapted.csv"
    tl.write(square(8), source)
    options = ("--pde", "elliptic", "--reaction", "400", "--source", "0", "--given", "exp(-20*x)", "--exact",
               "exp(-20*x)", "--iterations", "2", "--elements", "400,800", "-o", out)  # fmt: skip
    text = shell("adapt", source, *options, "--csv", table)
    assert "estimated_error" in text and str(out) in text, text
    made = tl.adapt(source, {"pde": "elliptic", "reaction": 400.0, "source": 0.0, "given": "exp(-20*x)",
                             "exact": "exp(-20*x)"}, 2, elements=[400, 800])  # fmt: skip
    written = tl.read(out)
    assert np.array_equal(written.point_data["Solution"], made.solution)
    lines = table.read_text().splitlines()
    assert len(lines) == 4 and lines[0].startswith("iteration,target,elements")
    found = json.loads(shell("adapt", source, *options, "--no-anisotropic", "--json"))
    assert found["elements"] != made.elements and len(found["history"]["elements"]) == 3
    assert wording("iterations-is-0") in shell("adapt", source, "--iterations", "0", "-o", out, code=1)
    assert "--given" in shell("adapt", "--help") and "--omega" in shell("adapt", "--help-all")


run_tests(globals())
