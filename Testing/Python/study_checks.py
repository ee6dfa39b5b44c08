# SPDX-License-Identifier: BSD-3-Clause
"""Runs studies in the small size and checks the files that they write."""

import contextlib
import csv
import io
import math
import shutil
from pathlib import Path

from tautline import __main__ as command_line
from tautline.studies import _evidence, _report, _verdicts
from wrong_data import Recorder, check_verdicts

SMALLEST_PICTURE = 5000  # bytes; an empty one has fewer


class Studies:
    """Studies with a directory for their output, which is emptied first."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        #: By study the arguments with which its findings were stated.
        self.calls: dict = {}
        shutil.rmtree(directory, ignore_errors=True)

    def run(self, study: str, *options: str) -> str:
        """Run a study in the small size; what it prints."""
        recorder = Recorder(study)
        with contextlib.redirect_stdout(io.StringIO()) as printed, recorder:
            assert command_line.main(["study", study, "--small", "--out", str(self.directory / study), *options]) == 0
        self.calls[study] = recorder.calls
        return printed.getvalue()

    def rows(self, study: str, table: str) -> list:
        """The rows of a table as dicts of texts."""
        with open(self.directory / study / f"{table}.csv", encoding="utf-8", newline="") as stream:
            return list(csv.DictReader(stream))

    def column(self, study: str, table: str, head: str, name: str) -> dict:
        """The numbers of a column by the row's label."""
        return {row[head]: float(row[name]) for row in self.rows(study, table)}

    def check(self, study: str, findings: int, pictures: tuple, tables: dict, others=()) -> None:
        """Check the number of findings, the pictures, the number of rows of tables, and that numbers are finite.

        others: calls of the functions that state findings, with numbers that change verdicts.
        """
        folder = self.directory / study
        for table, count in tables.items():
            rows = self.rows(study, table)
            assert len(rows) == count, f"{study}/{table}: {len(rows)} rows, not {count}"
        for file in folder.glob("*.csv"):
            for row in self.rows(study, file.stem):
                for name, value in row.items():
                    with contextlib.suppress(ValueError):
                        assert math.isfinite(float(value)), f"{file.name}: {name} is {value}"
        found = self.rows(study, "findings")
        assert len(found) == findings, f"{study}: {len(found)} findings, not {findings}"
        assert {row["verdict"] for row in found} <= set(_verdicts.WORDS)
        assert all(row["ours"] and row["claim"] for row in found)
        assert all(row["criterion"] for row in found if row["verdict"] in (_verdicts.HOLDS, _verdicts.DOES_NOT_HOLD)), (
            "a small mesh decides only what has a proof")
        text = (folder / f"{study}.txt").read_text(encoding="utf-8")
        for verdict in _verdicts.WORDS:
            assert text.count(f"- {verdict.upper()} (") == sum(row["verdict"] == verdict for row in found), verdict
        record = _evidence.read(folder / f"{study}.json")
        assert [finding.row() for finding in _evidence.findings(record)] == record["findings"]
        assert {"tautline", "vtk", "numpy"} <= set(record["versions"]) and record["options"]["small"]
        check_verdicts(study, self.calls[study], self.directory / "wrong_data", others)
        for picture in pictures if _report.pyplot else ():
            assert (folder / f"{picture}.png").stat().st_size > SMALLEST_PICTURE, f"{study}/{picture}.png is empty"


def rejected_command(text: str, *arguments: str, code: int = 1) -> None:
    """Check that a command fails with a text on stderr."""
    with contextlib.redirect_stderr(io.StringIO()) as printed:
        assert command_line.main(list(arguments)) == code
    assert text in printed.getvalue(), printed.getvalue()


def pictures() -> str:
    """Whether pictures were checked."""
    return "pictures" if _report.pyplot else "no pictures: matplotlib is missing"
