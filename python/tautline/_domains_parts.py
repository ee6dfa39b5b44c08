# SPDX-License-Identifier: BSD-3-Clause
"""The functions domain and domains: meshes of the dissertation's domains."""

from __future__ import annotations

import argparse
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataSet

from . import _commands, _vtk
from ._arguments import set_time_limit, within
from ._errors import checked, interruptible, run, watch
from ._names import find_name
from ._interrupts import Progress


@checked
def domains() -> list[str]:
    """The names of the domains, for domain()."""
    source = _vtk.vtkDomainSource
    return [source.GetDomainName(i) for i in range(source.GetNumberOfDomains())]


@interruptible
def domain(
    name: str,
    cells: int = 0,
    *,
    amount: float = 1.0,
    element_size: float = 0.1,
    aspect_ratio: float = 1.0,
    layer_width: float = 0.2,
    time_limit: float = 0.0,
    deformed_boundary: bool = False,
    progress: Progress | bool | None = None,
) -> vtkDataSet:
    """Mesh a domain of the dissertation.

    name: one of domains().
    cells: approximate number of cells; 0: as many as in the dissertation's example.
    amount: fraction of the motion of the boundary on moving domains.
    element_size: leg of the isotropic triangles of the square.
    aspect_ratio: ratio of the legs of the triangles of the square.
    layer_width: width of the interaction layer (collar) of the square.
    time_limit: seconds; 0 is no limit.
    deformed_boundary: return the moved boundary instead of the mesh.

    The mesh has the point arrays `BoundaryMarker`, `Fixed` and, on moving domains, `Displacement` (times `amount`).
    Raises Error for wrong arguments and for domains that need meshers that were not built; for an unknown name the
    message lists the names.

    >>> mesh = tautline.domain("cylinder", cells=5000, amount=0.5)
    """
    source = _vtk.vtkDomainSource()
    messages = watch(source)
    source.SetDomainByName(find_name(name, domains()) or str(name))
    messages.raise_errors()
    source.SetNumberOfCells(int(within("the number of cells", cells, 0, source.GetNumberOfCellsMaxValue())))
    source.SetAmount(within("the amount", amount, source.GetAmountMinValue(), source.GetAmountMaxValue()))
    low, high = source.GetElementSizeMinValue(), source.GetElementSizeMaxValue()
    source.SetElementSize(within("the element size", element_size, low, high))
    low, high = source.GetAspectRatioMinValue(), source.GetAspectRatioMaxValue()
    source.SetAspectRatio(within("the aspect ratio", aspect_ratio, low, high))
    low, high = source.GetLayerWidthMinValue(), source.GetLayerWidthMaxValue()
    source.SetLayerWidth(within("the layer width", layer_width, low, high))
    set_time_limit(source, time_limit)
    run(source, messages)
    return source.GetOutputDataObject(1 if deformed_boundary else 0)


# --- the shell ----------------------------------------------------------------------------------------------


def add_commands(commands: Any) -> None:
    """Add `domain` to the subparsers of the command line."""
    parser = _commands.add_command(
        commands, "domain", _run_domain, "mesh a domain of the dissertation", threads=False,
        example="cylinder --cells 2000 -o cylinder.vtu",
        details="Moving domains have the motion of their boundary as a point array.",
    )
    parser.add_argument("name", choices=domains(), metavar="NAME", help=", ".join(domains()))
    parser.add_argument("--cells", type=int, default=0, help="approximate number (default: that of the example)")
    parser.add_argument("--amount", type=float, default=1.0, help="fraction of the boundary's motion (default: 1)")
    parser.add_argument("--element-size", type=float, default=0.1, help="square: leg of the isotropic triangle")
    parser.add_argument("--aspect-ratio", type=float, default=1.0, help="square: ratio of the legs")
    parser.add_argument("--layer-width", type=float, default=0.2,
                        help="square: width of the interaction layer (collar)")  # fmt: skip
    parser.add_argument("--deformed-boundary", action="store_true", help="the moved boundary instead of the mesh")
    _commands.add_time_limit(parser)
    _commands.add_output(parser)


def _run_domain(arguments: argparse.Namespace) -> None:
    names = ("cells", "amount", "element_size", "aspect_ratio", "layer_width", "deformed_boundary", "time_limit")
    mesh = domain(arguments.name, **_commands.given(arguments, names))
    _commands.finish(arguments, mesh, _commands.counts(mesh))
