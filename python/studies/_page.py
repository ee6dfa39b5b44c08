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
from typing import Any, Callable, Iterable, Sequence

import numpy as np

from . import _evidence
from ._findings import Finding
from ._inventory import CHAPTERS, ENTRIES, NOT_MADE, SECTIONS, Entry
from ._report import pyplot
from ._verdicts import DOES_NOT_HOLD, HOLDS, NOT_DECIDED, TOO_SMALL, VARIES, WORDS

_CLASSES = {HOLDS: "yes", DOES_NOT_HOLD: "no", VARIES: "open", NOT_DECIDED: "open", TOO_SMALL: "open"}
#: Shades of a channel in pictures, so that their colors are at most 256; 255 is a multiple of one less.
_SHADES = 6
_STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #202020 }
table { border-collapse: collapse; margin: 0.5em 0; display: block; overflow-x: auto }
td, th { border: 1px solid #ccc; padding: 2px 8px; text-align: left; vertical-align: top }
.numbers { font-size: 13px } .numbers td { text-align: right } .numbers td:first-child { text-align: left }
caption { text-align: left; font-weight: bold }
img { max-width: 100%; display: block; margin: 0.5em 0 } h3 { margin: 1.5em 0 0.3em }
.yes { color: #106010 } .no { color: #a01010 } .open { color: #705000 } .small { color: #606060; font-size: 13px }
"""


@dataclass(frozen=True)
class Study:
    """The output of a study, or why it failed."""

    name: str
    text: str
    record: dict[str, Any] | None
    #: The pictures by the names of their files, as elements of the page.
    pictures: dict[str, str]
    error: str = ""

    @property
    def findings(self) -> list[Finding]:
        return _evidence.findings(self.record)

    @property
    def parts(self) -> list[dict[str, Any]]:
        """Its paragraphs and tables."""
        return self.record["parts"] if self.record else []


def embedded(label: str, data: bytes) -> str:
    """An element with the picture itself."""
    return f"<img alt='{escape(label)}' src='data:image/png;base64,{base64.b64encode(data).decode()}'>"


def study_in(name: str, text: str, folder: Path, width: int, show: Callable[[str, bytes], str] = embedded) -> Study:
    """The output of a study in a folder; its pictures have at most a width.

    show: makes an element of a label, STUDY/FILE, and a PNG file.
    """
    pictures = {path.stem: show(f"{name}/{path.stem}", _picture(path, width)) for path in sorted(folder.glob("*.png"))
                if pyplot is not None}
    return Study(name, text, _evidence.read(folder / f"{name}.json"), pictures)


def study_of(name: str, text: str, report: str) -> Study:
    """The committed results of a study; its pictures are taken from a report."""
    found = {match.group(1): match.group() for match in re.finditer(rf"<img alt='{name}/([^']+)' [^>]*>", report)}
    pictures = {file: found[file] for file in sorted(found)}
    return Study(name, text, _evidence.committed(name), pictures)


def page(studies: dict[str, Study], small: bool) -> str:
    """The report."""
    return "".join([*_parts(studies, small), _END])


def pages(studies: dict[str, Study], second: str) -> tuple[str, str]:
    """The report in two files: the second one, of this name, has everything beyond tables and figures."""
    parts = _parts(studies, small=False, second=second)
    return "".join([*parts[:1], *parts[2:], _END]), "".join([_head("methods and further tables"), parts[1], _END])


_END = "\n</body></html>\n"


def _head(title: str) -> str:
    return (f"<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>Tautline: studies</title>"
            f"<style>{_STYLE}</style></head><body><h1>Studies of the dissertation: {title}</h1>")


def _parts(studies: dict[str, Study], small: bool, second: str = "") -> tuple[str, str, str]:
    """The summary, tables and figures; further results of the studies; the lists at the end.

    second: the file with everything beyond.
    """
    parts = [_head("what holds"), _introduction(studies, small), _summary(studies), _runs(studies), _overview(studies),
             "<h2>Tables and figures</h2>"]
    shown: dict[str, set[str]] = {name: set() for name in studies}
    pictures: dict[tuple[str, str], str] = {}
    listed: dict[tuple[str, str], str] = {}
    for entry in ENTRIES:
        if entry.study in studies and studies[entry.study].record:
            parts.append(_entry(entry, studies, shown[entry.study], pictures, listed, second))
    rest = [_rest(study, shown[name], pictures) for name, study in studies.items() if study.record or study.error]
    beyond = "\n".join(["", "<h2>Methods, further findings and tables, by study</h2>", *rest])
    return "\n".join(parts), beyond, "\n".join(["", _not_made(), _sections()])


def chapter(source: str) -> int:
    """The chapter of a table, figure or section; 0 if the text names none."""
    found = re.search(r"(?<![\d.])([1-6])(?:\.\d|\b)", source)
    return int(found.group(1)) if found else 0


def by_chapter(studies: Iterable[Study]) -> dict[int, list[Finding]]:
    """The findings about the dissertation by chapter, and our own as chapter 0."""
    groups: dict[int, list[Finding]] = {number: [] for number in CHAPTERS}
    for study in studies:
        for finding in study.findings:
            groups[0 if finding.own else chapter(finding.source)].append(finding)
    return groups


def summary_markdown(studies: Iterable[Study]) -> str:
    """The numbers of findings by chapter and verdict, as a table in Markdown."""
    rows = [["chapter", *WORDS[:-1]], ["---"] * len(WORDS)]
    rows += [[CHAPTERS[number], *map(str, counts(found))] for number, found in by_chapter(studies).items() if found]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def counts(findings: Sequence[Finding]) -> list[int]:
    """The numbers of findings by verdict, in the order of WORDS; those too small to decide are not decided."""
    words = [finding.verdict for finding in findings]
    return [words.count(word) + (words.count(TOO_SMALL) if word == NOT_DECIDED else 0) for word in WORDS[:-1]]


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
    text = ("<p>The dissertation is on optimization-based meshing: quality metrics and solvers (chapter 2), several "
            "objectives (3), nonlocal models and moving meshes (4), shape matching (5). For each table and figure: our "
            "numbers with the dissertation's in brackets or in columns of their own, what the dissertation states with "
            "our verdict, and our pictures. Meshes are this project's. A finding holds, does not hold, varies with the "
            "seed of the random numbers or with what is not stated, or is not decided: times differ by less than their "
            "noise, a run failed, or a number is missing. Times are CPU seconds.</p>")
    if small:
        text += ("<p><b>This is the small size</b>: meshes of some thousand cells, which show the layout and decide "
                 "only what does not depend on size. <code>python3 -m tautline study all --record --out DIR</code> "
                 "runs the studies at the sizes of the committed report, which takes hours.</p>")
    failed = [f"<li>{escape(s.name)}: {escape(s.error)}</li>" for s in studies.values() if s.error]
    return text + (f"<p>Failed:</p><ul>{''.join(failed)}</ul>" if failed else "")


def _summary(studies: dict[str, Study]) -> str:
    """Per chapter how many findings hold, and each that does not, with its reason."""
    groups = by_chapter(studies.values())
    head = "".join(f"<th>{word}</th>" for word in WORDS[:-1])
    rows = "".join(f"<tr><td>{escape(CHAPTERS[number])}</td>{''.join(f'<td>{n}</td>' for n in counts(found))}</tr>"
                   for number, found in groups.items() if found)
    parts = [f"<h2><a name=\"summary\"></a>Summary</h2><table><tr><th>chapter</th>{head}</tr>{rows}</table>"]
    for number, found in groups.items():
        others = [finding for finding in found if finding.verdict not in (HOLDS, TOO_SMALL)]
        if others:
            lines = "".join(
                f"<tr><td>{escape(f.source)}</td><td>{escape(f.claim)}</td><td class='{_CLASSES[f.verdict]}'>"
                f"{f.verdict}</td><td>{escape(f.reason)}</td></tr>" for f in others)
            parts.append(f"<h3>{escape(CHAPTERS[number])}: what does not hold, varies or is not decided</h3><table><tr>"
                         f"<th>where</th><th>statement</th><th>verdict</th><th>reason</th></tr>{lines}</table>")
    return "\n".join(parts)


def _runs(studies: dict[str, Study]) -> str:
    """The options, date, versions and time of each study."""
    rows = []
    for study in studies.values():
        if study.record:
            options = ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in study.record["options"].items()
                                if value is not False and value != [])
            versions = ", ".join(f"{key} {value}" for key, value in study.record["versions"].items())
            small = study.record["options"].get("small")
            reduced = "" if small else _evidence.size_of(study.name).reduced
            spent = f"{study.record['seconds'] / 60:.1f}"
            cells = (study.name, options, reduced, study.record["date"], spent, versions)
            rows.append("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>")
    rows += [f"<tr><td>{name}</td><td colspan='5'>not in this report: {escape(reason)}</td></tr>"
             for name, reason in _evidence.PENDING.items()
             if name in studies and not studies[name].record and not studies[name].error]
    return ("<h2>Runs</h2><table><tr><th>study</th><th>options</th><th>why it is reduced</th><th>date</th>"
            f"<th>CPU minutes</th><th>versions</th></tr>{''.join(rows)}</table>")


def _overview(studies: dict[str, Study]) -> str:
    rows = []
    for entry in ENTRIES:
        study = studies.get(entry.study)
        known = study is not None and study.record is not None
        words = _words(_findings_of(entry, studies)) if known else "not run"
        name = f"<a href='#{_anchor(entry.name)}'>{entry.name}</a>" if known else entry.name
        rows.append(f"<tr><td>{name}</td><td>{escape(entry.caption)}</td>"
                    f"<td>{entry.study}</td><td>{words}</td></tr>")
    return ("<h2>Overview</h2><table><tr><th>in the dissertation</th><th>content</th><th>study</th>"
            "<th>findings</th></tr>" + "".join(rows) + "</table>")


def _words(findings: Iterable[Finding]) -> str:
    verdicts = [finding.verdict for finding in findings]
    return ", ".join(f"<span class='{_CLASSES[word]}'>{word}: {verdicts.count(word)}</span>"
                     for word in WORDS if word in verdicts) or "-"


def _anchor(name: str) -> str:
    return name.lower().replace(" ", "-").replace(".", "-")


def _findings_of(entry: Entry, studies: dict[str, Study]) -> list[Finding]:
    """The findings of the dissertation on a table or figure, of any study, and of its own study on its section."""
    return [finding for study in studies.values() for finding in study.findings
            if not finding.own and (entry.name in references(finding.source) or (
                study.name == entry.study and set(entry.sections) & set(re.split(r"[, ]+", finding.source))))]


def _entry(entry: Entry, studies: dict[str, Study], shown: set[str], pictures: dict[tuple[str, str], str],
           listed: dict[tuple[str, str], str], second: str) -> str:
    """A table or figure; findings and pictures of an earlier one are not repeated."""
    study = studies[entry.study]
    findings = _findings_of(entry, studies)
    new = [finding for finding in findings if finding.key not in listed]
    places = dict.fromkeys(listed[finding.key] for finding in findings if finding.key in listed)
    listed.update((finding.key, entry.name) for finding in new)
    links = ", ".join(f"<a href='#{_anchor(name)}'>{name}</a>" for name in places)
    parts = [f"<h3 id='{_anchor(entry.name)}'>{entry.name}: {escape(entry.caption)}</h3>"
             f"<p class='small'>Study <a href='{second}#study-{entry.study}'>{entry.study}</a></p>",
             _table(new), f"<p class='small'>Further findings: {links}.</p>" if links else ""]
    for part in study.parts:
        file = part.get("file", "")
        if file and file not in shown and any(fnmatchcase(file, pattern) for pattern in entry.files):
            shown.add(file)
            parts.append(_part(part))
    for file, picture in study.pictures.items():
        if any(fnmatchcase(file, pattern) for pattern in entry.files):
            key = study.name, file
            if key in pictures:
                parts.append(f"<p class='small'>Picture: see <a href='#{pictures[key]}'>above</a>.</p>")
            else:
                pictures[key] = _anchor(entry.name)
                parts.append(picture)
    return "\n".join(parts)


def _rest(study: Study, shown: set[str], pictures: dict[tuple[str, str], str]) -> str:
    """Results of a study beyond tables and figures: its paragraphs, its own findings, further tables and pictures."""
    there = [finding for entry in ENTRIES for finding in _findings_of(entry, {study.name: study})]
    findings = [finding for finding in study.findings if finding not in there]
    texts = [_part(part) for part in study.parts if part.get("file", "") not in shown]
    images = [picture for file, picture in study.pictures.items() if (study.name, file) not in pictures]
    anchor = f"study-{study.name}"
    parts = [f"<h3 id='{anchor}'><a name='{anchor}'></a>{study.name}</h3><p>{escape(study.text)}</p>",
             f"<p class='no'>{escape(study.error)}</p>" if study.error else "",
             _table([finding for finding in findings if not finding.own])]
    own = [finding for finding in findings if finding.own]
    if own:
        parts += ["<p>Our own:</p>", _table(own, "this project states")]
    return "\n".join([*parts, *texts, *images])


def _part(part: dict[str, Any]) -> str:
    """A paragraph or a table."""
    if "text" in part:
        return "".join(f"<p>{escape(line)}</p>" for line in part["text"].split("\n"))
    head = "".join(f"<th>{escape(name)}</th>" for name in part["headings"])
    rows = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in part["rows"])
    return f"<table class='numbers'><caption>{escape(part['title'])}</caption><tr>{head}</tr>{rows}</table>"


def _table(findings: Sequence[Finding], whose: str = "the dissertation states") -> str:
    if not findings:
        return ""
    lines = []
    for f in findings:
        stated = f"<br><span class='small'>there: {escape(f.stated)}</span>" if f.stated else ""
        rule = f"<br><span class='small'>criterion: {escape(f.criterion)}</span>" if f.criterion else ""
        reason = f"<br><span class='small'>{escape(f.reason)}</span>" if f.reason else ""
        lines.append(f"<tr><td>{escape(f.source)}</td><td>{escape(f.claim)}{stated}{rule}</td>"
                     f"<td class='{_CLASSES[f.verdict]}'>{f.verdict}</td><td>{escape(f.ours)}{reason}</td></tr>")
    return (f"<table><tr><th>where</th><th>{whose}</th><th>verdict</th><th>our numbers</th></tr>"
            f"{''.join(lines)}</table>")


def _not_made() -> str:
    rows = "".join(f"<tr><td>{escape(name)}</td><td>{escape(reason)}</td></tr>" for name, reason in NOT_MADE.items())
    return ("<h2>Tables and figures that are not made</h2><table><tr><th>in the dissertation</th><th>reason</th></tr>"
            f"{rows}</table>")


def _picture(path: Path, width: int) -> bytes:
    """A picture of at most a width, with few shades, as a PNG file."""
    image = pyplot.imread(path)[..., :3]
    step = max(1, -(-image.shape[1] // width))
    rows, columns = (n // step * step for n in image.shape[:2])
    image = image[:rows, :columns].reshape(rows // step, step, columns // step, step, 3).mean(axis=(1, 3))
    shades = np.round(image * (_SHADES - 1)).astype(int)
    return _png(shades @ [_SHADES * _SHADES, _SHADES, 1])


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
