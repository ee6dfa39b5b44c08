# SPDX-License-Identifier: BSD-3-Clause
"""The C++ reference of the site, made from the public headers, which are the manual: a page for each module and room.

A page has, for each header, its text and its public declarations with their comments. Public are the classes of VTK
modules in Filters and Readers, and the headers of the kernel without the line "Internal: not installed."
"""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

COMMENT = re.compile(r"/\*\*\n(.*?)\*/\n", re.DOTALL)  # the first one is that of the file
CLASS = re.compile(r"^class \w+_EXPORT (\w+) : public (\w+)\n\{\n(.*?)^\};", re.MULTILINE | re.DOTALL)
PUBLIC = re.compile(r"^public:\n(.*?)(?=^(?:protected|private):\n|\Z)", re.MULTILINE | re.DOTALL)
#: Declarations that every class of VTK has.
COMMON = re.compile(r"^ *(static \w+\* New\(\);|vtk\w*TypeMacro\(.*\);|void PrintSelf\([^;]*;)\n", re.MULTILINE)
GUARD = re.compile(r"^#(ifndef|define|endif|include).*\n", re.MULTILINE)
FORWARD = re.compile(r"^(?:class|struct) \w+;\n", re.MULTILINE)
GROUP = re.compile(r"^ *///@[{}]\n", re.MULTILINE)
INTERNAL = " * Internal: not installed.\n"
INTRODUCTION = """# C++

The classes of the filters, readers and writers, and below them the libraries of numerics, which need no VTK. How to
link them: <a href="use.html#c">Use, C++</a>. Each page is made from the public headers.

"""


def prose(comment: str) -> tuple[str, str]:
    """What @brief gives, and the rest of a comment, as Markdown."""
    text = re.sub(r"^ \* ?", "", comment, flags=re.MULTILINE)
    text = re.sub(r"^@(?:class|file)\b.*\n", "", text, flags=re.MULTILINE)
    found = re.search(r"^@brief (.*?)(?=\n\s*\n|\Z)", text, re.MULTILINE | re.DOTALL)
    brief = " ".join(found[1].split()) if found else ""
    text = text.replace(found[0], "", 1) if found else text
    parts = re.split(r"^@code\n(.*?)^@endcode\n?", text, flags=re.MULTILINE | re.DOTALL)
    parts[::2] = [markdown(part) for part in parts[::2]]
    parts[1::2] = [f"\n```cpp\n{part}```\n" for part in parts[1::2]]
    return brief, "\n".join(parts).strip()


def markdown(text: str) -> str:
    """Paragraphs of a comment; what would be markup or a tag in Markdown is escaped outside of `code`."""
    text = re.sub(r"^@par (.*?):?$", r"\n**\1.**", text, flags=re.MULTILINE)
    text = re.sub(r"^@sa\b", "\n**See also.**", text, flags=re.MULTILINE)
    text = re.sub(r"^@return\b", "\n**Returns**", text, flags=re.MULTILINE)
    text = re.sub(r"^@param (\w+)", r"\n**\1**:", text, flags=re.MULTILINE)
    pieces = re.split(r"(`[^`]*`|\*\*)", text)
    pieces[::2] = [re.sub(r"([<>*\[\]_|#$^])", r"\\\1", piece) for piece in pieces[::2]]
    return "".join(pieces)


def section(title: str, comment: str, declarations: str) -> str:
    brief, text = prose(comment)
    return f"## {title}\n\n{markdown(brief)}\n\n{text}\n\n```cpp\n{declarations.strip()}\n```\n"


def vtk_class(header: Path) -> tuple[str, str, str] | None:
    """Name, brief and section of the class of a header; None where it has none.

    Raises ValueError for a class without a text, or that this module cannot read.
    """
    text = header.read_text(encoding="utf-8")
    comment, found = COMMENT.search(text), CLASS.search(text)
    if "_EXPORT vtk" not in text:
        return None
    if not comment or not found:
        raise ValueError(f"{header}: no class with a comment at the top was found")
    name, base, body = found.groups()
    public = "\n".join(PUBLIC.findall(body))
    public = re.sub(r"\n{3,}", "\n\n", GROUP.sub("", COMMON.sub("", public))).lstrip("\n")
    declarations = f"class {name} : public {base}\n\n{textwrap.dedent(public)}"
    return name, prose(comment[1])[0], section(name, comment[1], declarations)


def kernel_header(header: Path, kernel: Path) -> tuple[str, str, str]:
    """Name, brief and section of a public header of the kernel."""
    text = header.read_text(encoding="utf-8").split("\n", 1)[1]
    comment = COMMENT.match(text)
    body = text[comment.end() :] if comment else text
    body = re.sub(r"\n{3,}", "\n\n", GROUP.sub("", FORWARD.sub("", GUARD.sub("", body))))
    name = f"tautline/{header.relative_to(kernel).as_posix()}"
    words = comment[1] if comment else ""
    return name, prose(words)[0], section(name, words, body)


def cxx_pages(source: Path) -> dict[str, str]:
    """The texts of the pages by their names: cxx, the list, and one for each module and room."""
    sections: dict[str, list[tuple[str, str, str]]] = {}
    for module in sorted([*(source / "Filters").iterdir(), source / "Readers"]):
        if (module / "vtk.module").exists():
            found = [vtk_class(header) for header in sorted(module.glob("vtk*.h"))]
            sections[f"Tautline::{module.name}"] = [item for item in found if item]
    kernel = source / "Filters/Kernel"
    for room in sorted(folder for folder in kernel.iterdir() if folder.is_dir()):
        headers = [header for header in sorted(room.rglob("*.h")) if INTERNAL not in header.read_text(encoding="utf-8")]
        sections[f"{room.name} (kernel)"] = [kernel_header(header, kernel) for header in headers]
    parts, pages, order = [INTRODUCTION], {}, []
    for title, items in sections.items():
        page = "cxx-" + re.sub(r"[^a-z]+", "-", title.lower().replace("tautline::", "")).strip("-")
        pages[page] = f"# {title}\n\n" + "\n".join(text for _, _, text in items)
        rows = "\n".join(f"| `{name}` | {markdown(brief)} |" for name, brief, _ in items)
        parts.append(f'## <a href="{page}.html">{title}</a>\n\n| class or header | |\n|---|---|\n{rows}\n')
        order.append(page)
    parts.append("```{toctree}\n:hidden:\n" + "\n".join(order) + "\n```\n")
    pages["cxx"] = "\n".join(parts)
    return pages
