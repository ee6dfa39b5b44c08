# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pages of ParaView's help, with their table of contents, from the Markdown pages of this directory.

python3 make_pages.py BUILD              checks the pages against the XML of the build tree: one page for each proxy,
                                         the function and the class of each entry of filters.md, and the number of words
python3 make_pages.py --help-pages OUTPUT XML...    the pages for ParaView's help, with tables of the XML's properties
python3 make_pages.py --contents FILE               the table of contents: the pages in the order of filters.md

A page has the table of properties of a proxy at the comment <!-- properties: filters.ElementQuality -->. ParaView's
button ? opens the page named after the proxy, here filters.ElementQuality.html. So the help has each page under the
names of its proxies, in place of the pages that ParaView generates, and links lead to these names. The page
filters.md is index.html there.

The Markdown is CommonMark with tables. A formula stands between lines of $$; the comment <!-- formula: ... --> before
it has the same as plain text, which the help shows.
"""

import html
import re
import shutil
import sys
from pathlib import Path

from property_table import find_files, read_proxies, table_of

HERE = Path(__file__).resolve().parent
INDEX = "filters"
HELP_WIDTH = 860  # pixels of a picture in ParaView's help
MAX_WORDS = 1200  # of a page before its Details
BEHIND = re.compile(r"^## (?:Details|Properties)$", re.MULTILINE)
PLACE = re.compile(r"<!-- properties: (\S+) -->\n(?:\*.*\*\n)?")  # with the line that stands for the table
FORMULA = re.compile(r"<!-- formula: (.*?) -->\n+\$\$\n.*?\n\$\$\n", re.DOTALL)
LINK = re.compile(r'(href=")(\w+)\.(?:md|html)\b')
HEADING = re.compile(r"<h([1-6])>(.*?)</h\1>")
PICTURE = re.compile(r'src="([^"/]+)"')
IN_TREE = re.compile(r'<a href="(?:\.\./)+([^"]+)">(.*?)</a>', re.DOTALL)  # files that the help does not have
ENTRY = re.compile(r"^\| (?:\w+) > Tautline > \[.*?\]\((\w+)\.md\) \|.*\| `(\w+)` \| `(\w+)` \|$", re.MULTILINE)
PAGE = """<!DOCTYPE html>
<html>
<head>
<meta charset="utf-8">
<title>{title} - Tautline</title>
<style>
{style}</style>
</head>
<body>
{body}
</body>
</html>
"""


def proxies_of(text: str) -> list:
    return PLACE.findall(text)


def title_of(text: str) -> str:
    """The first heading of a page."""
    return re.search(r"^# (.*)$", text, re.MULTILINE)[1]


def slug(heading: str) -> str:
    """The anchor of a heading, as forges and Sphinx make it."""
    words = re.sub(r"[^\w -]", "", html.unescape(re.sub(r"<[^>]+>", "", heading)))
    return words.strip().lower().replace(" ", "-")


def with_tables(text: str, proxies: dict, page: str) -> str:
    """The page with the tables of properties, as HTML."""

    def fill(match) -> str:
        if match[1] not in proxies:  # a module that was not built
            print(f"{page}: the XML has no proxy {match[1]}; its table is left out")
            return ""
        return table_of(proxies[match[1]]) + "\n"

    return PLACE.sub(fill, text)


def sized(match) -> str:
    """The tag of a picture; a wide one gets the width that fits into ParaView's help."""
    path = HERE / match[1]
    wide = path.suffix == ".png" and int.from_bytes(path.read_bytes()[16:20], "big") > HELP_WIDTH
    return f'{match[0]} width="{HELP_WIDTH}"' if wide else match[0]


def to_html(text: str) -> str:
    """The body of a page of Markdown; its headings have anchors."""
    from markdown_it import MarkdownIt  # not needed for the checks

    plain = FORMULA.sub(lambda match: f"<p><code>{html.escape(match[1])}</code></p>\n", text)
    body = MarkdownIt("commonmark", {"html": True}).enable("table").render(plain)
    body = re.sub(r'<img src="([^"]+)"', sized, body)
    return HEADING.sub(lambda match: f'<h{match[1]}><a name="{slug(match[2])}"></a>{match[2]}</h{match[1]}>', body)


def pages_of(directory: Path) -> dict:
    """The texts of the pages by their names without suffix."""
    return {path.stem: path.read_text(encoding="utf-8") for path in sorted(directory.glob("*.md"))}


def check(proxies: dict, pages: dict) -> int:
    """Every proxy has one page; filters.md has the names of the XML."""
    wrong = []
    found = [name for text in pages.values() for name in proxies_of(text)]
    wrong += [f"{name} has {found.count(name)} pages instead of one" for name in proxies if found.count(name) != 1]
    for page, text in pages.items():
        words = len(BEHIND.split(text)[0].split())
        if words > MAX_WORDS and page != "metrics":  # a table and a section for each metric
            wrong.append(f"{page}.md has {words} words, {MAX_WORDS} are allowed: move some under Details")
    listed = ENTRY.findall(pages[INDEX])
    for page, function, type_name in listed:
        proxy = proxies.get(proxies_of(pages[page])[0])
        if proxy is None:  # a module that was not built
            continue
        expected = (proxy.find("Hints/Python").get("function"), proxy.get("class"))
        if expected != (function, type_name):
            wrong.append(f"{INDEX}.md: {page} is {' and '.join(expected)}, not {function} and {type_name}")
    print("\n".join([*wrong, f"{len(pages)} pages, {len(proxies)} proxies, {len(listed)} entries, {len(wrong)} wrong"]))
    return 1 if wrong or not proxies or not listed else 0


def make_contents(file: Path, pages: dict) -> int:
    """ParaView's table of contents; each page by the name that it has in the help."""
    lines = []
    for page in dict.fromkeys(re.findall(r"\]\((\w+)\.md\)", pages[INDEX])):
        names = proxies_of(pages[page])
        title = html.escape(title_of(pages[page]), quote=False)
        lines.append(f'    <section title="{title}" ref="{names[0] if names else page}.html"/>\n')
    head = '<toc>\n  <section title="Tautline" ref="index.html">\n'
    file.write_text(f"{head}{''.join(lines)}  </section>\n</toc>\n", encoding="utf-8")
    return 0


def make_help(output: Path, proxies: dict, pages: dict) -> int:
    """Pages named after their proxies, with links to these names, and the pictures.

    ParaView's help does not read style sheets: the style is in the pages.
    """
    style = (HERE / "style.css").read_text(encoding="utf-8")
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    shown = set()
    names = {page: proxies_of(text) or [page] for page, text in pages.items()} | {INDEX: ["index"]}
    for page, text in pages.items():
        body = to_html(with_tables(text, proxies, page))
        body += '<p><a href="filters.md">All filters and pages</a></p>' if page != INDEX else ""
        linked = LINK.sub(lambda match: f"{match[1]}{names.get(match[2], [match[2]])[0]}.html", body)
        linked = IN_TREE.sub(r"<code>\1</code>", linked)
        made = PAGE.format(title=html.escape(title_of(text), quote=False), style=style, body=linked.strip())
        shown |= set(PICTURE.findall(made))
        for name in names[page]:
            (output / f"{name}.html").write_text(made, encoding="utf-8")
    for path in HERE.glob("*.png"):
        if path.name in shown:
            shutil.copyfile(path, output / path.name)
    return 0


def main(arguments: list) -> int:
    pages = pages_of(HERE)
    if arguments[0] == "--help-pages":
        return make_help(Path(arguments[1]), read_proxies(arguments[2:]), pages)
    if arguments[0] == "--contents":
        return make_contents(Path(arguments[1]), pages)
    return check(read_proxies(find_files(Path(arguments[0]))), pages)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
