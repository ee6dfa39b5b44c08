# SPDX-License-Identifier: BSD-3-Clause
"""make_site.py SOURCE WORK OUTPUT VERSION: makes the site of all documents with Sphinx, and checks its links.

The pages are README.md, Plugin/Site, CONTRIBUTING.md, CHANGELOG.md, SECURITY.md and the help pages of the plugin, which
are taken as they are. Links between them are those of the repository; in the site they lead to the pages made of these
files.
"""

import html
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

from cxx_pages import cxx_pages

HELP = "Plugin/Documentation"
#: Files outside Plugin/Site, and the names of their pages.
PAGES = {
    "README.md": "index",
    "CONTRIBUTING.md": "contributing",
    "CHANGELOG.md": "changes",
    "SECURITY.md": "security",
    "Plugin/Packaging/requirements.md": "requirements",
}
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
COMMENT = re.compile(r"^<!--.*?-->\n", re.MULTILINE)
REFERENCE = re.compile(r'(?:href|src)="([^"]+)"')
ANCHOR = re.compile(r'(?:id|name)="([^"]+)"')
GALLERY = "python/examples"
GALLERY_HEAD = """# Gallery

Every example is a script in `python/examples`, which a test runs: `python3 02_untangle.py Data`. Pictures show the mesh
before and after; blue is good, red is bad, and where nothing else is said the range of the colours is 1 to 3 of the
inverse mean ratio. The seconds of processor time and the memory are those of the whole script on one machine, most of
them for loading the libraries. Some examples are C++ programs, too, in `python/examples/cxx`; a test builds and runs
these.
"""
LABEL = re.compile(r"^(Shell|Look at|State|Picture): (.*)$", re.MULTILINE)
CONTINUED = re.compile(r"\\\n *")
STATE = """# {title}
from paraview.simple import *

before = OpenDataFile("before.vtu")  # which the script below writes
after = {call}
Show(after)
{last}Render()
"""
LAST_STEP = """GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
"""
WIDTH = 80  # of a signature in one line
OUTSIDE = re.compile(r"[a-z]+:|//")


class Site:
    """The tree of Markdown that Sphinx reads."""

    def __init__(self, source: Path, work: Path):
        self.source, self.work = source, work
        shutil.rmtree(work, ignore_errors=True)
        (work / "extra").mkdir(parents=True)
        for directory in (HELP, "Data", f"{GALLERY}/pictures"):
            names = shutil.ignore_patterns("*.py", "*.in", "*.cmake")
            shutil.copytree(source / directory, work / "extra" / directory, ignore=names)

    def target(self, page: Path, link: str) -> str:
        """Where a link of a file leads in the site; pictures are relative to the repository, too."""
        path, mark, anchor = link.partition("#")
        if OUTSIDE.match(link) or not path:
            return link
        name = Path(os.path.relpath(page.parent / path, self.source)).as_posix()
        if name in PAGES:
            return f"{PAGES[name]}.html{mark}{anchor}"
        if name.startswith("Plugin/Site/") and name.endswith(".md"):
            return f"{Path(name).stem}.html{mark}{anchor}"
        if name.startswith((HELP, "Data/")):
            return f"{name}{mark}{anchor}"
        return ""  # a file of the sources, which the site does not have

    def add(self, page: Path, name: str) -> None:
        """A page of the site, with its links as raw HTML so that they are taken as they are."""

        def fill(match) -> str:
            target = self.target(page, match[2])
            text = match[1][1:-2] if match[1].startswith("[") else match[1][2:-2]
            if match[1].startswith("!"):
                return f'<img src="{target}" alt="{html.escape(text)}">'
            return f'<a href="{target}">{text}</a>' if target else f"`{text}`"

        text = COMMENT.sub("", page.read_text(encoding="utf-8"))
        parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
        parts[::2] = [LINK.sub(fill, part) for part in parts[::2]]
        (self.work / f"{name}.md").write_text("".join(parts), encoding="utf-8")

    def add_all(self) -> None:
        for page in (self.source / "Plugin/Site").glob("*.md"):
            self.add(page, page.stem)
        for name, page in PAGES.items():
            self.add(self.source / name, page if page != "index" else "readme")
        toctrees = (self.work / "index.md").read_text(encoding="utf-8").split("```{toctree}", 1)[1]
        readme = (self.work / "readme.md").read_text(encoding="utf-8")
        (self.work / "index.md").write_text(f"{readme}\n```{{toctree}}{toctrees}", encoding="utf-8")
        (self.work / "readme.md").unlink()
        (self.work / "python.md").write_text(python_page(), encoding="utf-8")
        for name, text in cxx_pages(self.source).items():
            (self.work / f"{name}.md").write_text(text, encoding="utf-8")
        (self.work / "tutorial.md").write_text(help_page("Tutorial", "tutorial.html", "index.html", "jobs.html"))
        (self.work / "gallery.md").write_text(gallery_page(self.source), encoding="utf-8")
        shutil.copyfile(self.source / "Plugin/Site/conf.py", self.work / "conf.py")
        (self.work / "static").mkdir()
        shutil.copyfile(self.source / "Plugin/Site/style.css", self.work / "static/style.css")


def signature_of(name: str, value) -> str:
    """As in a call, an argument a line where there are many."""
    try:
        signature = str(inspect.signature(value))
    except ValueError:  # a class made of C
        return name
    if len(signature) <= WIDTH:
        return name + signature
    return name + re.sub(r"(^\(|, (?=\w+: |\*))", lambda match: f"{match[0].strip()}\n    ", signature)


def python_page() -> str:
    """Every public function and class of results of the package, with its docstring as it is."""
    import tautline

    parts = [f"# Python\n\n```text\n{inspect.getdoc(tautline)}\n```\n"]
    for name, value in sorted(vars(tautline).items()):
        if callable(value) and not name.startswith(("_", "vtk")):
            text = inspect.getdoc(value) or ""
            parts.append(f"## {name}\n\n```python\n{signature_of(name, value)}\n```\n\n```text\n{text}\n```\n")
    return "\n".join(parts)


def help_page(title: str, *pages: str) -> str:
    links = "\n".join(f'- <a href="{HELP}/{page}">{Path(page).stem}</a>' for page in pages)
    return f"# {title}\n\nThe pages of ParaView's help:\n\n{links}\n"


def parts_of(script: str) -> tuple[str, str, dict[str, list[str]]]:
    """The title, the text and the labelled lines of an example; a backslash continues a line."""
    title, _, rest = script.split('"""')[1].partition("\n")
    joined = CONTINUED.sub("", rest)
    lines: dict[str, list[str]] = {}
    for key, value in LABEL.findall(joined):
        lines.setdefault(key, []).append(value)
    return title, LABEL.sub("", joined).strip(), lines


def state_of(title: str, call: str) -> str:
    """The Python state file of an example, which Testing/Docs/gallery_states.py runs."""
    return STATE.format(title=title, call=call, last=LAST_STEP if "TimeScheme" in call else "")


def gallery_page(source: Path) -> str:
    """The examples: title, picture and text of the docstring, cost, and the script. A test runs each of them."""
    folder = source / GALLERY
    facts = json.loads((folder / "measured.json").read_text(encoding="utf-8"))
    parts = [GALLERY_HEAD]
    for script in sorted(folder.glob("[0-9]*.py")):
        text = script.read_text(encoding="utf-8")
        title, rest, lines = parts_of(text)
        code = text.split('"""', 2)[2].strip()
        parts.append(f"## {title.rstrip('.')}\n")
        if (folder / "pictures" / f"{script.stem}.png").exists():
            name = html.escape(f"{title.rstrip('.')}: before and after")
            parts.append(f'<img src="{GALLERY}/pictures/{script.stem}.png" alt="{name}">\n')
        parts.append(rest + "\n")
        if "Look at" in lines:
            look = lines["Look at"][0]
            parts.append(f"**What to look at.** {look[0].upper()}{look[1:]}\n")
        if "Shell" in lines:
            commands = "\n".join(lines["Shell"])
            parts.append(f"On the shell:\n\n```sh\n{commands}\n```\n")
        if "State" in lines:
            state = state_of(title, lines["State"][0])
            parts.append(f"In ParaView, a file to open with *File > Load State*:\n\n```python\n{state}```\n")
        cost = facts[script.stem]
        parts.append(f"In Python, `{GALLERY}/{script.name}`, {cost['seconds']} s and {cost['memory']} MiB:\n")
        parts.append(f"```python\n{code}\n```\n")
        program = folder / "cxx" / f"{script.stem}.cxx"
        if program.exists():
            body = program.read_text(encoding="utf-8").split("\n", 1)[1].strip()
            parts.append(f"In C++, `{GALLERY}/cxx/{program.name}`, with the CMake file beside it:\n")
            parts.append(f"```cpp\n{body}\n```\n")
    return "\n".join(parts)


def dead_links(output: Path):
    """Links of every page that lead to no file or no anchor of the site."""
    texts = {page: page.read_text(encoding="utf-8", errors="replace") for page in output.rglob("*.html")}
    anchors = {page: set(ANCHOR.findall(text)) for page, text in texts.items()}
    for page, text in texts.items():
        for link in REFERENCE.findall(text):
            target, _, anchor = unquote(html.unescape(link)).partition("#")
            path = (page.parent / target.split("?")[0]).resolve() if target else page
            if OUTSIDE.match(link) or target.startswith("../../"):  # from the help to the sources
                continue
            if not path.exists():
                yield f"{page.relative_to(output)}: {link} leads nowhere"
            elif anchor and path in anchors and anchor not in anchors[path]:
                yield f"{page.relative_to(output)}: {link} has no such anchor"


def main(source: Path, work: Path, output: Path, version: str) -> int:
    Site(source, work).add_all()
    shutil.rmtree(output, ignore_errors=True)
    environment = dict(os.environ, TAUTLINE_VERSION=version)
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", str(work), str(output)]
    if subprocess.run(command, env=environment).returncode:
        return 1
    wrong = list(dead_links(output))
    pages = len(list(output.rglob("*.html")))
    print("\n".join([*wrong, f"{pages} pages, {len(wrong)} dead links: {output / 'index.html'}"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*(Path(argument).resolve() for argument in sys.argv[1:4]), sys.argv[4]))
