# SPDX-License-Identifier: BSD-3-Clause
"""The HTML report of the study `all`: one file with its pictures."""

from __future__ import annotations

import base64
import re
import struct
import zlib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from html import escape
from pathlib import Path
from typing import Iterable

import numpy as np

from ._report import pyplot
from ._inventory import ENTRIES, SECTIONS, Entry
from ._verdicts import DOES_NOT_HOLD, HOLDS, NOT_DECIDED, TOO_SMALL

_CLASSES = {HOLDS: "yes", DOES_NOT_HOLD: "no", NOT_DECIDED: "open", TOO_SMALL: "open"}
#: Shades of a channel in pictures, so that their colors are at most 256.
_SHADES = 6
_STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #202020 }
table { border-collapse: collapse; margin: 0.5em 0; display: block; overflow-x: auto }
td, th { border: 1px solid #ccc; padding: 2px 8px; text-align: left; vertical-align: top }
pre { overflow-x: auto; font-size: 12px; background: #f6f6f6; padding: 6px }
img { max-width: 100%; display: block; margin: 0.5em 0 } h3 { margin: 1.5em 0 0.3em }
.yes { color: #106010 } .no { color: #a01010 } .open { color: #705000 } .small { color: #606060; font-size: 13px }
"""


@dataclass(frozen=True)
class Study:
    """What a study wrote, or why it failed."""

    name: str
    text: str
    folder: Path
    findings: list[dict[str, str]]
    error: str = ""


def page(studies: dict[str, Study], small: bool, width: int) -> str:
    """The report."""
    parts = [f"<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>Tautline: studies</title>"
             f"<style>{_STYLE}</style></head><body><h1>Studies of the dissertation</h1>", _introduction(studies, small),
             _overview(studies), "<h2>Tables and figures</h2>"]
    shown: dict[str, set[str]] = {name: set() for name in studies}
    pictures: dict[Path, str] = {}
    for entry in ENTRIES:
        if entry.study in studies:
            parts.append(_entry(entry, studies, shown[entry.study], pictures, width))
    parts.append("<h2>Further findings and tables, by study</h2>")
    parts += [_rest(study, shown[name], pictures, width) for name, study in studies.items()]
    return "\n".join([*parts, _sections(), "</body></html>\n"])


def references(text: str) -> set[str]:
    """The tables and figures that a text names: "Tables 2.9 and 2.12, Figure 4.7 (a)" has three."""
    found = set()
    for kind, numbers in re.findall(r"(Table|Figure)s?((?:(?:, | and | to |/| )?\d\.\d+(?: \([a-z]\))?)+)", text):
        parts = re.findall(r"( to )?(\d)\.(\d+)", numbers)
        last = 0
        for joined, chapter, number in parts:
            for n in range(last + 1 if joined else int(number), int(number) + 1):
                found.add(f"{kind} {chapter}.{n}")
            last = int(number)
    return found


def _introduction(studies: dict[str, Study], small: bool) -> str:
    verdicts = [row["verdict"] for study in studies.values() for row in study.findings]
    counts = ", ".join(f"{word}: {verdicts.count(word)}" for word in _CLASSES if word in verdicts)
    text = (f"<p>{len(studies)} studies, {len(verdicts)} findings ({counts}). Of each table and figure: our numbers "
            "with the dissertation's in brackets or in columns of their own, what the dissertation states with our "
            "verdict, and our pictures. Times are CPU seconds; differences within their noise are not decided.</p>")
    if small:
        text += ("<p><b>This is the small size</b>: meshes of some thousand cells, which show the layout and decide "
                 "only what does not depend on size. <code>python3 -m tautline study all --out DIR</code> runs the "
                 "studies in full, which takes hours.</p>")
    failed = [f"<li>{escape(s.name)}: {escape(s.error)}</li>" for s in studies.values() if s.error]
    return text + (f"<p>Failed:</p><ul>{''.join(failed)}</ul>" if failed else "")


def _overview(studies: dict[str, Study]) -> str:
    rows = []
    for entry in ENTRIES:
        study = studies.get(entry.study)
        words = _words(_findings_of(entry, studies)) if study else "not run"
        rows.append(f"<tr><td><a href='#{_anchor(entry.name)}'>{entry.name}</a></td><td>{escape(entry.caption)}</td>"
                    f"<td>{entry.study}</td><td>{words}</td></tr>")
    return ("<h2>Overview</h2><table><tr><th>in the dissertation</th><th>content</th><th>study</th>"
            "<th>findings</th></tr>" + "".join(rows) + "</table>")


def _words(rows: Iterable[dict[str, str]]) -> str:
    verdicts = [row["verdict"] for row in rows]
    return ", ".join(f"<span class='{_CLASSES[word]}'>{word}: {verdicts.count(word)}</span>"
                     for word in _CLASSES if word in verdicts) or "-"


def _anchor(name: str) -> str:
    return name.lower().replace(" ", "-").replace(".", "-")


def _findings_of(entry: Entry, studies: dict[str, Study]) -> list[dict[str, str]]:
    """The findings about a table or figure, of any study, and those of its own study on its section."""
    return [row for study in studies.values() for row in study.findings
            if entry.name in references(row["source"])
            or (study.name == entry.study and set(entry.sections) & set(re.split(r"[, ]+", row["source"])))]


def _entry(entry: Entry, studies: dict[str, Study], shown: set[str], pictures: dict[Path, str], width: int) -> str:
    study = studies[entry.study]
    parts = [f"<h3 id='{_anchor(entry.name)}'>{entry.name}: {escape(entry.caption)}</h3>"
             f"<p class='small'>Study {entry.study}</p>", _table(_findings_of(entry, studies))]
    for file, text in _tables(study.folder, study.name):
        if file not in shown and any(fnmatchcase(file, pattern) for pattern in entry.files):
            shown.add(file)
            parts.append(f"<pre>{escape(text)}</pre>")
    for path in sorted(study.folder.glob("*.png")):
        if any(fnmatchcase(path.stem, pattern) for pattern in entry.files):
            if path in pictures:
                parts.append(f"<p class='small'>Picture: see <a href='#{pictures[path]}'>above</a>.</p>")
            else:
                pictures[path] = _anchor(entry.name)
                parts.append(_picture(path, width))
    return "\n".join(parts)


def _rest(study: Study, shown: set[str], pictures: dict[Path, str], width: int) -> str:
    """What a study has beyond tables and figures."""
    there = [row for entry in ENTRIES for row in _findings_of(entry, {study.name: study})]
    findings = [row for row in study.findings if row not in there]
    texts = [text for file, text in _tables(study.folder, study.name) if file not in shown]
    images = [_picture(path, width) for path in sorted(study.folder.glob("*.png")) if path not in pictures]
    if not (findings or texts or images or study.error):
        return ""
    return "\n".join([f"<h3 id='{study.name}'>{study.name}</h3><p>{escape(study.text)}</p>",
                      f"<p class='no'>{escape(study.error)}</p>" if study.error else "", _table(findings),
                      *(f"<pre>{escape(text)}</pre>" for text in texts), *images])


def _table(rows: list[dict[str, str]]) -> str:
    if not rows:
        return ""
    lines = "".join(f"<tr><td>{escape(r['source'])}</td><td>{escape(r['finding'])}</td><td class='"
                    f"{_CLASSES[r['verdict']]}'>{r['verdict']}</td><td>{escape(r['figures'])}</td></tr>" for r in rows)
    return ("<table><tr><th>where</th><th>the dissertation states</th><th>verdict</th><th>our numbers</th></tr>"
            f"{lines}</table>")


def _tables(folder: Path, name: str) -> list[tuple[str, str]]:
    """The tables in the text of a study, each with the name of its file."""
    path = folder / f"{name}.txt"
    if not path.is_file():
        return []
    parts = path.read_text(encoding="utf-8").split("\n\n")
    return [(found.group(1), part) for part in parts for found in [re.match(r".*\[([^\]]+)\.csv\]\n", part)] if found]


def _picture(path: Path, width: int) -> str:
    """A picture of at most a width, with few shades."""
    if pyplot is None:
        return ""
    image = pyplot.imread(path)[..., :3]
    step = max(1, -(-image.shape[1] // width))
    rows, columns = (n // step * step for n in image.shape[:2])
    image = image[:rows, :columns].reshape(rows // step, step, columns // step, step, 3).mean(axis=(1, 3))
    shades = np.round(image * (_SHADES - 1)).astype(int)
    data = base64.b64encode(_png(shades @ [_SHADES * _SHADES, _SHADES, 1])).decode()
    return f"<img alt='{escape(path.stem)}' src='data:image/png;base64,{data}'>"


def _png(codes: np.ndarray) -> bytes:
    """A PNG file of an image [row, column] of colors, (red * _SHADES + green) * _SHADES + blue, with a palette."""
    colors, indices = np.unique(codes, return_inverse=True)
    rows = indices.reshape(codes.shape).astype(np.uint8)
    rows = np.concatenate([np.zeros((len(rows), 1), np.uint8), rows], axis=1)  # filter 0 before each row
    step = 255 // (_SHADES - 1)
    palette = b"".join(bytes(int(c) // power % _SHADES * step for power in (_SHADES * _SHADES, _SHADES, 1))
                       for c in colors)
    header = struct.pack(">IIBBBBB", codes.shape[1], codes.shape[0], 8, 3, 0, 0, 0)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return b"".join([b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", header), chunk(b"PLTE", palette),
                     chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)), chunk(b"IEND", b"")])


def _sections() -> str:
    rows = "".join("<tr>" + "".join(f"<td>{escape(part)}</td>" for part in row) + "</tr>" for row in SECTIONS)
    return ("<h2>Where the sections are in Tautline</h2><table><tr><th>section</th><th>subject</th><th>in ParaView; in "
            f"Python</th><th>studies</th></tr>{rows}</table>")
