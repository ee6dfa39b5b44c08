# SPDX-License-Identifier: BSD-3-Clause
"""The functions peridynamics and interaction_layer, their commands, and small runs of the studies."""

import math

import checks
import numpy as np
import tautline as tl
from checks import points, rejected, run_tests, shell, square, wording
from study_checks import Studies
from tautline._choices import PERIDYNAMICS_PRECONDITIONERS
from tautline.studies import _horizon, names, nonlocal_preconditioner, peridynamics_tables, state_based
from vtkmodules.util.numpy_support import vtk_to_numpy
from wrong_data import verdicts

OUT = checks.OUT / "peridynamics"
OUT.mkdir(parents=True, exist_ok=True)
REMEDY = "add it with Interaction Layer"  # of a mesh without an interaction layer


def test_functions():
    bare = square(10)
    mesh = tl.interaction_layer(bare, 0.2)
    assert mesh.GetNumberOfCells() > 300 and bare.GetNumberOfCells() == 200
    result = tl.peridynamics(mesh, 0.2, sparsity=30, solve=True)
    assert abs(result.condition / 9.2827 - 1) < 1e-3 and result.definite and result.converged
    assert result.rows == 81 and result.nonzeros == result.sparsity.sum() == 2361
    assert result.sparsity.shape == (30, 30) and (np.diag(result.sparsity) > 0).all()
    assert result.solution.shape == (mesh.GetNumberOfPoints(),) and result.solution.max() > 0.1
    neighbors = vtk_to_numpy(result.mesh.GetPointData().GetArray("Neighbors"))
    assert neighbors.sum() == 2361 - 81
    assert result.smallest_bound < 1e-8 * result.smallest and wording("condition-number-9-28") in result.summary
    assert tl.peridynamics(mesh, threads=1).condition == tl.peridynamics(mesh, threads=2).condition

    region = vtk_to_numpy(mesh.GetCellData().GetArray("Reference"))
    again = tl.peridynamics(mesh, region=np.where(region == 2, 7.0, 0.0), layer_value=7)
    assert again.condition == result.condition and again.mesh.GetCellData().GetArray("given region") is None
    x = vtk_to_numpy(mesh.GetPoints().GetData())[:, 0]
    linear = tl.peridynamics(mesh, solve=True, source=np.zeros(len(x)), given=x, spectrum=False)
    assert np.abs(linear.solution - x).max() < 1e-4 and math.isnan(linear.condition)
    vector = np.column_stack([x, 0 * x])
    moved = tl.peridynamics(mesh, p=3, model="elastic", solve=True, source=0 * vector, given=vector)
    assert moved.solution.shape == (len(x), 3) and np.abs(moved.solution[:, 0] - x).max() < 1e-4
    assert abs(tl.peridynamics(mesh, basis="constant").condition / 16.0772 - 1) < 1e-3
    kernels = {"constant": {}, "gaussian": {"width": 0.4}, "conical": {}, "table": {"values": [2, 1]}}
    for kernel, options in kernels.items():
        assert tl.peridynamics(mesh, kernel=kernel, **options).definite
    literal = tl.peridynamics(mesh, 0.2, 2.5, discretization="dissertation", rules="literal")
    assert literal.asymmetry < 1e-12 and not literal.condition < 100, "far from 12, or indefinite"

    rejected(REMEDY, tl.peridynamics, bare)
    rejected(wording("has-no-interaction-layer"), tl.peridynamics, mesh, region=None)
    rejected(wording("an-interaction-layer-of-width"), tl.peridynamics, mesh, 0.5)
    rejected(wording("to-below-4"), tl.peridynamics, mesh, p=4)
    rejected(wording("to-below-3"), tl.peridynamics, mesh, p=3, basis="constant")
    rejected(wording("basis-is-quadratic"), tl.peridynamics, mesh, basis="quadratic")
    rejected(wording("no-array-absent"), tl.peridynamics, mesh, region="absent")
    rejected("above 0", tl.interaction_layer, bare, 0)
    assert tl.peridynamics(mesh, 0.5, allow_thin_layer=True).layer_deficit > 0.2


def test_preconditioners():
    """The same solution with each; the condition number from the iterations matches the spectrum."""
    mesh = tl.interaction_layer(square(20), 0.2)
    found = {name: tl.peridynamics(mesh, 0.2, 2.5, solve=True, preconditioner=name)
             for name in PERIDYNAMICS_PRECONDITIONERS}  # fmt: skip
    expected = found["jacobi"]
    for name, result in found.items():
        assert np.abs(result.solution - expected.solution).max() < 1e-8 * expected.solution.max(), name
        assert result.residual <= 1e-10 and f"in {result.iterations} iterations" in result.summary, name
        assert name == "jacobi" or result.iterations < 0.8 * expected.iterations, name
        assert name == "jacobi" or result.preconditioned_condition < 0.5 * expected.preconditioned_condition, name
    none = tl.peridynamics(mesh, spectrum=False)
    assert none.iterations == 0 and math.isnan(none.preconditioned_condition)
    rejected(wording("preconditioner-is-ilu"), tl.peridynamics, mesh, solve=True, preconditioner="ilu")
    for name in ("local amg", "two-level"):
        rejected(wording("choose-jacobi"), tl.peridynamics, mesh, solve=True, preconditioner=name, constrained=False)


def test_state_based():
    """Patch test through the function; the bond-based model at its Poisson's ratio; rejections."""
    mesh = tl.interaction_layer(square(10), 0.4)
    at = vtk_to_numpy(mesh.GetPoints().GetData())
    moved = np.column_stack([0.3 * at[:, 0] + 0.1 * at[:, 1], 0.5 * at[:, 1], 0 * at[:, 0]])
    options = {"solve": True, "source": 0 * moved, "given": moved, "tolerance": 1e-4}
    mu = np.pi / (8 * (6 - 1))  # of the kernel 1 / r
    inside = vtk_to_numpy(mesh.GetCellData().GetArray("Reference")) != 2
    for ratio, plane in ((0.4, "strain"), (0.0, "strain"), (0.4, "stress")):
        result = tl.peridynamics(mesh, model="state-based", poisson_ratio=ratio, plane=plane, **options)
        lame = mu * (2 * ratio / (1 - 2 * ratio) if plane == "strain" else 2 * ratio / (1 - ratio))
        energy = lame / 2 * 0.8**2 + mu * (0.3**2 + 0.5**2 + 2 * 0.05**2)
        assert np.abs(result.solution - moved).max() < 2e-3, (ratio, plane)
        assert np.abs(result.dilatation[inside] - 0.8).max() < 0.01 and not result.dilatation[~inside].any()
        assert np.abs(result.energy_density[inside] / energy - 1).max() < 0.02, (ratio, plane)
    bonds = tl.peridynamics(mesh, model="elastic", **options)
    assert abs(tl.peridynamics(mesh, model="state-based").condition / bonds.condition - 1) < 1e-3
    assert tl.peridynamics(mesh, model="state-based", poisson_ratio=0.49).condition > 3 * bonds.condition
    assert bonds.dilatation is not None and tl.peridynamics(mesh, solve=True).dilatation is None
    rejected(wording("twice-the-horizon"), tl.peridynamics, tl.interaction_layer(square(10), 0.2), model="state-based")
    rejected("below 0.5", tl.peridynamics, mesh, model="state-based", poisson_ratio=0.5)
    rejected(wording("take-the-exact"), tl.peridynamics, mesh, model="state-based", discretization="dissertation")
    rejected(wording("plane-is-both"), tl.peridynamics, mesh, plane="both")


def test_cut_bonds():
    """Two squares that a gap narrower than the horizon separates interact only where bonds are not cut."""
    left, right = square(4), square(4)
    at = vtk_to_numpy(left.GetPoints().GetData())
    cells = left.GetCells().GetConnectivityArray()
    triangles = vtk_to_numpy(cells).reshape(-1, 3)
    both = np.vstack([at, at + [1.1, 0, 0]]), {"triangle": np.vstack([triangles, triangles + len(at)])}
    mesh = tl.from_arrays(*both)
    options = {"constrained": False, "region": None, "tolerance": 1e-3, "spectrum": False}
    cut = tl.peridynamics(mesh, 0.3, **options)
    whole = tl.peridynamics(mesh, 0.3, cut_bonds=False, **options)
    single = tl.peridynamics(right, 0.3, **options)
    assert cut.nonzeros == 2 * single.nonzeros < whole.nonzeros, (cut.nonzeros, single.nonzeros, whole.nonzeros)


def test_state_based_study():
    """Numbers of the study, and wrong ones that change its verdicts."""
    studies = Studies(OUT / "studies")
    studies.run("state_based", "--threads", "1")
    studies.check("state_based", 16, ("state_based",), {"ratios": 7, "sizes": 3, "deltas": 3, "plate": 2, "slot": 1})
    rows = {row["model"]: row for row in studies.rows("state_based", "ratios")}
    assert abs(float(rows["nu = 0.25"]["condition"]) / float(rows["bond-based"]["condition"]) - 1) < 1e-4
    plate = {row["model"]: [float(v) for name, v in row.items() if name != "model"]
             for row in studies.rows("state_based", "plate")}  # fmt: skip
    assert plate["state-based"][-1] < plate["state-based"][0], plate
    points = np.array([[2.0, 0, 0], [0, 3.0, 0], [1.5, 1.5, 0]])
    # The displacement of Kirsch's plate far away is a uniform tension's.
    far = state_based.kirsch(1e6 * points, 0.3) / 1e6
    assert np.abs(far - points * [2 * 1.4, -2 * 0.6, 0]).max() < 1e-5, far


def test_commands():
    tl.write(square(10), OUT / "square.vtu")

    shell("interaction-layer", OUT / "square.vtu", "--width", 0.2, "-o", OUT / "layer.vtu")
    text = shell("peridynamics", OUT / "layer.vtu", "-p", 2.5, "--solve", "-o", OUT / "rows.vtu")
    assert wording("condition-number-12-13") in text, text
    assert tl.read(OUT / "rows.vtu").GetPointData().GetArray("Solution") is not None
    assert wording("condition-number-9-28") in shell("peridynamics", OUT / "square.vtu", "--add-layer")
    assert REMEDY in shell("peridynamics", OUT / "square.vtu", code=1)
    text = shell("peridynamics", OUT / "layer.vtu", "--solve", "--preconditioner", "two-level")
    assert wording("preconditioner-two-level") in text, text
    listed = shell("study", "list")
    assert all(name in listed for name in names()) and "peridynamics_tables" in names()
    text = shell("peridynamics", OUT / "square.vtu", "--add-layer", "--model", "state-based", "--poisson-ratio", 0.4,
                 "--plane", "stress", "--no-cut-bonds", "--tolerance", 1e-3)  # fmt: skip
    assert wording("condition-number") in text, text
    assert wording("there-is-no-study") in shell("study", "absent", code=2)


def printed(calls):
    """The calls on the tables with the printed numbers as ours and their ratios, and with ideal condition numbers."""
    made = []
    for function, arguments, named in calls:
        if function.__name__ in ("number_findings", "ratio_findings"):
            table, _, *ratios = arguments
            numbers = _horizon.TABLES[table]
            exact = [{(ar, n, d): numbers[ar, n, d] / numbers[ar, n // 2, d] for ar, n, d in given} for given in ratios]
            made.append((function, (table, cells_of(table), *exact), named))
    return made + ideal(calls)


def cells_of(table):
    """The printed numbers of a table as ours."""
    return {key: peridynamics_tables.Entry(v, v, v) for key, v in _horizon.TABLES[table].items()}


def ideal_cells(growth, stretch):
    """Entries 0.8 delta^-2 at 1/h = 10, with factors of a refinement, larger for smaller delta, and of anisotropy."""
    return {(ar, n, d): peridynamics_tables.Entry(
        *[0.8 / d**2 * (growth + 0.01 / d) ** math.log2(n / 10) * stretch ** (ar > 1)] * 3)
        for ar, n, d in _horizon.TABLES["4.1"]}  # fmt: skip


def ideal(calls):
    """The calls on trends with condition numbers c delta^-2, and ones that double under refinement."""
    made = {"integrable_findings": (ideal_cells(1.0, 1.0), ideal_cells(1.0, 1.02)),
            "singular_findings": (ideal_cells(2.0, 1.3),)}
    return [(function, made[function.__name__], named) for function, _, named in calls if function.__name__ in made]


def stated(calls):
    """The calls on the horizon, the element size and the aspect ratio with numbers as the dissertation states them."""
    ideal = {
        "horizon_findings": ({("constant", 1): -2.0, ("linear", 1): -1.95},
                             {("constant", 1): [25.0, 6.2], ("constant", 4): [25.5, 6.1], ("linear", 1): [20.0, 5.0],
                              ("linear", 4): [20.2, 5.1]}),
        "bound_findings": ({("linear", 10, 0.5): 0.5},),
        "limit_findings": ({0.2: 0.66, 0.1: 0.63},),
        "size_findings": ({("constant", 1.0, 0.2): [16.0, 17.0, 17.5], ("linear", 1.0, 0.2): [10.0, 13.0, 14.9],
                           ("linear", 2.5, 0.2): [10.0, 20.0, 40.0]},),
        "ratio_findings": ({40: {1: 10.0, 4: 14.0, 16: 14.1, 64: 14.0}},),
    }
    return [(function, ideal[function.__name__], named) for function, _, named in calls]


def test_preconditioner_study():
    """Small numbers of iterations; Jacobi's numbers instead of the new ones change the verdicts."""
    studies = Studies(OUT / "studies")
    study = nonlocal_preconditioner
    studies.run("nonlocal_preconditioner", "--threads", "1")
    calls = studies.calls["nonlocal_preconditioner"]
    studies.check("nonlocal_preconditioner", 21, ("nonlocal_preconditioner",),
                  {"tables": 36, "exponents": 8, "small_horizons": 4, "unstructured": 8, "seconds": 3})
    for row in studies.rows("nonlocal_preconditioner", "tables"):
        assert all(int(row[f"{name} iterations"]) < 30 for name in study.NEW), row
    grown = []  # iterations as with Jacobi in the local case: like 1/h
    for function, (rows, *_), named in calls:
        if function.__name__ == "horizon_findings":
            wrong = {key: {name: study.Found(2 * key[1], 9.0) for name in row} for key, row in rows.items()}
            grown.append((function, (wrong,), named))
    found = verdicts(grown, OUT / "grown")
    assert [v for (_, text), v in found.items() if "bounded" in text] == ["does not hold"] * 2, found
    assert [v for (_, text), v in found.items() if "Jacobi: with" in text] == ["holds"], found


def check_stated(calls):
    """The dissertation's statements hold with such numbers; growth with a power of 1 is not our h^-(p-2)."""
    found = verdicts(calls, OUT / "stated")
    not_ours = [v for (_, text), v in found.items() if "like h^-(p-2)" in text or "like AR^" in text]
    assert len(found) == 14 and not_ours == ["does not hold"] * 2, found
    assert list(found.values()).count("holds") == 12, found


def check_ideal(calls):
    """All trends hold with such numbers; their ratios decrease with delta without cut triangles."""
    found = verdicts(ideal(calls), OUT / "ideal")
    assert len(found) == 14, found
    for (_, text), verdict in found.items():
        assert verdict == ("does not hold" if text.startswith("It does because") else "holds"), (text, verdict)


def test_studies():
    studies = Studies(OUT / "studies")
    expected = {"peridynamics_tables": 34, "peridynamics_horizon": 14, "peridynamics_kernel": 2}

    def rows(name):
        studies.run(name, "--threads", "1")
        others = {"peridynamics_tables": printed, "peridynamics_horizon": stated}
        theirs = others[name](studies.calls[name]) if name in others else ()
        studies.check(name, expected[name], (name,) if name == "peridynamics_tables" else (), {}, theirs)
        if name == "peridynamics_horizon":
            check_stated(theirs)
        if name == "peridynamics_tables":
            check_ideal(studies.calls[name])
        return studies.rows(name, name)

    for row in rows("peridynamics_tables"):
        key = int(row["aspect_ratio"]), int(row["n"]), float(row["delta"])
        assert float(row["printed"]) == _horizon.TABLES[row["table"]][key]
        if row["table"] == "4.3":
            assert abs(float(row["a"]) / float(row["printed"]) - 1) < 0.005, row
    found = {(r["n"], r["aspect_ratio"], r["delta"], r["basis"], r["p"], r["discretization"]): float(r["condition"])
             for r in rows("peridynamics_horizon")}  # fmt: skip
    assert abs(found["20", "1", "0.2", "linear", "2.5", "exact"] / 21.3645 - 1) < 2e-3
    exact = [r for r in rows("peridynamics_kernel") if r["discretization"] == "exact" and r["delta"] == "0.2"]
    kernel = [float(r["condition"]) for r in exact]
    assert kernel == sorted(kernel), "cond grows with p"


run_tests(globals())
