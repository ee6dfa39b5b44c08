# SPDX-License-Identifier: BSD-3-Clause
"""Figures of meshes, metrics and constructions: 1.1, 1.2, 2.1, 2.2, 3.1, 3.3, 3.12, 4.1 to 4.8, 4.21, 4.23, 4.37 ..."""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from . import _constructions
from ._drawings import boundary_faces, loops, surface_picture
from ._horizon import square
from ._intersections import CASES, areas, picture
from ._meshes import cells_of, points_of, sizes_of
from ._report import Report, parser, pyplot
from ._silhouettes import data_set
from ._verdicts import COUNT_TOLERANCE, all_of, same_count, unless
from .bore import warped_bore

#: Figure 2.1: the fixed vertices and the panels; the value at the best position and where it is.
BASE_2_1 = ((0.0, 0.0), (0.0, 1.0))
BEST = {"imr": 1.0, "rr": math.sqrt(2.0), "si": 1 / (4 * math.sqrt(3))}  # by the formulas of Table 2.2
STATED_RR = 0.5  # the lower end of the range of RR in section 2.4
APEX_2_1, APEX_3_1 = (math.sqrt(3) / 2, 0.5), (0.5, math.sqrt(3) / 2)
LARGER_IS_BETTER = ("si", "ss")
BETA = 0.25  # of Figure 3.1 (e)
SHOWN = 75  # percent of the positions whose values the colors of an unbounded metric span
SMALL_ANGLE = math.radians(20)
#: Triangles in the unit square of Figures 4.6 and 4.7, by 1/h.
ELEMENTS = {10: 200, 20: 800, 40: 3200}
HORIZON = 0.2
INVERTED_3_12 = 13
#: The categories of Figure 5.4, the images of each, and the samples that it shows.
CATEGORIES, MEMBERS, SAMPLES = 9, 11, 3
OUTLINE_TOLERANCE = 0.1  # of d_max by the vertices of the mesh, against the whole outline
STEP = 0.06  # within which the best position among grid points is found
HORIZONS = (0.2, 0.3, 0.4)  # of which the entries of a row are counted
WIDTH = 600  # of the picture of the matrix, pixels


def main(arguments: Sequence[str]) -> int:
    made = parser("figures", __doc__, threads=0)
    made.add_argument("--data", metavar="FOLDER", help="silhouettes with labels.csv and images (default: synthetic)")
    made.add_argument("--seed", type=int, default=1, help="of the synthetic silhouettes (default: %(default)s)")
    given = made.parse_args(arguments)
    report = Report("figures", "Figures of the dissertation", given)
    report.text("The figures that show meshes, metrics and constructions, drawn from this project's meshes; their "
                "findings are what text and captions state about them.")
    improvement(report, given)
    contours(report, given)
    meshes(report, given)
    nonlocal_figures(report, given)
    silhouettes(report, given)
    return report.finish()


# --- Figures 1.1 and 1.2 ----------------------------------------------------------------------------------


def improvement(report: Report, given: Any) -> None:
    """The drawings of constructions, and the content of two of them."""
    rough, smooth, tangled = _constructions.draw(report, given.threads)
    quality = [float(np.mean(tautline.quality(mesh, ["imr"]).values["imr"])) for mesh in (rough, smooth)]
    improvement_findings(report, quality[0], quality[1], int(np.sum(sizes_of(tangled) <= 0)))


def improvement_findings(report: Report, before: float, after: float, inverted: int) -> None:
    same = "the small size of the study has the same mesh"
    report.finding("Figure 1.1", "Mesh quality improvement makes the elements better", after < before,
                   f"mean IMR {before:.4f} before, {after:.4f} after", proof=same, criterion="the mean decreases")
    report.finding("Figure 1.2", "A tangled mesh includes inverted elements", inverted > 0, f"{inverted} inverted",
                   criterion="at least one", proof=same)


# --- Figures 2.1 and 3.1 ----------------------------------------------------------------------------------


def contours(report: Report, given: Any) -> None:
    count = 61 if given.small else 241
    side = (-2.0, 0.0, -0.5, 1.5)
    left = tautline.metric_field(("imr", "rr", "si", "ss"), vertices=BASE_2_1, bounds=side, dimensions=(count, count),
                                 threads=given.threads)
    below = (-1.0, 2.0, 0.0, 2.0)
    right = tautline.metric_field(("imr", "si", "ss", "size", "untangle_beta"), bounds=below, beta=BETA,
                                  dimensions=(count, 2 * count // 3), threads=given.threads)
    panels(report, "figure_2_1", left, side, {"imr": "(a) IMR", "rr": "(b) RR", "si": "(c) SI", "ss": "(d) SS"})
    panels(report, "figure_3_1", right, below, {"imr": "(a) IMR", "si": "(b) SI", "ss": "(c) SS", "size": "(d) Size",
                                                "untangle_beta": f"(e) Untangling, beta = {BETA}"})
    best = {m: best_position(left, side, m) for m in BEST}
    penalties = penalty(right, below)
    y = np.linspace(below[2], below[3], right.validity.shape[0])[:, None] + np.zeros(right.validity.shape)
    contour_findings(report, best, penalties, right.values["untangle_beta"], y / 2)


def panels(report: Report, file: str, field: Any, bounds: Sequence[float], titles: dict[str, str]) -> None:
    if pyplot is None:
        return
    columns = 2 if len(titles) == 4 else 3
    figure, axes = pyplot.subplots(2, columns, figsize=(4.2 * columns, 7.2), squeeze=False)
    for axis in axes.flat[len(titles):]:
        axis.set_axis_off()
    for axis, (name, title) in zip(axes.flat, titles.items()):
        values = np.where(field.validity == 1, field.values[name], np.nan)
        if name == "untangle_beta":
            values = field.values[name]
        elif name not in LARGER_IS_BETTER:  # unbounded: the best values are in the foreground
            values = np.minimum(values, np.nanpercentile(values, SHOWN))
        axis.contourf(np.linspace(*bounds[:2], values.shape[1]), np.linspace(*bounds[2:], values.shape[0]), values, 24,
                      cmap="jet_r" if name in LARGER_IS_BETTER else "jet")
        axis.set_title(title)
        axis.set_aspect("equal")
    report.save(figure, file)


def best_position(field: Any, bounds: Sequence[float], metric: str) -> tuple[float, float, float]:
    """The best value of a metric among the grid points, and the position of the free vertex there, |x| and y."""
    values = np.where(field.validity == 1, field.values[metric], np.nan)
    at = np.nanargmax(values) if metric in LARGER_IS_BETTER else np.nanargmin(values)
    row, column = np.unravel_index(at, values.shape)
    x = np.linspace(*bounds[:2], values.shape[1])[column]
    return float(values[row, column]), abs(float(x)), float(np.linspace(*bounds[2:], values.shape[0])[row])


def penalty(field: Any, bounds: Sequence[float]) -> dict[str, np.ndarray]:
    """How much worse than the equilateral triangle each metric is where the smallest angle is below 20 degrees."""
    rows, columns = field.validity.shape
    x, y = np.meshgrid(np.linspace(*bounds[:2], columns), np.linspace(*bounds[2:], rows))
    with np.errstate(all="ignore"):
        a, b = np.arctan2(y, x), np.arctan2(y, 1 - x)
    small = (np.minimum(np.minimum(a, b), math.pi - a - b) < SMALL_ANGLE) & (field.validity == 1)
    near = np.hypot(x - APEX_3_1[0], y - APEX_3_1[1]).argmin()
    found = {}
    for name in ("imr", "si", "ss"):
        ratio = field.values[name][small] / field.values[name].flat[near]
        found[name] = 1 / ratio if name in LARGER_IS_BETTER else ratio
    return found


def contour_findings(report: Report, best: dict[str, tuple[float, float, float]], penalties: dict[str, np.ndarray],
                     untangle: np.ndarray, areas_there: np.ndarray) -> None:
    formula = "a property of the formulas of the metrics of one triangle"
    report.finding("Figure 2.1", "IMR, RR and SI are best at the equilateral triangle",
                   all_of(abs(v / BEST[m] - 1) < STEP**2 and math.dist((x, y), APEX_2_1) < STEP
                          for m, (v, x, y) in best.items()),
                   ", ".join(f"{m} {v:.4f} at ({x:.2f}, {y:.2f})" for m, (v, x, y) in best.items()),
                   criterion=f"1, sqrt 2 and 1 / (4 sqrt 3) within {STEP**2:.2g}, there within {STEP:g}", proof=formula)
    report.finding("2.4", "The range of RR begins at 0.5", abs(best["rr"][0] - STATED_RR) < STEP**2,
                   f"{best['rr'][0]:.4f}", stated=f"{STATED_RR:g}", criterion=f"the least value within {STEP**2:.2g}",
                   reason="RR of Table 2.2 is the root of the circumscribed over the inscribed radius, which is at "
                   "least 2 in any triangle (Euler) and 2 in the equilateral one: it begins at sqrt 2; 0.5 is 1 / 2",
                   proof=formula)  # fmt: skip
    less = {m: float(np.mean(penalties["ss"] < penalties[m])) for m in ("imr", "si")}
    report.finding("Figure 3.1", "SS penalizes small angles less than IMR and SI",
                   all_of(v > 0.5 for v in less.values()),
                   ", ".join(f"less than {m} at {v:.0%}" for m, v in less.items()), proof=formula,
                   criterion=f"at most positions with an angle below {math.degrees(SMALL_ANGLE):g} degrees")
    wrong = int(np.sum((untangle > 1e-12) != (areas_there < BETA - 1e-12)))
    report.finding("Figure 3.1 (e)", f"Untangling is 0 where the area is at least beta = {BETA}, and above 0 elsewhere",
                   wrong == 0, f"{wrong} of {untangle.size} positions differ", criterion="at all positions",
                   proof=formula)


# --- Figures 2.2, 3.3, 3.12, 4.37 -------------------------------------------------------------------------


def meshes(report: Report, given: Any) -> None:
    coarse = {name: tautline.domain(name, cells) for name, cells in
              (("wrench", 900), ("hinge", 1200), ("disk2d", 500), ("barrier2d", 700), ("disk3d", 2500),
               ("barrier3d", 3000))}
    report.meshes("figure_2_2", [("(a) Wrench", coarse["wrench"]), ("(b) Hinge", coarse["hinge"])], columns=2)
    flat = {"(a) Disk (2D)": coarse["disk2d"], "(b) Barrier (2D)": coarse["barrier2d"]}
    solid = {"(c) Disk (3D)": coarse["disk3d"], "(d) Barrier (3D)": coarse["barrier3d"]}
    surface_picture(report, "figure_3_3", {**flat, **solid}, columns=4)
    initial = tautline.domain("bore", 3_000 if given.small else 109_535)
    deformed, _ = warped_bore(given.small)
    surface_picture(report, "figure_3_12", {"(a) initial": initial, "(b) deformed by FEMWARP": deformed}, columns=2,
                    cut=True)
    sphere = tautline.domain("sphere", 3_000 if given.small else 0)
    surface_picture(report, "figure_4_37_a", {"surface mesh, moving sphere in a cube": sphere}, columns=1, cut=True)
    holes = {name: loops(coarse[name]) - 1 for name in ("wrench", "hinge")}
    mesh_findings(report, holes, {name: int(np.sum(sizes_of(m) <= 0)) for name, m in coarse.items()},
                  (int(np.sum(sizes_of(initial) <= 0)), int(np.sum(sizes_of(deformed) <= 0))),
                  len(shells(sphere)))


def shells(mesh: vtkDataSet) -> list[int]:
    """The number of faces of each connected part of the boundary of a mesh of tetrahedra."""
    faces = boundary_faces(mesh)
    parent = np.arange(mesh.GetNumberOfPoints())

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b, c in faces:
        parent[root(a)] = root(b)
        parent[root(c)] = root(b)
    return list(np.unique([root(f[0]) for f in faces], return_counts=True)[1])


def mesh_findings(report: Report, holes: dict[str, int], inverted: dict[str, int], bore: tuple[int, int],
                  parts: int) -> None:
    same = "the small size of the study has the same meshes"
    report.finding("Figure 2.2", "The hinge has many holes, more than the wrench", holes["hinge"] > holes["wrench"],
                   ", ".join(f"{name} {n}" for name, n in holes.items()), proof="the outlines are the same at any size")
    report.finding("Figures 2.2, 3.3", "The initial meshes have no inverted elements",
                   all_of(n == 0 for n in inverted.values()),
                   ", ".join(f"{name} {n}" for name, n in inverted.items()), proof=same)
    report.finding("Figure 3.12", "The bore has no inverted element at first, and as many as in the dissertation after "
                   "FEMWARP", all_of((bore[0] == 0, same_count(bore[1], INVERTED_3_12))), f"{bore[0]} and {bore[1]}",
                   stated=f"0 and {INVERTED_3_12}", own=True, criterion=f"none, and within {COUNT_TOLERANCE:.0%} of "
                   "the printed count")  # fmt: skip
    report.finding("Figure 4.37 (a)", "The surface has two parts, the cube and the sphere", parts == 2,
                   f"{parts} parts", own=True, proof="the surfaces are the same at any size")


# --- Figures 4.2, 4.4 to 4.8 ------------------------------------------------------------------------------


def nonlocal_figures(report: Report, given: Any) -> None:
    n = 10 if given.small else 20
    mesh, region, fixed = square(n, 1, HORIZON)
    result = tautline.peridynamics(mesh, HORIZON, 1.0, "linear", region=region, given_points=fixed, sparsity=WIDTH,
                                   threads=given.threads)
    if pyplot is not None:
        figure, axis = pyplot.subplots(figsize=(5.6, 5.8))
        axis.imshow(result.sparsity > 0, cmap="Greys", interpolation="nearest", extent=(0, result.rows, result.rows, 0))
        axis.set(title=f"sparsity pattern, 1/h = {n}, delta = {HORIZON}", xlabel=f"nz = {result.nonzeros:,}")
        report.save(figure, "figure_4_2")
    picture(report, "figure_4_4", tuple(CASES))
    picture(report, "figure_4_5", ("2",))
    shown = {(count, 1): square(count, 1, HORIZON)[0] for count in ELEMENTS}
    shown[10, 4] = square(10, 4, HORIZON)[0]
    titles = [(f"({letter}) h = {1 / count:g}, delta = {HORIZON}", shown[count, 1]) for letter, count in
              zip("abc", ELEMENTS)]
    report.meshes("figure_4_6", titles, columns=3)
    report.meshes("figure_4_7", [(f"aspect ratio 4, delta = {HORIZON}", shown[10, 4])])
    entries = {delta: row_entries(n, delta, given.threads) for delta in HORIZONS}
    nonlocal_findings(report, entries, local_row(mesh), {k: inside(m) for k, m in shown.items()}, legs(shown[10, 4]),
                      {case: areas(case) for case in CASES})


def row_entries(n: int, delta: float, threads: int) -> float:
    """Nonzero entries of a row, the mean."""
    mesh, region, fixed = square(n, 1, delta)
    result = tautline.peridynamics(mesh, delta, 1.0, "linear", region=region, given_points=fixed, spectrum=False,
                                   threads=threads)
    return result.nonzeros / result.rows


def local_row(mesh: vtkDataSet) -> float:
    """Entries of a row of the local model, the median: the neighbors of a point by an edge, and the point."""
    cells = cells_of(mesh)
    edges = np.unique(np.sort(np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]]), axis=1), axis=0)
    return 1 + float(np.median(np.bincount(edges.ravel(), minlength=mesh.GetNumberOfPoints())))


def inside(mesh: vtkDataSet) -> int:
    """The number of triangles in the unit square."""
    centres = points_of(mesh)[cells_of(mesh)].mean(axis=1)[:, :2]
    return int(((centres > 0) & (centres < 1)).all(axis=1).sum())


def legs(mesh: vtkDataSet) -> float:
    """W / w of Figure 4.8: the second shortest over the shortest edge, the mean of all triangles."""
    p = points_of(mesh)[cells_of(mesh)]
    lengths = np.sort(np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2), axis=1)
    return float(np.mean(lengths[:, 1] / lengths[:, 0]))


def nonlocal_findings(report: Report, entries: dict[float, float], local: float, counts: dict[tuple[int, int], int],
                      ratio: float, cut: dict[str, tuple[float, float]]) -> None:
    """entries: nonzero entries of a row by the horizon; local: nonzero entries of the local model."""
    made = "a property of the construction of the mesh"
    told = ", ".join(f"{v:.1f} with delta = {d}" for d, v in entries.items())
    report.finding("Figure 4.2", "More nonzero entries appear than in the local model",
                   all_of(v > local for v in entries.values()), f"per row {told}, locally {local:.0f}",
                   criterion="of a row, the mean, with each horizon",
                   proof="the neighbors of a point by edges are within a horizon of at least the mesh size")
    values = list(entries.values())
    report.finding("4.2, 4.6", "The horizon determines the sparsity pattern",
                   all_of(a < b for a, b in zip(values, values[1:])), f"per row {told}",
                   criterion="the entries of a row increase with the horizon",
                   proof="a larger disc has the points of a smaller one")
    report.finding("Figure 4.4", "Case 1 is exact, cases 2 and 3 are approximated from inside",
                   abs(cut["1"][0] / cut["1"][1] - 1) < 1e-6 and all(0 < cut[c][0] < cut[c][1] for c in ("2", "3")),
                   "; ".join(f"case {c}: {a:.4f} of {exact:.4f}" for c, (a, exact) in cut.items()),
                   proof="chords of a disc are in it")
    report.finding("Figures 4.6, 4.7", "The unit square has 200, 800 and 3,200 elements, and as many at aspect ratio 4",
                   all_of(count == ELEMENTS[n] for (n, _), count in counts.items()),
                   ", ".join(f"1/h = {n}, AR {r}: {count}" for (n, r), count in counts.items()), proof=made)
    report.finding("Figures 4.7, 4.8", "W / w of the anisotropic mesh is 4", abs(ratio - 4) < 1e-9, f"{ratio:.6g}",
                   proof=made)


# --- Figures 5.1, 5.2, 5.4 --------------------------------------------------------------------------------


def silhouettes(report: Report, given: Any) -> None:
    images, labels, _, text = data_set(given.data, given.small, given.seed)
    report.text(text)
    spacing = 10.0
    source, target = [image for image, label in zip(images, labels) if label == labels[-1]][:2]
    shape = tautline.silhouette(source, spacing)
    found = tautline.match(source, target, spacing=spacing, threads=given.threads)
    outline = points_of(shape.mesh)[:, :2]
    if pyplot is not None:
        overview(report, source, target, shape, found)
        samples(report, images, labels)
    centre = shape.centre[:2]
    distances = np.linalg.norm(outline - centre, axis=1)
    silhouette_findings(report, shape.mesh.GetNumberOfPoints(), shape.mesh.GetNumberOfCells(), float(distances.max()),
                        float(shape.max_distance), found.mesh.GetNumberOfCells(),
                        {label: labels.count(label) for label in dict.fromkeys(labels)}, given.data is not None)


def overview(report: Report, source: Any, target: Any, shape: Any, found: Any) -> None:
    p, cells = points_of(shape.mesh)[:, :2], cells_of(shape.mesh)
    figure, axes = pyplot.subplots(1, 3, figsize=(12.6, 4.4))
    for axis, title in zip(axes, ("(a) boundary vertices", "(b) triangular mesh", "(c) detected in the target")):
        axis.imshow(target if title.startswith("(c)") else source, cmap="Greys", origin="lower", alpha=0.4)
        axis.set_title(title)
        axis.set_axis_off()
    axes[0].plot(*p.T, "o", markersize=4, color="#c04000")
    axes[1].triplot(*p.T, cells, color="#c04000", linewidth=1)
    axes[2].triplot(*points_of(found.mesh)[:, :2].T, cells_of(found.mesh), color="#c04000", linewidth=1)
    report.save(figure, "figure_5_1")
    figure, axes = pyplot.subplots(1, 2, figsize=(8.4, 4.4))
    for axis in axes:
        axis.imshow(source, cmap="Greys", origin="lower", alpha=0.4)
        axis.set_axis_off()
    far = p[np.linalg.norm(p - shape.centre[:2], axis=1).argmax()]
    axes[1].plot(*shape.centre[:2], "o", color="#c04000")
    axes[1].annotate("", xy=far, xytext=shape.centre[:2], arrowprops={"arrowstyle": "->", "color": "#c04000"})
    axes[1].text(*shape.centre[:2], " C", va="bottom")
    report.save(figure, "figure_5_2")


def samples(report: Report, images: Sequence[np.ndarray], labels: Sequence[str]) -> None:
    classes = list(dict.fromkeys(labels))
    figure, axes = pyplot.subplots(SAMPLES, len(classes), figsize=(1.3 * len(classes), 1.4 * SAMPLES), squeeze=False)
    for column, name in enumerate(classes):
        members = [i for i, label in enumerate(labels) if label == name][:SAMPLES]
        for axis, member in zip(axes[:, column], members):
            axis.imshow(images[member], cmap="Greys", origin="lower")
        axes[0, column].set_title(name, fontsize=8)
    for axis in axes.flat:
        axis.set_axis_off()
    report.save(figure, "figure_5_4")


def silhouette_findings(report: Report, vertices: int, cells: int, farthest: float, stated: float, detected: int,
                        members: dict[str, int], real: bool) -> None:
    """real: whether the silhouettes are not the synthetic ones."""
    report.finding("Figure 5.1", "The mesh has no interior vertices and is detected as a whole",
                   cells == vertices - 2 and detected == cells,
                   f"{vertices} vertices, {cells} triangles, {detected} detected",
                   criterion="n - 2 triangles of n boundary vertices, all detected",
                   proof="any triangulation of a polygon of n vertices without further ones has n - 2 triangles")
    report.finding("Figure 5.2", "d_max is the distance of the farthest boundary vertex from the center of mass",
                   abs(farthest / stated - 1) <= OUTLINE_TOLERANCE,
                   f"vertices {farthest:.1f}, outline {stated:.1f} pixels",
                   criterion=f"the vertices' distance is within {OUTLINE_TOLERANCE:.0%} of the whole outline's")
    report.finding("Figure 5.4", "9 categories of 11 images each", unless(
        "" if real else "the silhouettes are synthetic; give the dissertation's with --data",
        len(members) == CATEGORIES and set(members.values()) == {MEMBERS}),
        ", ".join(f"{name} {n}" for name, n in members.items()))
