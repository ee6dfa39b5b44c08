# SPDX-License-Identifier: BSD-3-Clause
"""check_links.py SOURCE_TREE: links and pictures of the documents and help pages lead to something in the tree."""

import re
import sys
from pathlib import Path

LINK = re.compile(r'\]\(([^)\s]+)\)|(?:href|src)="([^"]+)"')
ANCHOR = re.compile(r"""(?:name|id)=["']([^"']+)["']""")
OUTSIDE = re.compile(r"[a-z]+:")
MOST_BYTES = 150_000  # of a picture
WIDEST = 1200  # pixels of a picture; pages show wide ones scaled


def anchors(path: Path) -> set:
    text = path.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE) if path.suffix == ".md" else []
    return set(ANCHOR.findall(text)) | {re.sub(r"[^\w -]", "", h).strip().lower().replace(" ", "-") for h in headings}


def complaint(page: Path, link: str):
    """The error of a link, or None."""
    target, _, anchor = link.partition("#")
    if OUTSIDE.match(link):
        return None
    path = page.parent / target if target else page
    if not path.exists():
        return "leads nowhere"
    if anchor and anchor not in anchors(path):
        return "has no such anchor"
    if path.suffix == ".png" and path.stat().st_size > MOST_BYTES:
        return f"is a picture of {path.stat().st_size} bytes, {MOST_BYTES} are allowed"
    if path.suffix == ".png" and int.from_bytes(path.read_bytes()[16:20], "big") > WIDEST:
        return f"is a picture wider than {WIDEST} pixels"
    return None


def main(top: Path) -> int:
    pages = [*top.glob("*.md"), *(top / "Data").glob("*.md"), *(top / "Plugin/Site").glob("*.md"),
             *(top / "Plugin/Packaging").glob("*.md"), *(top / "Plugin/Documentation").glob("*.md"),
             *(top / "Plugin/Documentation").glob("*.html")]
    links = [(page, a or b) for page in pages for a, b in LINK.findall(page.read_text(encoding="utf-8"))]
    wrong = [f"{page}: {link} {said}" for page, link in links if (said := complaint(page, link))]
    print("\n".join(wrong + [f"{len(pages)} pages, {len(links)} links, {len(wrong)} wrong"]))
    return 1 if wrong or not links else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
