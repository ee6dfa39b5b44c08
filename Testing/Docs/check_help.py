# SPDX-License-Identifier: BSD-3-Clause
"""check_help.py DOCUMENTATION HELP QCH XML...: ParaView's help of the plugin has our pages, as they are now.

The .qch file is an SQLite data base; a file's data are compressed, after four bytes with their length. ParaView's
button ? opens the page group.name.html of a proxy: each proxy of the XML files has one, made from a page in
DOCUMENTATION, with every property. HELP is the directory of the made pages, beside the table of contents toc.xml. No
page of the help has a dead link, and each is in the table of contents, which lists what filters.md links. QCH is -
where ParaView builds no help of plugins (Qt 6).
"""

import html
import re
import sqlite3
import sys
import zlib
from pathlib import Path

QUERY = "SELECT Name, Data FROM FileNameTable JOIN FileDataTable ON Id = FileId WHERE Data IS NOT NULL"
CONTENTS = "SELECT Data FROM ContentsTable"
LINK = re.compile(r'(?:href|src)="([^"]+)"')
#: The parts that the page of a proxy has.
SECTIONS = ("<strong>Purpose.</strong>", "<img ", "<!-- test: pvpython -->", '<table class="docutils"')
WIDEST = 1200  # pixels of a picture; pages show wide ones scaled


def width(png: bytes) -> int:
    return int.from_bytes(png[16:20], "big")


def dead_links(name: str, text: str, files: dict):
    for link in LINK.findall(text):
        target, _, anchor = link.partition("#")
        if re.match("[a-z]+:", link):
            continue
        if target and target not in files:
            yield f"{name}: {link} leads nowhere"
        elif anchor and f'name="{anchor}"' not in files[target or name].decode():
            yield f"{name}: {link} has no such anchor"


def proxy_complaints(proxies: dict, files: dict):
    for name, proxy in proxies.items():
        text = files.get(f"{name}.html", b"").decode()
        missing = [section for section in SECTIONS if section not in text]
        if missing:
            yield f"the page of {name} has no {' '.join(missing)}"
        for item in filter(is_listed, proxy):
            if f"<td>{html.escape(label_of(item))}" not in text:
                yield f"the page of {name} lacks the property {label_of(item)}"


def packed(help_file: Path) -> tuple:
    """The files of the help, and its table of contents."""
    base = sqlite3.connect(help_file.as_uri() + "?mode=ro", uri=True)
    files = {name: zlib.decompress(data[4:]) for name, data in base.execute(QUERY)}
    return files, b"".join(row[0] for row in base.execute(CONTENTS))


def main(documentation: Path, made: Path, help_file: Path, xmls: list) -> int:
    proxies = read_proxies(xmls)
    expected = {path.name: path.read_bytes() for path in made.iterdir()}
    contents = (made.parent / "toc.xml").read_text().encode("utf-16-be")
    files = expected
    if help_file.name != "-":
        files, contents = packed(help_file)
    wrong = [f"{name} is not in {help_file}" for name in expected if files.get(name) != expected[name]]
    wrong += [f"{name} is not ours" for name in files if name not in expected]
    wrong += proxy_complaints(proxies, files)
    pages = {name: data.decode() for name, data in files.items() if name.endswith(".html")}
    for name, text in pages.items():
        wrong += dead_links(name, text, files)
    listed = {name for name in pages if name.encode("utf-16-be") in contents}
    same = {name: {other for other in pages if pages[other] == text} for name, text in pages.items()}
    unlisted = [name for name in pages if not same[name] & listed]
    wrong += [f"{name} is not in the table of contents: filters.md has no link to it" for name in unlisted]
    references = re.findall('ref="([^"]+)"', (made.parent / "toc.xml").read_text())
    wrong += [f"toc.xml: there is no {name}" for name in references if name not in files]
    wrong += [f"{name} is too wide" for name, data in files.items() if name.endswith(".png") and width(data) > WIDEST]
    titles = {html.escape(title_of(path.read_text()), quote=False) for path in documentation.glob("*.md")}
    wrong += [f"{name} is none of our pages" for name, text in pages.items()
              if (found := re.search("<title>(.*) - Tautline</title>", text)) is None or found[1] not in titles]
    print("\n".join(wrong + [f"{len(proxies)} proxies, {len(files)} files in the help, {len(wrong)} wrong"]))
    return 1 if wrong or not proxies else 0


if __name__ == "__main__":
    paths = [Path(argument).resolve() for argument in sys.argv[1:]]
    sys.path.insert(0, str(paths[0]))
    from make_pages import title_of  # noqa: E402
    from property_table import is_listed, label_of, read_proxies  # noqa: E402

    sys.exit(main(paths[0], paths[1], paths[2], paths[3:]))
