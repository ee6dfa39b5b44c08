# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of meshes in the plane and in space, and of silhouettes."""

from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet

from ._meshes import cells_of, points_of
from ._report import Report, pyplot

try:
    from matplotlib.colors import ListedColormap
except ImportError:  # there are no pictures
    ListedColormap = None

#: Direction of the light, and of the view, of surfaces in space.
_LIGHT = np.array([0.4, -0.7, 0.6])
_ELEVATION, _AZIMUTH = 22, -60
#: Edges of elements: gray, as blue marks inverted elements.
_EDGE = "#303030"


def triangles(mesh: vtkDataSet) -> np.ndarray:
    """The triangles of a planar mesh, or of the boundary of one of tetrahedra."""
    return cells_of(mesh) if cells_of(mesh).shape[1] == 3 else boundary_faces(mesh)


def boundary_faces(mesh: vtkDataSet) -> np.ndarray:
    """The faces of tetrahedra that only one of them has, with normals outward."""
    cells = cells_of(mesh)
    faces = np.concatenate([cells[:, f] for f in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def loops(mesh: vtkDataSet) -> int:
    """The number of closed curves that bound a mesh of triangles."""
    cells = cells_of(mesh)
    edges = np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]])
    _, first, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    follows = dict(edges[first[count == 1]])
    found = 0
    while follows:
        found += 1
        start, point = follows.popitem()
        while point != start:
            point = follows.pop(point)
    return found


def surface_picture(report: Report, file: str, meshes: dict[str, vtkDataSet], columns: int, cut: bool = False) -> None:
    """Planar meshes, and boundaries of meshes in space.

    cut: leave out the faces in front, the faces on the bounding box that face the viewer.
    """
    if pyplot is None:
        return
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    rows = -(-len(meshes) // columns)
    figure = pyplot.figure(figsize=(4.2 * columns, 4.2 * rows))
    for number, (title, mesh) in enumerate(meshes.items(), 1):
        p, faces = points_of(mesh), triangles(mesh)
        if cells_of(mesh).shape[1] == 3:
            axis = figure.add_subplot(rows, columns, number)
            axis.triplot(p[:, 0], p[:, 1], faces, linewidth=0.5, color=_EDGE)
            axis.set_aspect("equal")
        else:
            axis = figure.add_subplot(rows, columns, number, projection="3d", proj_type="ortho")
            low, high = p.min(axis=0), p.max(axis=0)
            if cut:
                centre = p[faces].mean(axis=1)
                near = 1e-6 * float(np.max(high - low))
                faces = faces[~((centre[:, 0] > high[0] - near) | (centre[:, 1] < low[1] + near)
                                | (centre[:, 2] > high[2] - near))]
            normals = np.cross(p[faces[:, 1]] - p[faces[:, 0]], p[faces[:, 2]] - p[faces[:, 0]])
            shade = np.abs(normals @ _LIGHT) / (np.linalg.norm(normals, axis=1) * np.linalg.norm(_LIGHT) + 1e-300)
            colours = (0.55 + 0.4 * shade)[:, None] * np.array([[0.9, 0.9, 0.9]])
            axis.add_collection3d(Poly3DCollection(p[faces], facecolors=colours, edgecolors=_EDGE, linewidths=0.25))
            axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
            axis.set_box_aspect(np.maximum(high - low, 1e-9))
            axis.view_init(_ELEVATION, _AZIMUTH)
        axis.set_title(title, fontsize=9)
        axis.set_axis_off()
    report.save(figure, file)


#: Backgrounds of silhouettes: right and wrong matches, and others.
FRAMES = {"right": "#cceacc", "wrong": "#fac7bd", "": "#ffffff"}
_SHAPE, _DETECTED = "#5a6169", "#d94010"


class Silhouette(NamedTuple):
    """A panel of a picture: a silhouette, the mesh that was detected in it, and the background, see FRAMES."""

    image: np.ndarray
    mesh: vtkDataSet | None = None
    frame: str = ""
    title: str = ""


def silhouettes_picture(report: Report, file: str, rows: Sequence[Sequence[Silhouette]], size: float) -> None:
    """Silhouettes and detected meshes in rows; size: of a panel, in inches."""
    if pyplot is None:
        return
    columns = max(map(len, rows))
    figure, axes = pyplot.subplots(len(rows), columns, figsize=(size * columns, size * len(rows)), squeeze=False)
    for axis in axes.flat:
        axis.set(xticks=[], yticks=[])
        axis.set_frame_on(False)
    for line, panels in zip(axes, rows):
        for axis, panel in zip(line, panels):
            low, high = float(np.min(panel.image)), float(np.max(panel.image))
            # The shape is the side of the threshold that fewer pixels of the border are on.
            inside = panel.image > 0.5 * (low + high)
            border = np.concatenate([inside[0], inside[-1], inside[:, 0], inside[:, -1]])
            shown = inside if border.mean() < 0.5 else ~inside
            axis.imshow(shown, cmap=ListedColormap([FRAMES[panel.frame], _SHAPE]), origin="lower", vmin=0, vmax=1,
                        interpolation="nearest")
            if panel.mesh is not None:
                axis.triplot(*points_of(panel.mesh)[:, :2].T, cells_of(panel.mesh), color=_DETECTED, linewidth=1)
            axis.set_title(panel.title, fontsize=8)
    report.save(figure, file)
