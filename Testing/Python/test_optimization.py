# SPDX-License-Identifier: BSD-3-Clause
"""The functions optimize and untangle, and their commands."""

import csv

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell as run, wording
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_INT, vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkImageData, vtkMultiBlockDataSet, vtkUnstructuredGrid
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOGeometry import vtkSTLWriter

BRACKET, TANGLED, PLATE = DATA / "bracket.vtu", DATA / "bracket-tangled.vtu", DATA / "plate.vtu"


def test_optimize():
    mesh = tl.read(BRACKET)
    before = tl.quality(mesh).values["imr"]
    result = tl.optimize(mesh)
    after = tl.quality(result).values["imr"]
    facts = result.statistics["imr"]
    assert np.isclose(facts["mean_before"], before.mean()) and np.isclose(facts["mean_after"], after.mean())
    assert facts["worst_before"] == before.max() and facts["worst_after"] == after.max()
    assert facts["label"] == "Inverse mean ratio" and facts["inverted_after"] == 0 and "rms_after" in facts
    history = result.history
    assert np.isclose(history["objective"][0], (before**2).sum())
    assert np.isclose(history["objective"][-1], (after**2).sum())
    assert (history["iteration"] == np.arange(result.iterations + 1)).all()
    assert np.isclose(history["imr_mean"][-1], after.mean()) and np.isclose(history["imr_worst"][-1], after.max())
    assert (history["inverted"] == 0).all() and (np.diff(history["seconds"]) >= 0).all()
    assert {"moving", "gradient_norm"} < set(history)
    assert (after**2).sum() < 0.8 * (before**2).sum()
    assert result.inverted_before == result.inverted == 0 and (result.validity == 1).all()
    assert (result.displacement == points(result.mesh) - points(mesh)).all() and "Converged" in result.reason
    assert result.free == np.any(tl.perturb(mesh, percentage=100).displacement, axis=1).sum()
    one, two = (tl.optimize(mesh, threads=threads) for threads in (1, 2))
    assert (points(one.mesh) == points(two.mesh)).all()
    assert mesh.GetPointData().GetArray("Displacement") is None


def cube_surface(n):
    """The surface of the unit cube of n x n squares a side, each as two triangles."""
    ids, triangles = {}, []
    for axis, side, i, j in np.ndindex(3, 2, n, n):
        square = []
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))[:: 1 if side else -1]:
            place = np.roll((side * n, i + u, j + v), axis)
            square.append(ids.setdefault(tuple(int(x) for x in place), len(ids)))
        triangles += [square[:3], [square[0], *square[2:]]]
    return np.array(list(ids)) / n, np.array(triangles)


def test_features():
    places, cells = cube_surface(6)
    ends = ((places == 0) | (places == 1)).sum(axis=1)
    mesh = tl.optimize((places, cells), maximum_iterations=0).mesh

    def array(result, name):
        data = result.mesh.GetPointData().GetArray(name)
        return None if data is None else np.array([data.GetComponent(i, 0) for i in range(data.GetNumberOfTuples())])

    kept = tl.optimize(mesh, show_features=True, hold_worst=False)  # all triangles are alike
    now = points(kept.mesh)
    flush = (places == 0) | (places == 1)
    assert np.abs(now - places)[flush].max() < 1e-12 and wording("8-corners-12-curves-6-patches") in kept.summary
    assert (array(kept, "FeatureKind") == ends - 1).all() and kept.mesh.GetCellData().GetArray("PatchId") is not None
    assert (np.abs(now - places).max(axis=1)[ends == 2] > 1e-3).any() and (now == places)[ends == 3].all()
    assert array(tl.optimize(mesh), "FeatureKind") is None
    cut = tl.optimize(mesh, keep_features=False, hold_worst=False, surface_tolerance=0)
    # With the worst triangle held, none of them can change.
    held = tl.optimize(mesh)
    assert held.statistics["imr"]["worst_after"] <= held.statistics["imr"]["worst_before"] * (1 + 1e-9)
    assert np.abs(points(cut.mesh) - places)[flush].max() > 0.01
    # given kinds: all points that are not within a side are corners
    stay = tl.optimize(mesh, feature_kinds=np.where(ends > 1, 2, 0))
    assert (points(stay.mesh) == points(mesh))[ends > 1].all() and stay.free == (ends == 1).sum()
    # regions: the lower half of the cube
    low = np.array([places[c].mean(axis=0)[2] < 0.5 for c in cells])
    halves = tl.optimize(mesh, regions=low.astype(float))
    middle = places[:, 2] == 0.5
    assert np.abs(points(halves.mesh)[middle, 2] - 0.5).max() < 1e-12 and wording("20-curves-10") in halves.summary
    # another surface
    larger = (1.04 * cube_surface(9)[0] - 0.02, cube_surface(9)[1])
    placed = tl.optimize(mesh, geometry=larger)
    far = points(placed.mesh)[flush]
    assert np.allclose(np.minimum(np.abs(far + 0.02), np.abs(far - 1.02)), 0, atol=1e-12)
    assert wording("8-of-8-corners-and-12-of-12") in placed.summary and placed.surface_error < 1e-12
    for wrong, message in (
        ({"feature_kinds": [1.0]}, "shape"),
        ({"feature_kinds": np.full(len(places), 4)}, "must be 0 (patch)"),
        ({"regions": "none such"}, "none such"),
        ({"geometry": BRACKET}, "Extract Surface"),
        ({"geometry": larger, "keep_features": False}, "Keep Features"),
        ({"feature_angle": 200}, "feature_angle"),
    ):
        rejected(message, tl.optimize, mesh, **wrong)
    rejected(wording("planar-mesh"), tl.optimize, PLATE, geometry=larger, boundary="on surface")
    # the shell
    path, out, other = OUT / "cube.vtu", OUT / "cube-features.vtu", OUT / "cube-larger.vtu"
    tl.write(mesh, path)
    tl.write(tl.optimize(larger, maximum_iterations=0).mesh, other)
    run("optimize", path, "-o", out, "--show-features", "--feature-angle", "30", "--facets")
    assert (array(tl.optimize(tl.read(out), maximum_iterations=0), "FeatureKind") == ends - 1).all()
    run("optimize", out, "-o", OUT / "cube-again.vtu", "--feature-kinds", "FeatureKind", "--geometry", other)
    run("optimize", out, "-o", OUT / "cube-cut.vtu", "--no-features")


def test_regions_and_geometry_of_files():
    """Regions by the name of an array, and a Geometry in a file of STL, in Python and on the shell."""
    places, cells = cube_surface(6)
    mesh = tl.optimize((places, cells), maximum_iterations=0).mesh
    low = vtkIntArray()
    low.SetName("low")
    for triangle in cells:
        low.InsertNextValue(int(places[triangle].mean(axis=0)[2] < 0.5))
    mesh.GetCellData().AddArray(low)
    source, regions = OUT / "cube-regions.vtu", OUT / "cube-regions-kept.vtu"
    tl.write(mesh, source)
    expected = tl.optimize(source, regions="low", show_features=True, hold_worst=False)
    run("optimize", source, "-o", regions, "--regions", "low", "--show-features", "--no-hold-worst")
    written = tl.read(regions)
    assert (points(written) == points(expected.mesh)).all()
    middle = places[:, 2] == 0.5
    kinds = written.GetPointData().GetArray("FeatureKind")
    assert all(kinds.GetComponent(i, 0) > 0 for i in np.flatnonzero(middle)) and middle.any()
    patches = {written.GetCellData().GetArray("PatchId").GetComponent(i, 0) for i in range(len(cells))}
    assert len(patches) == 10, patches  # four sides of the cube are cut in half
    assert np.abs(points(written)[middle, 2] - 0.5).max() < 1e-12
    free = tl.optimize(source, show_features=True, hold_worst=False)
    assert np.abs(points(free.mesh)[middle, 2] - 0.5).max() > 1e-3

    # The points of an STL file are in single precision, three to a triangle.
    surface, sphere, stl = vtkSphereSource(), vtkSphereSource(), OUT / "sphere.stl"
    surface.SetThetaResolution(12)
    surface.SetPhiResolution(9)
    sphere.SetThetaResolution(60)
    sphere.SetPhiResolution(60)
    sphere.SetRadius(0.52)
    writer = vtkSTLWriter()
    writer.SetInputConnection(sphere.GetOutputPort())
    writer.SetFileName(str(stl))
    writer.SetFileTypeToBinary()
    assert writer.Write()
    surface.Update()
    ball = surface.GetOutput()
    radius = np.linalg.norm(points(ball), axis=1)
    assert np.abs(radius - 0.5).max() < 1e-6
    result = tl.optimize(ball, geometry=stl)
    radius = np.linalg.norm(points(result.mesh), axis=1)
    assert radius.min() > 0.519 and radius.max() < 0.5201, (radius.min(), radius.max())
    # The facets of the coarse mesh are chords: farthest from the sphere in their middle or at the midpoint of an edge.
    triangles = [[ball.GetCell(c).GetPointId(k) for k in range(3)] for c in range(ball.GetNumberOfCells())]
    corners = points(result.mesh)[triangles]
    middles = np.concatenate([corners.mean(axis=1), *(corners[:, [k, k - 1]].mean(axis=1) for k in range(3))])
    depth = (0.52 - np.linalg.norm(middles, axis=1)).max()
    assert 0.9 * depth < result.surface_error < 1.1 * depth, (depth, result.surface_error)
    before, after = (result.statistics["imr"][key] for key in ("mean_before", "mean_after"))
    assert after < 0.99 * before, (before, after)
    coarse, placed = OUT / "coarse-sphere.vtp", OUT / "placed-sphere.vtp"
    tl.write(ball, coarse)
    run("optimize", coarse, "-o", placed, "--geometry", stl)
    assert np.allclose(points(tl.read(placed)), points(result.mesh), rtol=0, atol=1e-6)


def test_objectives():
    result = tl.optimize(
        PLATE,
        ["imr", ("size", {"template": "sum of squares", "weight": 2})],
        scalarization="weighted sum",
        optimizer="l-bfgs",
        maximum_iterations=5,
    )
    assert list(result.statistics) == ["imr", "size"] and result.iterations <= 5
    history = result.history
    assert np.allclose(history["objective"], history["imr_objective"] + 2 * history["size_objective"])
    by_preset = tl.optimize(PLATE, preset="fast clean-up")
    assert by_preset.iterations < tl.optimize(PLATE).iterations and "reduction" in by_preset.reason
    # a reference is what the mesh goes back to
    moved = tl.perturb(PLATE, percentage=100, fraction=0.6)
    shape = ("mu_shape_size_orientation_nb", {"template": "sum"})
    back = tl.optimize(moved, [shape], reference=PLATE, relative_change=1e-12, optimizer="newton-cg")
    away, rest = (np.abs(points(m) - points(tl.read(PLATE))).max() for m in (moved.mesh, back.mesh))
    assert rest < 1e-3 * away, (away, rest)
    sized = tl.optimize(moved, ["mu_size"], size=tl.quality(PLATE, "size").values["size"])
    assert sized.statistics["mu_size"]["mean_after"] < 0.1 * sized.statistics["mu_size"]["mean_before"]
    assert sized.mesh.GetCellData().GetArray("given size") is None
    kept = tl.optimize(moved, preset="preserve shape", reference=PLATE)
    assert kept.statistics["imr"]["mean_after"] < 1.001


def _bent(n):
    """n x n quadrilaterals between two waves, inside pushed to and fro."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    push = 0.06 * np.sin(2 * np.pi * x) * np.sin(2 * np.pi * y)
    corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = [corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]]
    places = np.stack([x + push, y + push + 0.15 * np.sin(2 * np.pi * x)], axis=-1).reshape(-1, 2)
    return places, np.stack(quads, axis=-1).reshape(-1, 4)


def test_worst_metric():
    """The worst element never gets worse, by the metric chosen; of quadrilaterals it is the scaled Jacobian."""
    bent = _bent(24)
    before = tl.quality(bent, "scaled_jacobian").statistics["scaled_jacobian"]["minimum"]
    result = tl.optimize(bent, preset="worst element")
    after = tl.quality(result.mesh, "scaled_jacobian").statistics["scaled_jacobian"]["minimum"]
    shape = tl.optimize(bent, preset="best shape")
    best = tl.quality(shape.mesh, "scaled_jacobian").statistics["scaled_jacobian"]["minimum"]
    assert after > before > 0 and after >= best, (before, after, best)
    by_imr = tl.optimize(bent, preset="worst element", worst_metric="imr").statistics["imr"]
    assert by_imr["worst_after"] <= by_imr["worst_before"]
    solid = tl.optimize(BRACKET, preset="worst element").statistics["imr"]
    assert solid["worst_after"] <= tl.optimize(BRACKET).statistics["imr"]["worst_after"] <= solid["worst_before"]
    by_angle = tl.optimize(BRACKET, preset="worst element", worst_metric="min_angle")
    angle = by_angle.statistics["min_angle"]  # the chosen metric is also reported
    least = tl.quality(by_angle.mesh, "min_angle").statistics["min_angle"]["minimum"]
    assert angle["worst_before"] <= angle["worst_after"] == least, angle
    assert f"worst {angle['worst_before']:g} to {least:g}." in by_angle.summary.splitlines()[-1], by_angle.summary
    rejected(wording("no-metric-beauty"), tl.optimize, PLATE, worst_metric="beauty")


def test_ranges():
    """Numbers out of range are rejected with the range in words."""
    for option, value, allowed in (("power", 0, "above 0"), ("relaxation", 2.5, "from 1 to 1.99")):
        rejected(f"{option} is {value}; it must be a number {allowed}", tl.optimize, PLATE, ["imr"], **{option: value})
    rejected(wording("time-limit-is-1-it-must-be"), tl.optimize, PLATE, time_limit=-1)


def test_remaining_inverted():
    """The shell ends with 1 if elements remain inverted, as by a time limit."""
    run("optimize", TANGLED, "--time-limit", "1e-9", "-o", OUT / "tangled-still.vtu", code=1)
    assert tl.quality(OUT / "tangled-still.vtu").inverted > 0
    run("optimize", TANGLED, "-o", OUT / "tangled-no-more.vtu")


def test_integer_points():
    """Points of an integer type become double, not truncated."""
    mesh = tl.read(PLATE)
    places = points(mesh)
    whole = vtkPoints()
    whole.SetDataType(VTK_INT)
    for place in np.round(1000 * places / np.ptp(places)).astype(int):
        whole.InsertNextPoint(*place)
    mesh.SetPoints(whole)
    result = tl.optimize(mesh)
    assert result.mesh.GetPoints().GetDataType() == VTK_DOUBLE
    measured = tl.quality(result.mesh, "imr").statistics["imr"]
    assert np.isclose(measured["mean"], result.statistics["imr"]["mean_after"]), measured


def test_free_boundary():
    """Uniform size keeps the mean size although the boundary moves; options that would shrink the mesh are rejected."""
    moved = tl.perturb(PLATE, percentage=100, fraction=0.6).mesh
    sizes = tl.quality(moved, "size").values["size"]
    result = tl.optimize(moved, preset="uniform size", boundary="free")
    after = tl.quality(result.mesh, "size").values["size"]
    assert result.inverted == 0
    assert abs(after.mean() / sizes.mean() - 1) < 0.1 and after.std() < 0.5 * sizes.std(), (after.mean(), after.std())
    rejected("shrink", tl.optimize, moved, preset="low interpolation error", boundary="free")
    rejected("shrink", tl.optimize, moved, ["size"], boundary="free")


def test_best_known():
    """None is an unknown optimum; 0, the optimum of untangling, is a known one, which IMR cannot come close to."""
    estimated = tl.optimize(BRACKET, ["imr"], reduction=0.5)
    assert "reduction" in estimated.reason
    assert tl.optimize(BRACKET, ["imr"], reduction=0.5, best_known=None).iterations == estimated.iterations
    known = tl.optimize(BRACKET, ["imr"], reduction=0.5, best_known=0)
    assert "Converged" in known.reason and known.iterations > estimated.iterations
    rejected("best_known", tl.optimize, BRACKET, ["imr"], best_known="0")


def test_points_that_leave_the_surface():
    """The acute angle of a sheared square bounds the scaled Jacobian there, unless points leave the boundary."""
    side = 4
    corners, mesh = vtkPoints(), vtkUnstructuredGrid()
    corners.SetDataType(VTK_DOUBLE)
    for j in range(side + 1):
        for i in range(side + 1):
            corners.InsertNextPoint(i + j, j, 0)
    mesh.SetPoints(corners)
    for j in range(side):
        for i in range(side):
            first = i + j * (side + 1)
            mesh.InsertNextCell(VTK_QUAD, 4, [first, first + 1, first + side + 2, first + side + 1])
    tl.write(mesh, OUT / "sheared.vtu")
    worst = {}
    for leave in (True, False):
        result = tl.optimize(mesh, preset="worst element", boundary="on surface", surface_tolerance=0.005,
                             leave_surface=leave)  # fmt: skip
        worst[leave] = tl.quality(result.mesh, ["scaled_jacobian"]).values["scaled_jacobian"].min()
        assert result.surface_error <= 0.005 * mesh.GetLength()
        assert (wording("left-the-surface") in result.summary) == leave, result.summary
        name = OUT / f"sheared-{leave}.vtu"
        run("optimize", OUT / "sheared.vtu", "-o", name, "--preset", "worst element", "--boundary", "on surface",
            "--surface-tolerance", "0.005", "--leave-surface" if leave else "--no-leave-surface")  # fmt: skip
        assert np.allclose(points(tl.read(name)), points(result.mesh), rtol=0, atol=1e-12)
    assert worst[True] > worst[False] + 0.005 and abs(worst[False] - np.sqrt(0.5)) < 1e-9, worst


def test_points_that_stay():
    mesh = tl.read(PLATE)
    fixed = np.zeros(mesh.GetNumberOfPoints())
    fixed[points(mesh)[:, 0] > points(mesh)[:, 0].mean()] = 1
    result = tl.optimize(mesh, fixed=fixed)
    assert not result.displacement[fixed == 1].any() and result.displacement[fixed == 0].any()
    assert result.mesh.GetPointData().GetArray("given fixed") is None
    limited = tl.optimize(mesh, limits=1e-3)
    assert 0 < np.linalg.norm(limited.displacement, axis=1).max() <= 1e-3 * (1 + 1e-9)
    limited = tl.optimize(mesh, limits=np.where(fixed == 1, 0.0, 1e-3))
    assert not limited.displacement[fixed == 1].any()
    free = tl.optimize(mesh, boundary="sliding").free
    on_surface = tl.optimize(mesh, boundary="on surface")  # the hole is round
    assert tl.optimize(mesh).free < free < on_surface.free < tl.optimize(mesh, boundary="free").free == len(fixed)
    assert 0 < on_surface.surface_error < 0.05 * np.ptp(points(mesh)) and on_surface.inverted == 0
    near = tl.optimize(mesh, boundary="on surface", surface_tolerance=2e-5)
    assert 0 < near.surface_error <= 2e-5 * mesh.GetLength() < on_surface.surface_error
    rejected("surface_tolerance", tl.optimize, mesh, boundary="on surface", surface_tolerance=-1)
    rejected(wording("needs-a-local-optimizer"), tl.optimize, mesh, optimizer="l-bfgs", boundary="on surface")
    weights = np.zeros(mesh.GetNumberOfCells())
    weights[0] = 1
    weighted = tl.optimize(mesh, element_weights=weights)
    assert 0 < np.any(weighted.displacement, axis=1).sum() <= 4


def test_blocks_and_arrays():
    mesh = tl.read(PLATE)
    blocks = vtkMultiBlockDataSet()
    for i in range(2):
        blocks.SetBlock(i, mesh)
    single, both = tl.optimize(mesh), tl.optimize(blocks)
    assert (both.displacement == np.concatenate([single.displacement] * 2)).all()
    assert list(both.statistics) == ["block 1 imr", "block 2 imr"]
    assert both.history["iteration"].tolist() == single.history["iteration"].tolist() * 2
    assert set(both.history["block"]) == {"block 1", "block 2"}
    square = [[0, 0], [1, 0], [1, 1], [0, 1], [0.7, 0.8]]
    result = tl.optimize((square, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))
    assert np.allclose(points(result.mesh)[4], [0.5, 0.5, 0], atol=1e-2)


def test_rejected():
    for text, options in (
        ("no metric 'nope'", {"objectives": ["nope"]}),
        ("template is 'x'", {"objectives": [("imr", {"template": "x"})]}),
        ("there is no 'power'", {"objectives": [("imr", {"power": 2})]}),
        ("weight is -1", {"objectives": [("imr", {"weight": -1})]}),
        ("'reference' is not given", {"objectives": [("imr", {"target": "reference"})]}),
        ("no objective", {"objectives": []}),
        ("not 5", {"objectives": [5]}),
        ("preset is 'best'", {"preset": "best"}),
        ("decides on objectives", {"preset": "best shape", "objectives": ["imr"]}),
        ("needs a reference", {"preset": "preserve shape"}),
        ("scalarization is 'x'", {"scalarization": "x"}),
        ("optimizer is 'x'", {"optimizer": "x"}),
        ("argument of optimize() 'speed'", {"speed": 1}),
        ("maximum_iterations is -1", {"maximum_iterations": -1}),
        ("boundary is 'x'", {"boundary": "x"}),
        ("time_limit is -1", {"time_limit": -1}),
        ("each of the 1190 points", {"fixed": [1]}),
        ("each of the 1913 cells", {"element_weights": [1]}),
        ("no point array 'x'", {"fixed": "x"}),
    ):
        rejected(text, tl.optimize, PLATE, **options)
    image = vtkImageData()
    image.SetDimensions(3, 3, 3)
    rejected("implicit", tl.optimize, image)
    rejected("implicit", tl.untangle, image)
    rejected(wording("effort-is-x"), tl.untangle, PLATE, "x")
    rejected(wording("there-is-no-such-file"), tl.untangle, "absent.vtu")


def test_untangle():
    result = tl.untangle(TANGLED)
    assert result.inverted_before == 41 and result.inverted == result.impossible == 0
    assert tl.quality(result).inverted == 0 and not result.obstacle.any() and (result.validity == 1).all()
    assert result.history["inverted"][0] == 41 and result.history["inverted"][-1] == 0
    assert result.summary == "All elements are valid; 41 were not." and "valid" in result.reason
    worst = tl.optimize(TANGLED)
    assert worst.inverted_before == 41 and worst.inverted == 0 and wording("untangled-first") in worst.summary
    stopped = tl.optimize(TANGLED, time_limit=1e-6)  # one limit for untangling and optimization
    assert stopped.inverted > 0 and wording("untangling-came-first-and-left-some") in stopped.summary, stopped.summary
    rejected(wording("untangle-first"), tl.optimize, TANGLED, untangle_first=False)
    shown = tl.untangle(TANGLED, show_features=True).mesh.GetPointData().GetArray("FeatureKind")
    assert result.mesh.GetPointData().GetArray("FeatureKind") is None and shown.GetRange() == (0, 2)
    every = tl.untangle(TANGLED, method="simultaneous")  # moves all, and smooths
    assert every.inverted == 0 and tl.quality(every, "imr").values["imr"].mean() < tl.quality(
        result, "imr").values["imr"].mean()
    rejected(wording("method-is-x"), tl.untangle, TANGLED, method="x")
    ball = vtkSphereSource()
    ball.SetThetaResolution(20)
    ball.SetPhiResolution(20)
    ball.Update()
    surface = tl.perturb(ball.GetOutput(), tangle=0.1)
    assert surface.inverted > 0 and tl.untangle(surface).inverted == 0  # the boundary's default is for others
    stuck = tl.untangle(TANGLED, fixed=np.ones(2343))
    assert stuck.inverted == stuck.impossible == 41 and (np.unique(stuck.obstacle) == [0, 2]).all()
    assert wording("all-its-points-are-fixed") in stuck.summary and "Element " in stuck.summary
    inverted = np.flatnonzero(tl.quality(TANGLED).validity == -1)
    assert (np.flatnonzero(stuck.obstacle) == inverted).all() and f"Element {inverted[0]} at (" in stuck.summary


def test_commands():
    mesh, table = OUT / "cli-optimized.vtu", OUT / "cli-optimized.csv"
    options = ("--objective", "imr", "--objective", "size,weight=2", "--scalarization", "weighted sum")
    text = run("optimize", PLATE, "-o", mesh, "--csv", table, *options, "--iterations", 3)
    expected = tl.optimize(PLATE, ["imr", ("size", {"weight": 2})], scalarization="weighted sum", maximum_iterations=3)
    assert (points(tl.read(mesh)) == points(expected.mesh)).all()
    with open(table, newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert [float(row["objective"]) for row in rows] == expected.history["objective"].tolist()
    assert wording("inverse-mean-ratio-mean-2") in text and str(mesh) in text
    assert wording("all-elements-are-valid-41-were-not") in run("untangle", TANGLED, "-o", mesh)
    run("untangle", TANGLED, "-o", mesh, "--method", "simultaneous")
    assert (points(tl.read(mesh)) == points(tl.untangle(TANGLED, method="simultaneous").mesh)).all()
    assert wording("no-metric-nope") in run("optimize", PLATE, "-o", mesh, "--objective", "nope", code=2)
    assert wording("is-not-key-value") in run("optimize", PLATE, "-o", mesh, "--objective", "imr,x", code=2)
    assert wording("invalid-choice-x") in run("untangle", PLATE, "-o", mesh, "--effort", "x", code=2)


run_tests(globals())
