"""check_help.py DOCUMENTATION QCH: ParaView's help of the plugin has every page and picture, as they are now.

The .qch file is an SQLite data base; a file's data are compressed, after four bytes with their length.
"""

import sqlite3
import sys
import zlib
from pathlib import Path

KINDS = (".html", ".css", ".png")
QUERY = "SELECT Name, Data FROM FileNameTable JOIN FileDataTable ON Id = FileId WHERE Data IS NOT NULL"
CONTENTS = "SELECT Data FROM ContentsTable"


def main(pages: Path, help_file: Path) -> int:
    base = sqlite3.connect(help_file.as_uri() + "?mode=ro", uri=True)
    found = {name: zlib.decompress(data[4:]) for name, data in base.execute(QUERY)}
    wanted = [path for path in pages.iterdir() if path.suffix in KINDS]
    wrong = 0
    for path in sorted(wanted):
        if found.get(path.name) != path.read_bytes():
            print(f"{path.name} is {'another one' if path.name in found else 'missing'} in {help_file}")
            wrong += 1
    contents = b"".join(row[0] for row in base.execute(CONTENTS))
    for page in (path for path in wanted if path.suffix == ".html"):
        if page.name.encode("utf-16-be") not in contents:
            print(f"{page.name} is not in the table of contents, toc.xml")
            wrong += 1
    print(f"{len(wanted)} files, {len(found)} in the help, {wrong} wrong")
    return 1 if wrong or not wanted else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
