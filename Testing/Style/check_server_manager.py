# SPDX-License-Identifier: BSD-3-Clause
"""check_server_manager.py SERVER_MANAGER [GENERATED_XML...]: what repeats in ServerManager is written once.

At most MAX_REPEATED of the lines that are not blank may stand in repeated blocks: runs of BLOCK or more lines that
stand twice or more, white space aside. Templates, snippets and generated files are well-formed XML, every snippet is
included somewhere, and in the generated files each property of a group is one of its proxy. A property whose
documentation gives the value 0 a meaning of its own ("; 0 is no limit") has the hint that writes it beside the field.

Panels of filters begin with the Summary, and their groups are sections with names of SECTIONS, in this order, that have
no advanced properties; other groups are those of OPEN_GROUPS. Ungrouped properties stand before the first section.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

BLOCK = 8  # lines
MAX_REPEATED = 0.01
ZERO = re.compile(r"(?:^|[;,.]\s)0(?: is|:| =| means| switches)\s")  # a meaning of its own
ZERO_HINT = "Hints/PropertyWidgetDecorator[@type='tautline_zero']"
SECTION_HINT = "Hints/PropertyWidgetDecorator[@type='tautline_section']"
SECTIONS = [
    "Right-hand side",
    "Boundary and geometry",
    "Target",
    "Finite volumes",
    "Scalarization",
    "Coefficients",
    "Limits of the size",
    "Arrays",
    "Interaction layer",
    "Solution",
    "Time",
    "Energy",
    "Size array",
    "Stop",
    "Algorithm",
    "Output",
    "Parallel",
]
UNSEEN = ("TimeStepsInformationHelper", "Hints/PropertyWidgetDecorator[@type='tautline_script_only']")
OPEN_GROUPS = {
    "Objectives",
    "Histogram",
    "Point",
    "Numbers of the Parts that Move",
    "Values that Move (none: all but 0)",
}
INCLUDE = re.compile(r"<\?include (\w+\.xml)")
Line = tuple[Path, int]


def lines_of(path: Path) -> list[tuple[int, str]]:
    """Number and text of the lines that are not blank, white space folded."""
    lines = [(number, " ".join(line.split())) for number, line in enumerate(path.read_text().splitlines(), 1)]
    return [line for line in lines if line[1]]


def repeated(files: list[Path]) -> tuple[list[list[Line]], float]:
    """The places of each block of BLOCK lines that stands twice or more, and the share of lines in them."""
    total = 0
    places: dict[tuple, list[list[Line]]] = defaultdict(list)
    for path in files:
        lines = lines_of(path)
        total += len(lines)
        for start in range(len(lines) - BLOCK + 1):
            block = lines[start : start + BLOCK]
            places[tuple(text for _, text in block)].append([(path, number) for number, _ in block])
    found = [blocks for blocks in places.values() if len(blocks) > 1]
    inside = {line for blocks in found for block in blocks for line in block}
    return [[block[0] for block in blocks] for blocks in found], len(inside) / max(total, 1)


def malformed(files: list[Path]):
    for path in files:
        try:
            ElementTree.parse(path)
        except ElementTree.ParseError as error:
            yield f"{path} is not well-formed: {error}"


def unused(files: list[Path]):
    included = {name for path in files for name in INCLUDE.findall(path.read_text())}
    yield from (f"{path} is included nowhere" for path in files if path.suffix == ".xml" and path.name not in included)


def strangers(path: Path):
    """Properties of a group that their proxy does not have."""
    for proxy in ElementTree.parse(path).iterfind("ProxyGroup/*"):
        own = {child.get("name") for child in proxy if child.tag.endswith("Property")}
        for group in proxy.iterfind("PropertyGroup/Property"):
            if group.get("name") not in own:
                yield f"{path}: {proxy.get('name')} has no property {group.get('name')}"


def silent_zeros(path: Path):
    """Properties with a special 0 that their field does not show."""
    for proxy in ElementTree.parse(path).iterfind("ProxyGroup/*"):
        for child in proxy:
            special = ZERO.search(child.findtext("Documentation", "").strip())
            editable = child.tag.endswith("Property") and child.get("information_only") != "1"
            if special and editable and child.find(ZERO_HINT) is None:
                yield f"{path}: {proxy.get('name')}.{child.get('name')} has a special 0: include Zero.xml"


def in_panel(item) -> bool:
    """Whether the panel may have a row for a property."""
    port = item.tag == "InputProperty" and item.get("panel_widget") is None
    unseen = item.get("panel_visibility") == "never" or any(item.find(tag) is not None for tag in UNSEEN)
    return item.tag.endswith("Property") and not port and not unseen


def misplaced(path: Path):
    """Groups and properties that are not where all panels have them."""
    for proxy in ElementTree.parse(path).iterfind("ProxyGroup/SourceProxy"):
        name = proxy.get("name")
        group_of = {item.get("name"): group for group in proxy.iterfind("PropertyGroup") for item in group}
        rows = [item for item in proxy if in_panel(item)]
        if rows and proxy.find("*[@name='Summary']") is not None and rows[0].get("name") != "Summary":
            yield f"{path}: {name} begins with {rows[0].get('name')}, not with its Summary"
        last = -1
        for item in rows:
            group = group_of.get(item.get("name"))
            label = None if group is None else group.get("label")
            if label is None or label in OPEN_GROUPS:
                if last >= 0:
                    yield f"{path}: {name}.{item.get('name')} stands below a section"
                continue
            hint = group.find(SECTION_HINT)
            if label not in SECTIONS or hint is None or hint.get("text") != label:
                yield f"{path}: {name} has a group {label}, which is no section: see SECTIONS and Section.xml"
                continue
            if SECTIONS.index(label) < last:
                yield f"{path}: {name} has the section {label} below {SECTIONS[last]}"
            last = SECTIONS.index(label)
            if item.get("panel_visibility") == "advanced":
                yield f"{path}: {name}.{item.get('name')} is advanced, in a section that is closed anyway"


CHECKS = (strangers, silent_zeros, misplaced)


def main(directory: Path, generated: list[Path]) -> int:
    files = sorted(path for path in directory.rglob("*") if path.name.endswith((".xml", ".xml.in")))
    blocks, share = repeated(files)
    wrong = [*malformed(files + generated), *unused(files)]
    if not wrong:
        wrong += [complaint for path in generated for check in CHECKS for complaint in check(path)]
    if share > MAX_REPEATED:
        wrong += [" = ".join(f"{path.relative_to(directory)}:{line}" for path, line in block) for block in blocks]
        allowed = f"{MAX_REPEATED:.0%} are allowed"
        wrong.append(f"{share:.1%} of the lines stand in repeated blocks, {allowed}: make snippets")
    print("\n".join(wrong))
    print(f"{len(files)} files, {len(generated)} generated, {share:.1%} repeated, {len(wrong)} complaints")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), [Path(argument) for argument in sys.argv[2:]]))
