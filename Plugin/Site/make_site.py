# SPDX-License-Identifier: BSD-3-Clause
"""make_site.py SOURCE WORK OUTPUT VERSION BUILD: makes the site of all documents with Sphinx, and checks its links.

The pages are README.md, Plugin/Site, CONTRIBUTING.md, CHANGELOG.md, SECURITY.md, the help pages of the plugin with the
tables of properties from the XML in the build tree BUILD, the gallery, the reference of Python and of C++, and the
report of the studies. Links between files of the repository lead to the pages made of these files.
"""

import html
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

from cxx_pages import cxx_pages
from gallery_pages import PICTURES, gallery_pages
from python_pages import python_pages

HELP = "Plugin/Documentation"
SITE = "Plugin/Site"
#: Files outside these two directories, and the names of their pages.
PAGES = {
    "README.md": "index",
    "CONTRIBUTING.md": "contributing",
    "CHANGELOG.md": "changes",
    "SECURITY.md": "security",
    "CODE_OF_CONDUCT.md": "conduct",
    "Plugin/Packaging/requirements.md": "requirements",
    f"{HELP}/studies.html": "studies_report",
    f"{HELP}/studies_more.html": "studies_more",
}
MATHJAX = Path("/usr/share/javascript/mathjax")  # Debian's package libjs-mathjax, version 2
#: What the site uses of it.
MATHJAX_PARTS = ("MathJax.js", "config/TeX-AMS_SVG.js", "extensions", "jax/element", "jax/input/TeX", "jax/output/SVG")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\(([^)\s]+)\)")
COMMENT = re.compile(r"^<!--.*?-->\n", re.MULTILINE | re.DOTALL)
MATH = re.compile(r"^\$\$\n(.*?)\n\$\$$", re.MULTILINE | re.DOTALL)
FENCE = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)
REFERENCE = re.compile(r"""(?:href|src)=["']([^"']+)["']""")
ANCHOR = re.compile(r"""(?:id|name)=["']([^"']+)["']""")
OUTSIDE = re.compile(r"[a-z]+:|//")
HEADING = re.compile(r"<h([1-4])(?: id=[\"']([^\"']+)[\"'])?>(?:<a name=\"([^\"]+)\"></a>)?(.*?)</h\1>", re.DOTALL)
STYLE = re.compile(r"<style>(.*?)</style>", re.DOTALL)


class Site:
    """The tree of Markdown that Sphinx reads."""

    def __init__(self, source: Path, work: Path, proxies: dict):
        self.source, self.work, self.proxies = source, work, proxies
        shutil.rmtree(work, ignore_errors=True)
        (work / "extra").mkdir(parents=True)
        (work / "static").mkdir()
        for directory, kinds in ((HELP, ("*.png",)), ("Data", ("*",)), (PICTURES, ("*.png",))):
            target = work / "extra" / directory
            target.mkdir(parents=True)
            for path in (path for kind in kinds for path in (source / directory).glob(kind) if path.is_file()):
                shutil.copyfile(path, target / path.name)
        for part in MATHJAX_PARTS if MATHJAX.is_dir() else ():
            target = work / "static/mathjax" / part
            target.parent.mkdir(parents=True, exist_ok=True)
            copy = shutil.copytree if (MATHJAX / part).is_dir() else shutil.copyfile
            copy(MATHJAX / part, target)

    def target(self, page: Path, link: str) -> str:
        """Where a link of a file leads in the site; empty for a file that the site does not have."""
        path, mark, anchor = link.partition("#")
        if OUTSIDE.match(link) or not path:
            return link
        name = Path(os.path.relpath(page.parent / path, self.source)).as_posix()
        if name in PAGES:
            return f"{PAGES[name]}.html{mark}{anchor}"
        if name.startswith((f"{SITE}/", f"{HELP}/")) and name.endswith(".md"):
            return f"{Path(name).stem}.html{mark}{anchor}"
        if name.startswith((f"{HELP}/", "Data/", PICTURES)):
            return f"{name}{mark}{anchor}"
        return ""

    def linked(self, page: Path, text: str) -> str:
        """Markdown with its links as raw HTML, so that they are taken as they are; not in blocks of code."""

        def fill(match) -> str:
            target = self.target(page, match[3])
            if match[1]:
                return f'<img src="{target}" alt="{html.escape(match[2])}">'
            inner = LINK.sub(fill, match[2])
            return f'<a href="{target}">{inner}</a>' if target else f"`{inner}`"

        parts = FENCE.split(text)
        parts[::2] = [LINK.sub(fill, part) for part in parts[::2]]
        return "".join(parts)

    def add(self, page: Path, name: str) -> None:
        """A page of the site from a file in Markdown."""
        text = page.read_text(encoding="utf-8")
        text = with_tables(text, self.proxies, page.name)
        text = MATH.sub(lambda match: f"```{{math}}\n{match[1]}\n```", COMMENT.sub("", text))
        self.write(name, self.linked(page, text))

    def add_report(self, page: Path, name: str) -> None:
        """A page of the site from a report in HTML: its headings are headings of the site."""
        text = page.read_text(encoding="utf-8")
        for file, made in PAGES.items():
            text = re.sub(rf"""(href=["']){re.escape(Path(file).name)}""", rf"\1{made}.html", text)
        text = re.sub(r"""(src=["'])(?!data:)""", rf"\1{HELP}/", text)
        styles = [re.sub(r"^body .*$", "", match, flags=re.MULTILINE) for match in STYLE.findall(text)]
        style = "".join(f"<style>\n{one}</style>\n" for one in styles)
        body = text.split("<body>", 1)[1].split("</body>", 1)[0]
        parts, end = [], 0
        for match in HEADING.finditer(body):
            anchor = match[2] or match[3]
            parts += [raw(body[end : match.start()]), f'<a id="{anchor}"></a>\n\n' if anchor else "",
                      f"{'#' * int(match[1])} {html.unescape(match[4])}\n\n"]  # fmt: skip
            parts += [raw(style)] if match[1] == "1" else []
            end = match.end()
        self.write(name, "".join([*parts, raw(body[end:])]))

    def write(self, name: str, text: str) -> None:
        """Raises ValueError if there is a page of this name."""
        page = self.work / f"{name}.md"
        if page.exists():
            raise ValueError(f"two pages have the name {name}")
        page.write_text(text, encoding="utf-8")

    def add_all(self) -> None:
        for directory in (SITE, HELP):
            for page in sorted((self.source / directory).glob("*.md")):
                if page.stem != "index":  # its lists of pages follow the text of README.md
                    self.add(page, page.stem)
        for file, name in PAGES.items():
            page = self.source / file
            if page.suffix == ".html":
                self.add_report(page, name)
            elif page.is_file():
                self.add(page, name)
        toctrees = (self.source / SITE / "index.md").read_text(encoding="utf-8").split("```{toctree}", 1)[1]
        with (self.work / "index.md").open("a", encoding="utf-8") as file:
            file.write(f"\n```{{toctree}}{toctrees}")
        placed = set(re.findall(r"^[\w-]+$", toctrees, re.MULTILINE))
        rest = "\n".join(page.stem for page in sorted((self.source / HELP).glob("*.md")) if page.stem not in placed)
        with (self.work / "filters.md").open("a", encoding="utf-8") as file:
            file.write(f"\n```{{toctree}}\n:hidden:\n{rest}\n```\n")
        made = python_pages() | cxx_pages(self.source) | gallery_pages(self.source)
        for name, text in made.items():
            self.write(name, text)
        shutil.copyfile(self.source / SITE / "conf.py", self.work / "conf.py")
        shutil.copyfile(self.source / SITE / "style.css", self.work / "static/style.css")


def raw(body: str) -> str:
    """A block of HTML that Sphinx takes as it is."""
    return f"`````{{raw}} html\n{body.strip()}\n`````\n\n" if body.strip() else ""


def dead_links(output: Path):
    """Links of every page that lead to no file or no anchor of the site."""
    pages = [page for page in output.rglob("*.html") if "_static" not in page.parts]
    texts = {page: page.read_text(encoding="utf-8", errors="replace") for page in pages}
    anchors = {page: set(ANCHOR.findall(text)) for page, text in texts.items()}
    for page, text in texts.items():
        for link in REFERENCE.findall(text):
            target, _, anchor = unquote(html.unescape(link)).partition("#")
            path = (page.parent / target.split("?")[0]).resolve() if target else page
            if OUTSIDE.match(link):
                continue
            if not path.exists():
                yield f"{page.relative_to(output)}: {link} leads nowhere"
            elif anchor and path in anchors and anchor not in anchors[path]:
                yield f"{page.relative_to(output)}: {link} has no such anchor"


def main(source: Path, work: Path, output: Path, version: str, build: Path) -> int:
    Site(source, work, read_proxies(find_files(build))).add_all()
    shutil.rmtree(output, ignore_errors=True)
    environment = dict(os.environ, TAUTLINE_VERSION=version)
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", str(work), str(output)]
    if subprocess.run(command, env=environment).returncode:
        return 1
    wrong = list(dead_links(output))
    pages = len(list(output.glob("*.html")))
    print("\n".join([*wrong, f"{pages} pages, {len(wrong)} dead links: {output / 'index.html'}"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    tree, made, site, number, binary = sys.argv[1:6]
    sys.path.append(str(Path(tree).resolve() / HELP))
    from make_pages import with_tables  # noqa: E402
    from property_table import find_files, read_proxies  # noqa: E402

    sys.exit(main(Path(tree).resolve(), Path(made).resolve(), Path(site).resolve(), number, Path(binary).resolve()))
