# SPDX-License-Identifier: BSD-3-Clause
"""Inserts the tables of properties in the help pages, and makes the pages of ParaView's help.

python3 make_pages.py BUILD [--write]    checks that the tables of the pages are those of the build tree's XML;
                                         --write inserts them
python3 make_pages.py --help-pages OUTPUT XML...    the pages for ParaView's help, with the tables of these XML files

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
    if wrong:
        print("Plugin/Documentation/make_pages.py BUILD --write inserts the tables")
    print(f"{len(pages)} pages, {len(proxies)} proxies, {wrong} wrong")
    return 1 if wrong or not proxies else 0


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
    return check(read_proxies(find_files(Path(arguments[0]))), pages, "--write" in arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
