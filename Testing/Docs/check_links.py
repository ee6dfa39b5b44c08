"""check_links.py SOURCE_TREE: links and pictures of the documents and help pages lead to something in the tree."""

import re
import sys
from pathlib import Path

LINK = re.compile(r'\]\(([^)\s]+)\)|(?:href|src)="([^"]+)"')
ANCHOR = re.compile(r'name="([^"]+)"')
OUTSIDE = re.compile(r"[a-z]+:")
PROXY = re.compile(r"(?:filters|sources|readers|writers)\.(\w+)\.html$")  # a page ParaView makes from the XML
MOST_BYTES = 150_000  # of a picture


def anchors(path: Path) -> set:
    text = path.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE) if path.suffix == ".md" else []
    return set(ANCHOR.findall(text)) | {re.sub(r"[^\w -]", "", h).strip().lower().replace(" ", "-") for h in headings}


def complaint(page: Path, link: str, proxies: set):
    """What is wrong with a link, or None."""
    target, _, anchor = link.partition("#")
    proxy = PROXY.match(target)
    if OUTSIDE.match(link) or (proxy and proxy[1] in proxies):
        return None
    path = page.parent / target if target else page
    if not path.exists():
        return "leads nowhere"
    if anchor and anchor not in anchors(path):
        return "has no such anchor"
    if path.suffix == ".png" and path.stat().st_size > MOST_BYTES:
        return f"is a picture of {path.stat().st_size} bytes, {MOST_BYTES} are allowed"
    return None


def main(top: Path) -> int:
    texts = (xml.read_text() for xml in (top / "ServerManager").glob("*.xml*"))
    proxies = {name for text in texts for name in re.findall(r'Proxy class="\w+" name="(\w+)"', text)}
    pages = [*top.glob("*.md"), *(top / "Data").glob("*.md"), *(top / "Plugin/Documentation").glob("*.html")]
    links = [(page, a or b) for page in pages for a, b in LINK.findall(page.read_text(encoding="utf-8"))]
    wrong = [f"{page}: {link} {said}" for page, link in links if (said := complaint(page, link, proxies))]
    print("\n".join(wrong + [f"{len(pages)} pages, {len(links)} links, {len(wrong)} wrong"]))
    return 1 if wrong or not links else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
