# SPDX-License-Identifier: BSD-3-Clause
"""The wording that tests expect of messages, from Testing/wording.json, where an editor changes it."""

import json
from functools import cache
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "wording.json"


@cache
def _texts() -> dict:
    return json.loads(FILE.read_text(encoding="utf-8"))


def wording(key: str) -> str:
    """The text with an id. Raises KeyError if there is none."""
    return _texts()[key]
