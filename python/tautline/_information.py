# SPDX-License-Identifier: BSD-3-Clause
"""The command info: the contents of a mesh in ten lines."""

from __future__ import annotations

import argparse
import os
import re
import sys
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet
from vtkmodules.vtkFiltersCore import vtkConnectivityFilter

from . import _commands
from ._arrays import leaves
from ._errors import Aborted, Error, run
from ._io import read
from ._quality import quality
from ._quality_parts import QualityResult
from ._tables import file_size, many
from ._views import cell_data_of, cells_of, point_data_of

_WIDTH = 110  # characters of a line
_MOST_REGIONS = 50  # an array of more numbers does not name regions
_REGIONS = re.compile(r"region|material|part|block|group|entit|physical|domain|reference|marker|zone|tag|pid", re.I)


def facts_of(mesh: Any) -> dict[str, Any]:
    """Counts, types of cells, bounds, regions, arrays and quality of a mesh, as JSON has them."""
    parts: list[vtkDataSet] = list(leaves(mesh))
    if not parts:
        raise Error("the mesh has no data sets")
    types: dict[str, int] = {}
    for part in parts:
        for name, cells in cells_of(part).items():
            types[name] = types.get(name, 0) + len(cells)
    boxes = np.array([part.GetBounds() for part in parts if part.GetNumberOfPoints()]).reshape(-1, 3, 2)
    bounds = np.stack([boxes[:, :, 0].min(0), boxes[:, :, 1].max(0)], axis=1).tolist() if len(boxes) else []
    arrays = {
        "point_arrays": {k: _described(v) for part in parts for k, v in point_data_of(part).items()},
        "cell_arrays": {k: _described(v) for part in parts for k, v in cell_data_of(part).items()},
    }
    return {
        "class": mesh.GetClassName(),
        "points": sum(part.GetNumberOfPoints() for part in parts),
        "cells": sum(part.GetNumberOfCells() for part in parts),
        "types": types,
        "bounds": bounds,
        "pieces": sum(map(_pieces, parts)),
        "regions": _regions(parts),
        **arrays,
        **_quality(mesh),
    }


def _pieces(part: vtkDataSet) -> int:
    """The number of parts that are not connected by a point."""
    if not part.GetNumberOfCells():
        return 0
    connected = vtkConnectivityFilter()
    connected.SetInputData(part)
    connected.SetExtractionModeToAllRegions()
    run(connected)
    return int(connected.GetNumberOfExtractedRegions())


def _regions(parts: list[vtkDataSet]) -> dict[str, list[int]]:
    """The values of the integer cell arrays that are named like regions, materials, ..."""
    found: dict[str, set[int]] = {}
    for part in parts:
        for name, values in cell_data_of(part).items():
            if isinstance(values, np.ndarray) and values.ndim == 1 and _REGIONS.search(name):
                if values.dtype.kind in "iu" or (np.isfinite(values).all() and (values == np.floor(values)).all()):
                    found.setdefault(name, set()).update(np.unique(values).astype(int).tolist())
    return {name: sorted(values) for name, values in found.items() if 0 < len(values) <= _MOST_REGIONS}


def _described(values: Any) -> str:
    if isinstance(values, list):
        return "text"
    return str(values.dtype) + (f" x {values.shape[1]}" if values.ndim > 1 else "")


def _quality(mesh: Any) -> dict[str, Any]:
    """Inverted and degenerate elements, and the range of the inverse mean ratio; or why it is not measured."""
    try:
        result: QualityResult = quality(mesh)
    except Error as error:
        return {"quality": {}, "not_measured": str(error).splitlines()[0]}
    facts = result.statistics["imr"]
    names = ("measured", "not_measured", "minimum", "mean", "maximum", "outside_acceptable")
    worst = facts["worst_cells"].tolist()[:1]
    at = {"worst_cell": worst[0], "worst_position": facts["worst_positions"][0].tolist()} if worst else {}
    counts = {"inverted": result.inverted, "degenerate": result.degenerate}
    return {"quality": counts | {name: facts[name] for name in names} | at, "not_measured": ""}


def text_of(file: str, facts: dict[str, Any]) -> str:
    """The facts in at most ten lines."""
    listed = [f"{count} {many(name, count)}" for name, count in facts["types"].items()]
    axes = [f"{axis} {low:.6g} to {high:.6g}" for axis, (low, high) in zip("xyz", facts["bounds"])]
    pieces = f"{facts['pieces']} connected {many('piece', facts['pieces'])}"
    regions = [f"{name} {', '.join(map(str, values))}" for name, values in facts["regions"].items()]
    size = f", {file_size(os.path.getsize(file))}" if os.path.isfile(file) else ""
    lines = [
        f"{file}: {facts['class']}{size}",
        f"points        {facts['points']}",
        f"cells         {facts['cells']}" + (f": {', '.join(listed)}" if listed else ""),
        f"bounds        {', '.join(axes) or 'none'}",
        f"regions       {'; '.join([pieces, *regions])}",
    ]
    for key, title in (("point_arrays", "point arrays"), ("cell_arrays", "cell arrays")):
        arrays = [f"{name} ({kind})" for name, kind in facts[key].items()]
        lines.append(f"{title:13} {', '.join(arrays) or 'none'}")
    found = facts["quality"]
    if not found:
        lines.append(f"quality       not measured: {facts['not_measured']}")
    else:
        text = f"{found['inverted']} inverted, {found['degenerate']} degenerate"
        text += f", {found['not_measured']} not measured" if found["not_measured"] else ""
        lines.append(f"quality       {text}")
        if found["measured"]:
            outside = f"{found['outside_acceptable']} of {found['measured']} outside the acceptable range"
            low, high = (f"{found[key]:.6g}" for key in ("minimum", "maximum"))
            lines.append(f"              inverse mean ratio {low} to {high}, mean {found['mean']:.6g}; {outside}")
        if "worst_cell" in found:
            place = ", ".join(f"{value:.6g}" for value in found["worst_position"])
            lines.append(f"              worst: element {found['worst_cell']} at {place}")
    return "\n".join(line if len(line) <= _WIDTH else line[: _WIDTH - 4] + " ..." for line in lines)


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `info` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "info", _run, "show the contents of a mesh: counts, types, bounds, regions, arrays, quality",
        threads=False, example="part.vtu", details="Several files are shown one after the other.",
    )  # fmt: skip
    _commands.add_mesh(parser)
    _commands.take_more(parser)


def _run(arguments: argparse.Namespace) -> int:
    found: dict[str, dict[str, Any]] = {}
    for file in (arguments.mesh, *arguments.more):
        try:
            found[file] = facts_of(read(file))
        except Aborted:
            raise
        except Error as error:
            if not arguments.more:
                raise
            print(f"tautline: {error}", file=sys.stderr)
    text = "\n\n".join(text_of(file, facts) for file, facts in found.items())
    listed = [{"file": file, **facts} for file, facts in found.items()]
    _commands.finish(arguments, None, text, facts={"meshes": listed} if arguments.more else listed[0])
    return 0 if len(found) == 1 + len(arguments.more) else 1
