# SPDX-License-Identifier: BSD-3-Clause
"""The Python reference of the site: a page for each public function and class of the package, from its docstring."""

import html
import inspect
import re

WIDTH = 80  # of a signature in one line
SECTION = re.compile(r"^(\w+)\n-+\n", re.MULTILINE)
ENTRY = re.compile(r"^(\S.*?)(?: : (.*))?\n((?:(?:    .*)?\n)*)", re.MULTILINE)
TABLES = {"Parameters": "Parameter", "Attributes": "Attribute"}
LISTS = ("Returns", "Raises")


def signature_of(name: str, value) -> str:
    """As in a call, an argument a line where there are many."""
    try:
        signature = str(inspect.signature(value))
    except ValueError:  # a class made of C
        return name
    signature = re.sub(r"(: |-> )'([^']*)'", r"\1\2", signature)  # annotations are texts
    if len(signature) <= WIDTH:
        return name + signature
    return name + re.sub(r"(^\(|, (?=\w+: |\*))", lambda match: f"{match[0].strip()}\n    ", signature)


def prose(text: str) -> str:
    """Text of a docstring as HTML without markup of its own; paragraphs are separated by empty lines."""
    return html.escape(text.strip(), quote=False).replace("\n\n", "<br><br>").replace("\n", " ")


def table(head: str, body: str) -> str:
    """The entries of a section as a table of HTML."""
    rows = []
    for name, kind, text in ENTRY.findall(body.strip("\n") + "\n"):
        kind, _, default = kind.partition(", default ")
        optional = kind.endswith(", optional")
        cells = [f"<code>{html.escape(name)}</code>", html.escape(kind.removesuffix(", optional")),
                 f"<code>{html.escape(default)}</code>" if default else ("optional" if optional else ""),
                 prose(re.sub(r"^    ", "", text, flags=re.MULTILINE))]  # fmt: skip
        rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    heads = "".join(f"<th>{text}</th>" for text in (head, "Type", "Default", "Description"))
    return f'<table class="docutils">\n<tr>{heads}</tr>\n' + "\n".join(rows) + "\n</table>\n"


def described(body: str) -> str:
    """The entries of Returns and Raises as a list of HTML."""
    items = [f"<dt><code>{html.escape(' : '.join(filter(None, (name, kind))))}</code></dt><dd>{prose(text)}</dd>"
             for name, kind, text in ENTRY.findall(body.strip("\n") + "\n")]  # fmt: skip
    return "<dl>\n" + "\n".join(items) + "\n</dl>\n"


def function_page(name: str, value) -> tuple[str, str]:
    """The summary and the page of a function or class."""
    head, *sections = SECTION.split((inspect.getdoc(value) or "") + "\n")
    summary = head.strip().split("\n\n")[0].replace("\n", " ")
    rest = head.strip().split("\n\n", 1)[1:]
    parts = [f"# tautline.{name}\n", f"<p>{prose(summary)}</p>\n", f"```python\n{signature_of(name, value)}\n```\n"]
    parts += [f"<p>{prose(text)}</p>\n" for text in rest]
    for title, body in zip(sections[::2], sections[1::2]):
        parts.append(f"## {title}\n")
        if title in TABLES:
            parts.append(table(TABLES[title], body))
        elif title in LISTS:
            parts.append(described(body))
        elif title == "Examples":
            parts.append(f"```python\n{body.strip()}\n```\n")
        else:
            parts.append(f"<p>{prose(body)}</p>\n")
    return summary, "\n".join(parts)


def python_pages() -> dict[str, str]:
    """The texts of the pages by their names: python, the list, and one for each function and class."""
    import tautline

    found = {name: value for name, value in sorted(vars(tautline).items())
             if callable(value) and not name.startswith(("_", "vtk"))}  # fmt: skip
    summary, _, text = (inspect.getdoc(tautline) or "").partition("\n\n")
    pages, rows = {}, {True: [], False: []}
    for name, value in found.items():
        brief, pages[f"python-{name}"] = function_page(name, value)
        row = f'| <a href="python-{name}.html">{name}</a> | {brief} |'
        rows[inspect.isclass(value)].append(row.replace("\\", "\\\\"))
    parts = [f"# Python\n\n{summary}\n\n```text\n{text}\n```\n"]
    for is_class, title in ((False, "Functions"), (True, "Results and other classes")):
        parts.append(f"## {title}\n\n| name | purpose |\n|---|---|\n" + "\n".join(rows[is_class]) + "\n")
    names = "\n".join(pages)
    parts.append(f"```{{toctree}}\n:hidden:\n{names}\n```\n")
    return pages | {"python": "\n".join(parts)}
