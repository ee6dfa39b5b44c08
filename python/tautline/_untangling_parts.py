# SPDX-License-Identifier: BSD-3-Clause
"""The result of untangle()."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import Any, ClassVar

from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import _commands
from ._arguments import pick, sets
from ._arrays import Array, cell_array, history_of, point_array, table_rows
from ._choices import UNTANGLE_EFFORTS, UntangleEffort
from ._errors import Error
from ._results import Result


@dataclass(frozen=True, repr=False, eq=False)
class UntangleResult(Result):
    """The result of untangle(). For composite data, numbers cover all blocks.

    Attributes
    ----------
    mesh : vtkDataObject
        The mesh with the new points, `Displacement`, `Validity` and `Obstacle`.
    history : dict[str, Any]
        Per iteration (0 is the input): iteration, objective (the energy), inverted, gradient_norm, moving, seconds; for
        composite data also block.
    validity : Array
        Per cell, m: 1 valid, 0 degenerate, -1 inverted, -2 not measured, -3 not finite.
    obstacle : Array
        Per cell, m, why it is not valid: 0 it is valid, 1 the iterations ended, 2 all its points are fixed, 3 no
        position between the fixed points around makes it valid, 4 a fixed point is not finite.
    inverted_before, inverted, impossible : int
        Number of inverted or degenerate elements before and after, and of elements that fixed points make infeasible.
    reason : str
        The stopping criterion that ended the run.
    displacement : Array
        New minus old position, n x 3.
    summary : str
        The result in words: which elements remain invalid, where and why.
    """

    _per_element: ClassVar[tuple[str, ...]] = ("validity", "obstacle", "displacement")
    mesh: vtkDataObject
    history: dict[str, Any]
    validity: Array
    obstacle: Array
    inverted_before: int
    inverted: int
    impossible: int
    reason: str
    displacement: Array
    summary: str


@sets("untangle", "Effort")
def choose_effort(filter_: Any, preset: UntangleEffort = "normal", effort: UntangleEffort | None = None) -> None:
    """Choose the effort.

    preset: "local", "normal" or "thorough": points around the inverted elements only; then all points; or
        longer, from several starts.
    effort: another name of the preset.
    """
    if effort is not None and preset != "normal":
        raise Error(f"preset and effort mean the same, {preset!r} and {effort!r} are given")
    filter_.SetEffort(pick("preset" if effort is None else "effort", effort or preset, UNTANGLE_EFFORTS))


def untangle_result(filter_: Any, output: vtkDataObject) -> UntangleResult:
    """The result of a filter that has run."""
    return UntangleResult(
        mesh=output,
        history=history_of(filter_),
        validity=cell_array(output, "Validity"),
        obstacle=cell_array(output, "Obstacle"),
        inverted_before=filter_.GetInvertedBefore(),
        inverted=filter_.GetInvertedAfter(),
        impossible=filter_.GetImpossible(),
        reason=filter_.GetReason(),
        displacement=point_array(output, "Displacement"),
        summary=filter_.GetSummary(),
    )


# --- the shell ----------------------------------------------------------------------------------------------


def add_untangle_options(parser: argparse.ArgumentParser) -> None:
    """Add the option of the effort."""
    parser.add_argument("--preset", choices=UNTANGLE_EFFORTS, default="normal",
                        help="points around the inverted elements; then all; or longer (default: normal)")  # fmt: skip
    parser.add_argument("--effort", choices=UNTANGLE_EFFORTS, help=argparse.SUPPRESS)


def untangle_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """The values of these options."""
    return _commands.given(arguments, ("preset", "effort"))


def finish_untangle(arguments: argparse.Namespace, result: UntangleResult) -> int:
    """Print the result of the command."""
    _commands.finish(arguments, result, result.summary, table_rows(result.history))
    return 1 if result.inverted else 0
