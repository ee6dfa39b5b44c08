# SPDX-License-Identifier: BSD-3-Clause
"""Findings of the studies: the statement, its criterion, and the verdict from all seeds."""

from __future__ import annotations

import math
import re
from dataclasses import asdict, dataclass
from typing import Any, Iterable, Sequence

from ._verdicts import DOES_NOT_HOLD, HOLDS, NOT_DECIDED, TOO_SMALL, VARIES, WORDS

_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?")


@dataclass(frozen=True)
class Finding:
    """A statement, judged by our numbers."""

    #: The table, figure or section that states it.
    source: str
    claim: str
    #: The condition on our numbers, chosen before they were computed.
    criterion: str
    #: The dissertation's number, if it has one.
    stated: str
    ours: str
    verdict: str
    #: Why it does not hold, varies or is not decided.
    reason: str
    #: Whether it is this project's statement, not the dissertation's.
    own: bool
    #: The seeds of the random numbers; none: nothing is random.
    seeds: tuple[int, ...] = ()

    @property
    def key(self) -> tuple[str, str]:
        """The common key of the findings of several seeds."""
        return self.source, self.claim

    def row(self) -> dict[str, Any]:
        """The finding as JSON."""
        return {**asdict(self), "seeds": list(self.seeds)}

    @staticmethod
    def of(row: dict[str, Any]) -> Finding:
        """The reverse of row()."""
        return Finding(**{**row, "seeds": tuple(row["seeds"])})


#: The columns of findings.csv.
COLUMNS = ("source", "claim", "kind", "verdict", "stated", "ours", "criterion", "reason", "seeds")


def columns(finding: Finding) -> list[str]:
    """The row of a finding in findings.csv."""
    return [finding.source, finding.claim, "own" if finding.own else "dissertation", finding.verdict, finding.stated,
            finding.ours, finding.criterion, finding.reason, " ".join(map(str, finding.seeds))]


def merged(findings: Iterable[Finding], seeds: int = 1) -> list[Finding]:
    """One finding for the findings of several seeds with the same source and claim, in order of first appearance."""
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        groups.setdefault(finding.key, []).append(finding)
    return [_merge(group, seeds) for group in groups.values()]


def _merge(group: Sequence[Finding], seeds: int) -> Finding:
    """The finding of several seeds.

    Among the seeds that decide it: it holds if it holds with each, does not hold if it holds with none, and otherwise
    varies. It is not decided if half of all seeds do not decide it.
    """
    first = group[0]
    if seeds == 1 or not first.seeds:
        return first
    words = [finding.verdict for finding in group]
    holding, failing = words.count(HOLDS), words.count(DOES_NOT_HOLD)
    decided = holding + failing + words.count(VARIES)
    if TOO_SMALL in words:
        verdict = TOO_SMALL
    elif 2 * decided <= seeds:
        verdict = NOT_DECIDED
    else:
        verdict = HOLDS if holding == decided else DOES_NOT_HOLD if failing == decided else VARIES
    share = "; ".join(f"{word} with {words.count(word)} of {seeds} seeds" for word in WORDS if word in words)
    mixed = len(set(words)) > 1 or len(group) < seeds
    reasons = [finding.reason for finding in group if finding.reason and finding.verdict == verdict]
    reasons += [finding.reason for finding in group if finding.reason] if verdict in (VARIES, NOT_DECIDED) else []
    reason = "; ".join(([share] if mixed else []) + reasons[:1]) if verdict not in (HOLDS, TOO_SMALL) else ""
    ours = spread({finding.seeds[0]: finding.ours for finding in group})
    return Finding(first.source, first.claim, first.criterion, first.stated,
                   ours if verdict == TOO_SMALL else f"{ours} ({share})", verdict, reason, first.own,
                   tuple(seed for finding in group for seed in finding.seeds))


def spread(texts: dict[int, str]) -> str:
    """One text of the texts of several seeds that differ in their numbers: the median and the range of each number.

    Texts that also differ in words follow one another.
    """
    first = next(iter(texts.values()))
    if len(set(texts.values())) == 1:
        return first
    parts = [_NUMBER.split(text) for text in texts.values()]
    if any(part != parts[0] for part in parts):
        return " | ".join(f"seed {seed}: {text}" for seed, text in texts.items())
    made = [parts[0][0]]
    for numbers, after in zip(zip(*(_NUMBER.findall(text) for text in texts.values())), parts[0][1:]):
        made += [number_range(numbers), after]
    return "".join(made)


def number_range(texts: Sequence[str]) -> str:
    """The median of numbers, and in brackets the smallest and the largest one, each as it is written.

    An even number of them has no middle one: then only the range.
    """
    ordered = sorted(texts, key=_value)
    if ordered[0] == ordered[-1]:
        return ordered[0]
    ends = f"{ordered[0]} to {ordered[-1]}"
    return f"{ordered[len(ordered) // 2]} [{ends}]" if len(ordered) % 2 else f"[{ends}]"


def _value(text: str) -> float:
    try:
        return float(text.replace(",", ""))
    except ValueError:
        return math.inf
