# SPDX-License-Identifier: BSD-3-Clause
"""The table of a proxy's properties as HTML, from the XML of ParaView's server manager.

A table lists the properties in the order of the XML, under the titles of the groups of the panel.
"""

import html
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

GROUPS = ("filters", "sources", "writers")  # visible to users; readers are sources
METRIC = "Inverse mean ratio"  # the first entry of a list of metrics
COLUMNS = '<tr><th width="22%">Property</th><th width="16%">Default</th><th width="62%">Description</th></tr>'
BULLET = re.compile(r"^[*-] ", re.MULTILINE)
LONG = 8  # characters of a number, from which it is rounded to six digits
DEFAULT_VISIBILITY = "tautline_default_visibility"  # a hint: not advanced under a condition
VTK_TYPES = {"vtkCompositeDataSet": None, "vtkSelection": "a selection"}  # None: stated otherwise


def read_proxies(files: list) -> dict:
    """The proxies of the XML files by "group.name", without internal ones, with the properties that these expose."""
    groups = [group for file in files for group in ElementTree.parse(file).getroot().iter("ProxyGroup")]
    proxies = {f"{group.get('name')}.{proxy.get('name')}": proxy for group in groups for proxy in group}
    for proxy in proxies.values():
        for part in proxy.findall("SubProxy"):
            core = part.find("Proxy")
            inner = proxies.get(f"{core.get('proxygroup')}.{core.get('proxyname')}")
            names = {exposed.get("name") for exposed in part.iter("Property")}
            proxy.extend(item for item in inner if item.get("name") in names)
    return {name: proxy for name, proxy in proxies.items() if name.split(".")[0] in GROUPS}


def inline(text: str) -> str:
    """A line of documentation as HTML: **bold**, *emphasized*."""
    text = html.escape(" ".join(text.split()), quote=False)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
    return re.sub(r"\*(\S[^*]*?)\*", r"<i>\1</i>", text)


def paragraphs(text: str) -> str:
    """Documentation with lists as HTML."""
    blocks = []
    for block in re.split(r"\n\s*\n", text.strip()):
        head, *items = BULLET.split(block)
        blocks += [inline(head)] if head.strip() else []
        blocks += ["<ul>" + "".join(f"<li>{inline(item)}</li>" for item in items) + "</ul>"] if items else []
    return "<br>".join(blocks).replace("<br><ul>", "<ul>").replace("</ul><br>", "</ul>")


def label_of(item) -> str:
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", item.get("name"))
    return item.get("label") or spaced


def entries_of(item) -> dict:
    return {entry.get("value"): entry.get("text") for entry in item.iterfind("EnumerationDomain/Entry")}


def default_of(item) -> str:
    """The default as the panel shows it."""
    if item.tag == "InputProperty":
        return "none" if is_optional(item) else ""
    values = item.get("default_values", "")
    delimiter = item.get("default_values_delimiter")
    if item.find("ArrayListDomain") is not None and delimiter:
        values = values.split(delimiter)[-1]
    if item.find("BooleanDomain") is not None:
        return {"0": "off", "1": "on"}[values]
    entries = entries_of(item)
    if entries:
        return entries.get(values, values)
    if item.tag == "DoubleVectorProperty":
        return " ".join(f"{float(value):.6g}" if len(value) > LONG else value for value in values.split())
    return "none" if values in ("None", "none") else values


def is_optional(item) -> bool:
    return item.find("Hints/Optional") is not None or any(d.get("optional") for d in item.iterfind("DataTypeDomain"))


def range_of(item) -> str:
    """The values that the domains allow, in words."""
    for domain in (*item.iterfind("DoubleRangeDomain"), *item.iterfind("IntRangeDomain")):
        low, high = ((domain.get(key) or "").split() for key in ("min", "max"))
        low, high = (values[0] if len(set(values)) == 1 else "" for values in (low, high))
        if low and high:
            return f"From {low} to {high}."
        if low or high:
            return f"At least {low}." if low else f"At most {high}."
    texts = list(entries_of(item).values())
    if METRIC in texts:
        return 'One or more of the <a href="metrics.html">metrics</a>.' if item.get("repeat_command") else (
            'One of the <a href="metrics.html">metrics</a>.')
    if texts:
        return "Choices: " + "; ".join(html.escape(text) for text in texts) + "."
    kinds = [VTK_TYPES.get(kind.get("value"), kind.get("value")) for kind in item.iterfind("DataTypeDomain/DataType")]
    if kinds:
        composite = any(kind.get("value") == "vtkCompositeDataSet" for kind in item.iter("DataType"))
        words = " or ".join(f"<code>{kind}</code>" if kind.startswith("vtk") else kind for kind in kinds if kind)
        return f"Accepts {words}{', also in blocks' if composite else ''}."
    return ""


def condition_of(item, proxy, decorator="GenericDecorator") -> str:
    """The condition of this kind of hint under which the panel shows the property, in words; empty: always."""
    by_name = {other.get("name"): other for other in proxy if other.get("name")}

    def words(node) -> str:
        if node.tag == "Expression":
            return f" {node.get('type')} ".join(filter(None, map(words, node)))
        if node.get("type") == "CompositeDecorator":
            return words(node.find("Expression"))
        other = by_name.get(node.get("property"))
        if node.get("type") != decorator or other is None:
            return ""
        values = (node.get("values") or node.get("value") or "").split() or [""]
        entries = entries_of(other)
        if other.find("BooleanDomain") is not None:
            entries = {"0": "off", "1": "on"}
        negated = node.get("inverse") == "1"
        if entries and 2 * len(values) > len(entries):  # the others are fewer
            values, negated = [value for value in entries if value not in values], not negated
        shown = " or ".join(entries.get(value, value) for value in values)
        return f"<i>{html.escape(label_of(other))}</i> is {'not ' if negated else ''}{html.escape(shown) or 'empty'}"

    texts = [words(node) for node in item.iterfind("Hints/PropertyWidgetDecorator")]
    return " and ".join(filter(None, texts))


def row_of(item, proxy) -> tuple:
    """(label, default, description) of a property."""
    label = html.escape(label_of(item)) + (" <i>(advanced)</i>" if item.get("panel_visibility") == "advanced" else "")
    text = paragraphs("".join(item.findtext("Documentation") or ""))
    if item.tag == "InputProperty" and not text:
        text = "The input."
    shown = condition_of(item, proxy)
    usual = condition_of(item, proxy, DEFAULT_VISIBILITY)
    conditions = [f"Shown if {shown}." if shown else "", f"Advanced unless {usual}." if usual else ""]
    allowed = range_of(item)
    if allowed == "At least 0." and "Above 0." in text:  # a domain has no open range
        allowed = ""
    parts = [text, allowed, *conditions]
    return label, html.escape(default_of(item)), " ".join(filter(None, parts))


def is_listed(item) -> bool:
    """Is the property visible to users? Results are; times and file names as they were read are not."""
    if not item.tag.endswith("Property") or item.get("is_internal") == "1":
        return False
    return not item.get("information_only") or item.find("Documentation") is not None


def table_of(proxy) -> str:
    """The HTML table of the properties of a proxy, by the groups of its panel."""
    titles = {part.get("name"): group.get("label") for group in proxy.iter("PropertyGroup") for part in group}
    sections = {}
    for item in filter(is_listed, proxy):
        section = sections.setdefault(titles.get(item.get("name")), [])
        section.append(row_of(item, proxy))
    lines = ['<table class="docutils" width="100%">', COLUMNS]
    for title, rows in sections.items():
        lines += [f'<tr><th colspan="3">{html.escape(title)}</th></tr>'] if title else []
        for label, default, text in rows:
            lines.append(f"<tr><td>{label}</td><td>{default}</td>\n<td>{text}</td></tr>")
    return "\n".join(lines + ["</table>"])


def find_files(build: Path) -> list:
    """The XML files of a build tree."""
    return sorted([*build.glob("Filters/*/*.xml"), *build.glob("Readers/*.xml")])
