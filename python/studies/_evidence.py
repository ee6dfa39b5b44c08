# SPDX-License-Identifier: BSD-3-Clause
"""The committed findings of all studies: the options that they were run with, and what they wrote."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._findings import Finding
from ._verdicts import HOLDS

#: Where the findings are: a file per study, and the reasons that were found after the runs.
FOLDER = Path(__file__).resolve().parent / "evidence"
REASONS = "reasons"


@dataclass(frozen=True)
class Size:
    """The options of a study in the committed run, and why they ask for less than the dissertation has, if they do."""

    options: tuple[str, ...] = ()
    reduced: str = ""


_SOLVERS = ("the dissertation has 500,000 vertices; many combinations, or elasticity, take hours there: for statements "
            "about large systems, see solver_orders and solver_restart")
_ELASTICITY = ("elasticity is solved on up to 50,000 vertices, of 500,000: its systems take ten times as long "
               "as scalar ones")
_SHAPES = "the dissertation has 1,000,000 elements; the times of both studies are compared by their ratios"
_SEEDS = ("--seeds", "3")
#: By study, where it is not the full size without options.
SIZES: dict[str, Size] = {
    "bore": Size(("--seeds", "2")),
    "box_rotation": Size(("--repeats", "1")),
    "deformation": Size((*_SEEDS, "--repeats", "3")),
    "deformation_methods": Size(("--seeds", "2", "--repeats", "1")),
    "hydrocephalus": Size(_SEEDS),
    "local_coefficients": Size(("--seeds", "5")),
    "mesh_independence": Size(("--size", "100K"), _SOLVERS),
    "shape_interpolation": Size(("--cells", "250000"), _SHAPES),
    "shape_size": Size(("--cells", "250000"), _SHAPES),
    "shape_size_untangling": Size(_SEEDS),
    "shape_untangling": Size((*_SEEDS, "--no-large")),
    "shapes": Size(("--weights", "0.3"), "the weight is not stated: two of the four that the study tries"),
    "smoothing_times": Size(("--cells", "100000"), "the sweep over the shares of the reduction takes hours"),
    "solver_coefficients": Size(("--size", "20K"), _SOLVERS),
    "solver_metrics": Size(("--size", "200K", "--elasticity-size", "20K"), _SOLVERS),
    "solver_orders": Size(("--elasticity-size", "50K"), _ELASTICITY),
    "solver_perturbation": Size(("--size", "100K", "--elasticity-size", "50K"), _SOLVERS),
    "solver_restart": Size(("--elasticity-size", "50K"), _ELASTICITY),
    "target_matrices": Size(("--seeds", "5")),
    "time_stepping": Size(("--size", "20K"), "100 time steps by 8 combinations on 500,000 vertices take hours"),
}


_LATER = "it was not run yet; what it states is this project's"
_ALONE = "it was not run yet alone on a machine, which its times need; what it states is this project's"
#: Studies that are not in the committed report, and why.
PENDING: dict[str, str] = {
    **dict.fromkeys(("box_rotation", "deformation_methods", "solver_meshes"), _LATER),
    **dict.fromkeys(("rank_scaling", "thread_scaling", "time_stepping"), _ALONE),
    "shapes": "it was not run yet on Kimia's silhouettes at the size of the set",
}


def size_of(study: str) -> Size:
    """The options of a study in the committed run."""
    return SIZES.get(study, Size())


def read(file: Path) -> dict[str, Any] | None:
    """The JSON output of a study; None if it did not run."""
    return json.loads(file.read_text(encoding="utf-8")) if file.is_file() else None


def committed(study: str) -> dict[str, Any] | None:
    """The committed results of a study, if there are any."""
    return read(FOLDER / f"{study}.json")


def findings(record: dict[str, Any] | None) -> list[Finding]:
    """The findings of a study, with the reasons that were found after its run."""
    found = [Finding.of(row) for row in record["findings"]] if record else []
    known = (read(FOLDER / f"{REASONS}.json") or {}).get(record["study"] if record else "", [])
    return [explained(finding, known) for finding in found]


def explained(finding: Finding, known: list[dict[str, str]]) -> Finding:
    """The finding with its reason; a reason belongs to a claim and a verdict, at all places or at one."""
    if finding.verdict == HOLDS:
        return finding
    for entry in known:
        if (entry["claim"], entry["verdict"]) == (finding.claim, finding.verdict) \
                and entry.get("source", finding.source) == finding.source:
            return Finding(**{**finding.__dict__, "reason": "; ".join(filter(None, (entry["reason"], finding.reason)))})
    return finding


def minutes(study: str) -> float | None:
    """CPU minutes of the committed run; None where there is none."""
    record = committed(study)
    return record["seconds"] / 60 if record else None
