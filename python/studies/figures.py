# SPDX-License-Identifier: BSD-3-Clause
"""Figures of meshes, metrics and constructions: 2.1, 2.2, 3.1, 3.3, 3.12, 4.2, 4.4 to 4.8, 4.37 (a), 5.1, 5.2, 5.4."""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

import tautline

from ._meshes import cells_of, points_of, sizes_of
from ._report import Report, parser, pyplot
from ._drawings import boundary_faces, image_values, loops, surface_picture
from ._horizon import square
from ._intersections import CASES, areas, picture
from ._silhouettes import data_set
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
SAMPLES = 3  # of each category in Figure 5.4
WIDTH = 600  # of the picture of the matrix, pixels


def main(arguments: Sequence[str]) -> int:
    made = parser("figures", __doc__, threads=0)
    made.add_argument("--data", metavar="FOLDER", help="silhouettes with labels.csv and images (default: synthetic)")
    made.add_argument("--seed", type=int, default=1, help="of the synthetic silhouettes (default: %(default)s)")
    given = made.parse_args(arguments)
    report = Report("figures", "Figures of the dissertation", given.out, given.small)
    report.text("The figures that show meshes, metrics and constructions, drawn from this project's meshes; their "
                "findings are what text and captions state about them.")
    contours(report, given)
    meshes(report, given)
    nonlocal_figures(report, given)
    silhouettes(report, given)
    return report.finish()


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
    step = 0.06
    report.finding("Figure 2.1", "IMR, RR and SI are best, 1, sqrt 2 and 1/(4 sqrt 3), at the equilateral triangle",
                   all(abs(v / BEST[m] - 1) < step**2 and math.dist((x, y), APEX_2_1) < step
                       for m, (v, x, y) in best.items()),
                   ", ".join(f"{m} {v:.4f} at ({x:.2f}, {y:.2f})" for m, (v, x, y) in best.items()), any_size=True)
    report.finding("2.4", f"The least value of RR is {STATED_RR:g}", abs(best["rr"][0] - STATED_RR) < step**2,
                   f"{best['rr'][0]:.4f}; by Table 2.2 sqrt 2", any_size=True)
    less = {m: float(np.mean(penalties["ss"] < penalties[m])) for m in ("imr", "si")}
    report.finding("Figure 3.1", "SS penalizes small angles less than IMR and SI (most positions with an angle below "
                   "20 degrees)", all(v > 0.5 for v in less.values()),
                   ", ".join(f"less than {m} at {v:.0%}" for m, v in less.items()), any_size=True)
    wrong = int(np.sum((untangle > 1e-12) != (areas_there < BETA - 1e-12)))
    report.finding("Figure 3.1 (e)", f"Untangling is 0 where the area is at least beta = {BETA}, and above 0 elsewhere",
                   wrong == 0, f"{wrong} of {untangle.size} positions differ", any_size=True)


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
    report.finding("Figure 2.2", "The hinge has many holes, more than the wrench", holes["hinge"] > holes["wrench"],
                   ", ".join(f"{name} {n}" for name, n in holes.items()), any_size=True)
    report.finding("Figures 2.2, 3.3", "The initial meshes have no inverted elements", not any(inverted.values()),
                   ", ".join(f"{name} {n}" for name, n in inverted.items()), any_size=True)
    report.finding("Figure 3.12", f"The bore has no inverted element at first and {INVERTED_3_12} after FEMWARP",
                   bore == (0, INVERTED_3_12), f"{bore[0]} and {bore[1]}")
    report.finding("Figure 4.37 (a)", "The surface has two parts, the cube and the sphere", parts == 2,
                   f"{parts} parts", any_size=True)


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
    aspect_picture(report)
    nonlocal_findings(report, result.nonzeros / result.rows, local_row(mesh), {k: inside(m) for k, m in shown.items()},
                      legs(shown[10, 4]), {case: areas(case) for case in CASES})


def local_row(mesh: vtkDataSet) -> float:
    """Entries of a row of the local model, the median: the neighbours of a point by an edge, and the point."""
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


def aspect_picture(report: Report) -> None:
    if pyplot is None:
        return
    figure, axis = pyplot.subplots(figsize=(5.6, 2.4))
    axis.plot([0, 4, 0, 0], [0, 0, 1, 0], color="#1f4e79")
    axis.text(2, -0.25, "W", ha="center")
    axis.text(-0.2, 0.5, "w", va="center")
    axis.set(xlim=(-0.5, 4.3), ylim=(-0.4, 1.2), title="aspect ratio W / w")
    axis.set_aspect("equal")
    axis.set_axis_off()
    report.save(figure, "figure_4_8")


def nonlocal_findings(report: Report, row: float, local: float, counts: dict[tuple[int, int], int], ratio: float,
                      cut: dict[str, tuple[float, float]]) -> None:
    report.finding("Figure 4.2", "More nonzero entries appear than in the local model", row > local,
                   f"{row:.1f} per row, locally {local:.0f}", any_size=True)
    report.finding("Figure 4.4", "Case 1 is exact, cases 2 and 3 are approximated from inside",
                   abs(cut["1"][0] / cut["1"][1] - 1) < 1e-6 and all(0 < cut[c][0] < cut[c][1] for c in ("2", "3")),
                   "; ".join(f"case {c}: {a:.4f} of {exact:.4f}" for c, (a, exact) in cut.items()), any_size=True)
    report.finding("Figures 4.6, 4.7", "The unit square has 200, 800 and 3,200 elements, and as many at aspect ratio 4",
                   all(count == ELEMENTS[n] for (n, _), count in counts.items()),
                   ", ".join(f"1/h = {n}, AR {r}: {count}" for (n, r), count in counts.items()), any_size=True)
    report.finding("Figures 4.7, 4.8", "W / w of the anisotropic mesh is 4", abs(ratio - 4) < 1e-9, f"{ratio:.6g}",
                   any_size=True)


# --- Figures 5.1, 5.2, 5.4 --------------------------------------------------------------------------------


def silhouettes(report: Report, given: Any) -> None:
    shapes, labels, _, text = data_set(given.data, given.small, given.seed)
    report.text(text)
    if labels is None:
        images, labels = image_values(shapes)
    else:
        images = list(shapes)
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
                        {label: list(labels).count(label) for label in dict.fromkeys(labels)})


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
                        members: dict[str, int]) -> None:
    report.finding("Figure 5.1", "The mesh has no interior vertices: n - 2 triangles of n boundary vertices, which are "
                   "all detected", cells == vertices - 2 and detected == cells,
                   f"{vertices} vertices, {cells} triangles, {detected} detected", any_size=True)
    report.finding("Figure 5.2", "d_max is the distance of the farthest boundary vertex from the center of mass",
                   abs(farthest / stated - 1) < 0.1, f"vertices {farthest:.1f}, outline {stated:.1f} pixels",
                   any_size=True)
    report.finding("Figure 5.4", "9 categories of 11 images each", len(members) == 9 and set(members.values()) == {11},
                   ", ".join(f"{name} {n}" for name, n in members.items()))
