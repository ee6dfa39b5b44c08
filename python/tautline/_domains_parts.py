# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of domain() that are not one property each; and the function domains."""

from __future__ import annotations

import argparse
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkDataSet

from . import _commands, _vtk
from ._arguments import flag
from ._errors import checked
from ._names import find_name
from ._views import viewed


@checked
def domains() -> list[str]:
    """The names of the domains, for domain().

    Returns
    -------
    list[str]
    """
    source = _vtk.vtkDomainSource
    return [source.GetDomainName(i) for i in range(source.GetNumberOfDomains())]


def domain_input(filter_: Any, name: str) -> None:
    """Choose the domain.

    name: one of domains().
    """
    filter_.SetDomainByName(find_name(name, domains()) or str(name))


def domain_result(filter_: Any, mesh: vtkDataSet, deformed_boundary: bool = False) -> vtkDataSet:
    """The output of a source that has run.

    deformed_boundary: return the moved boundary instead of the mesh.
    """
    return viewed(filter_.GetOutputDataObject(1)) if flag("deformed_boundary", deformed_boundary) else mesh


# --- the shell ----------------------------------------------------------------------------------------------


def add_domain_options(parser: argparse.ArgumentParser) -> None:
    """Add the name, and the option of the boundary."""
    parser.add_argument("name", choices=domains(), metavar="NAME", help=", ".join(domains()))
    parser.add_argument("--deformed-boundary", action="store_true", help="the moved boundary instead of the mesh")


def domain_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("deformed_boundary",))


def finish_domain(arguments: argparse.Namespace, mesh: vtkDataSet) -> None:
    """Print the result of the command."""
    _commands.finish(arguments, mesh, _commands.counts(mesh))
