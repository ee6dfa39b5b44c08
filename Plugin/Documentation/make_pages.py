# SPDX-License-Identifier: BSD-3-Clause
"""Inserts the tables of properties in the help pages and the table of filters in Plugin/Site/filters.md, and makes the
pages of ParaView's help with their table of contents.

python3 make_pages.py BUILD [--write]    checks that the tables of the pages are those of the build tree's XML;
                                         --write inserts them
python3 make_pages.py --help-pages OUTPUT XML...    the pages for ParaView's help, with the tables of these XML files
python3 make_pages.py --contents FILE XML...        the table of contents: the pages in the order of index.html

A page has a table between the comments <!-- properties: filters.ElementQuality --> and <!-- end of properties -->.
ParaView's button ? opens the page named after the proxy, here filters.ElementQuality.html. So the help has each page
under the names of its proxies, in place of the pages that ParaView generates, and links lead to these names.
"""

import re
import shutil
import sys
from pathlib import Path

from property_table import find_files, read_proxies, table_of

HERE = Path(__file__).resolve().parent
PLACE = re.compile(r"(<!-- properties: (\S+) -->\n)(.*?)(<!-- end of properties -->)", re.DOTALL)
LINK = re.compile(r'(href=")([\w.]+\.html)')
IN_TREE = re.compile(r'<a href="\.\./\.\./([^"]+)">[^<]*</a>')  # files that the help does not have
MENU = re.compile(
    r'<tr><td>(\w+) &gt; Tautline &gt; <a href="([^"]+)">([^<]+)</a></td>\n<td>(.*?)</td></tr>', re.DOTALL
)
TITLE = re.compile(r"<title>(.*?)(?: - Tautline)?</title>")
FILTERS = HERE.parent / "Site" / "filters.md"
ROWS = re.compile(r"(<!-- filters -->\n).*?(?=<!-- end of filters -->)", re.DOTALL)
STYLE = '<link rel="stylesheet" href="style.css">'


def proxies_of(text: str) -> list:
    return [match[2] for match in PLACE.finditer(text)]


def with_tables(text: str, proxies: dict, page: Path) -> str:
    """The page with the tables as they are in the XML."""

    def fill(match) -> str:
        if match[2] not in proxies:  # a module that was not built
            print(f"{page.name}: the XML has no proxy {match[2]}; its table is kept")
            return match[0]
        return match[1] + table_of(proxies[match[2]]) + "\n" + match[4]

    return PLACE.sub(fill, text)


def check(proxies: dict, pages: list, write: bool) -> int:
    """Every proxy has one page, whose table is that of the XML."""
    wrong, found = 0, []
    for page in pages:
        text = page.read_text(encoding="utf-8")
        found += proxies_of(text)
        made = with_tables(text, proxies, page)
        if made != text and write:
            page.write_text(made, encoding="utf-8")
        elif made != text:
            wrong += 1
            print(f"{page.name}: a table of properties is not that of the XML")
    for name in proxies:
        if found.count(name) != 1:
            wrong += 1
            print(f"{name} has {found.count(name)} pages instead of one")
    wrong += check_filters(proxies, write)
    if wrong:
        print("Plugin/Documentation/make_pages.py BUILD --write inserts the tables")
    print(f"{len(pages)} pages, {len(proxies)} proxies, {wrong} wrong")
    return 1 if wrong or not proxies else 0


def filter_rows(proxies: dict) -> str:
    """The rows of filters.md: the entries of index.html with the class, the function and the command of each."""
    rows = []
    for menu, page, title, text in MENU.findall((HERE / "index.html").read_text(encoding="utf-8")):
        proxy = proxies.get(proxies_of((HERE / page).read_text(encoding="utf-8"))[0])
        if proxy is None:
            return ""  # a module that was not built
        function = proxy.find("Hints/Python").get("function")
        rows.append(
            f"| {menu} > Tautline > [{title}](../Documentation/{page}) | `{proxy.get('class')}` | `{function}` "
            f"| `{function.replace('_', '-')}` | {' '.join(text.split())} |\n"
        )
    head = "| ParaView | C++ | Python | shell | what it does |\n|---|---|---|---|---|\n"
    return head + "".join(rows)


def check_filters(proxies: dict, write: bool) -> int:
    """Whether filters.md has the rows; 1 if it has not."""
    rows, text = filter_rows(proxies), FILTERS.read_text(encoding="utf-8")
    made = ROWS.sub(lambda match: match[1] + rows, text) if rows else text
    if made == text:
        return 0
    if write:
        FILTERS.write_text(made, encoding="utf-8")
        return 0
    print(f"{FILTERS.name}: the table of filters is not made from index.html and the XML")
    return 1


def make_contents(file: Path, proxies: dict) -> int:
    """ParaView's table of contents; each page by the name that it has in the help."""
    index = (HERE / "index.html").read_text(encoding="utf-8")
    listed = dict.fromkeys(match[2] for match in LINK.finditer(index) if (HERE / match[2]).is_file())
    lines = []
    for page in listed:
        text = (HERE / page).read_text(encoding="utf-8")
        names = [name for name in proxies_of(text) if name in proxies]
        lines.append(f'    <section title="{TITLE.search(text)[1]}" ref="{names[0] if names else page[:-5]}.html"/>\n')
    head = '<toc>\n  <section title="Tautline" ref="index.html">\n'
    file.write_text(f"{head}{''.join(lines)}  </section>\n</toc>\n", encoding="utf-8")
    return 0


def make_help(output: Path, proxies: dict, pages: list) -> int:
    """Pages named after their proxies, with links to these names, and the pictures.

    ParaView's help does not read style sheets: the style is in the pages.
    """
    style = (HERE / "style.css").read_text(encoding="utf-8")
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    texts = {page.name: with_tables(page.read_text(encoding="utf-8"), proxies, page) for page in pages}
    names = {page: [f"{proxy}.html" for proxy in proxies_of(text)] or [page] for page, text in texts.items()}
    for page, text in texts.items():
        linked = LINK.sub(lambda match: match[1] + names.get(match[2], [match[2]])[0], text)
        linked = IN_TREE.sub(r"<code>\1</code>", linked)
        linked = linked.replace(STYLE, f"<style>\n{style}</style>")
        for name in names[page]:
            (output / name).write_text(linked, encoding="utf-8")
    for path in HERE.glob("*.png"):
        shutil.copyfile(path, output / path.name)
    return 0


def main(arguments: list) -> int:
    pages = sorted(HERE.glob("*.html"))
    if arguments[0] == "--help-pages":
        return make_help(Path(arguments[1]), read_proxies(arguments[2:]), pages)
    if arguments[0] == "--contents":
        return make_contents(Path(arguments[1]), read_proxies(arguments[2:]))
    return check(read_proxies(find_files(Path(arguments[0]))), pages, "--write" in arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
