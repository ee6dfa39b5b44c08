# SPDX-License-Identifier: BSD-3-Clause
"""check_automation.py SOURCE_TREE: the files that forges and tools read parse, and do what the documents state.

Continuous integration calls .ci/run in a container of each supported Debian release; ./run docs makes the site that is
published; issue forms have what GitHub requires; the hooks of pre-commit are local and call every test of style that
needs no build; CITATION.cff has the keys of CFF 1.2.0.
"""

import datetime
import re
import sys
from pathlib import Path

try:
    import yaml
except ImportError:
    print("no python3-yaml: skipped")
    sys.exit(77)

FORMS = ".github/ISSUE_TEMPLATE"
FILES = (
    ".github/**/*.yml", ".github/**/*.yaml", ".gitlab-ci.yml", ".pre-commit-config.yaml", ".clang-format",
    ".clang-tidy", "CITATION.cff", "Plugin/Packaging/environment.yml",
)
ADVISORY = "sid"  # tested, but not supported
NEEDS_BUILD = {"check_server_manager.py"}
CITATION = {
    "cff-version", "message", "type", "title", "abstract", "version", "date-released", "license", "authors", "keywords",
    "references", "contact", "doi", "identifiers", "repository-code", "url", "preferred-citation",
}
NEEDED = {"cff-version", "message", "title", "abstract", "authors", "version", "date-released", "references"}
REFERENCE = {"type", "thesis-type", "title", "authors", "institution", "department", "month", "year", "url", "doi"}
ELEMENTS = {"markdown": "value", "textarea": "label", "input": "label", "dropdown": "label", "checkboxes": "label"}


class Tree:
    """The files of a source tree."""

    def __init__(self, top: Path):
        self.top = top

    def names(self, pattern: str) -> list[str]:
        return sorted(path.relative_to(self.top).as_posix() for path in self.top.glob(pattern))

    def text(self, name: str) -> str:
        return (self.top / name).read_text(encoding="utf-8")

    def yaml(self, name: str):
        return yaml.safe_load(self.text(name))


def supported(tree: Tree) -> list[str]:
    """Debian releases with a list of packages, without the one in development."""
    found = []
    for name in tree.names("Plugin/Packaging/requirements/debian-*"):
        if f"# Packages of Debian {ADVISORY}" not in tree.text(name):
            found.append(name.rpartition("-")[2])
    return found


def parsing(tree: Tree):
    for pattern in FILES:
        names = tree.names(pattern)
        if not names and "*" not in pattern:
            yield f"{pattern} is missing"
        for name in names:
            try:
                if tree.yaml(name) is None:
                    yield f"{name} is empty"
            except yaml.YAMLError as error:
                yield f"{name} does not parse: {' '.join(str(error).split())}"


def github(tree: Tree):
    workflow = tree.yaml(".github/workflows/ci.yml")
    events = workflow.get(True) or {}  # YAML 1.1 reads "on" as true
    if not {"push", "pull_request"} <= events.keys():
        yield "ci.yml does not run for each push and pull request"
    jobs = [job for job in workflow["jobs"].values() if any(step.get("run") == ".ci/run" for step in job["steps"])]
    releases = [release for job in jobs for release in job["strategy"]["matrix"]["release"]]
    if sorted(releases) != supported(tree):
        yield f"ci.yml calls .ci/run on {releases}, the supported releases are {supported(tree)}"
    if any(job["container"]["image"] != "debian:${{ matrix.release }}" for job in jobs):
        yield "ci.yml does not call .ci/run in the container of the release"
    steps = [step for job in tree.yaml(".github/workflows/docs.yml")["jobs"].values() for step in job["steps"]]
    paths = [step["with"]["path"] for step in steps if "/upload-pages-artifact@" in step.get("uses", "")]
    if not any(step.get("run") == "./run docs" for step in steps) or paths != ["build/site"]:
        yield "docs.yml does not publish the site of ./run docs"
    for name in tree.names(".github/workflows/*.yml"):
        for action in re.findall(r"uses: (\S+)", tree.text(name)):
            if not re.fullmatch(r"actions/[\w-]+@v\d+", action):
                yield f"{name} uses {action}, which is not an action of GitHub's with a version"


def gitlab(tree: Tree):
    jobs = tree.yaml(".gitlab-ci.yml")
    test = jobs["test"]
    releases = [release for entry in test["parallel"]["matrix"] for release in entry["RELEASE"]]
    if sorted(releases) != supported(tree) or test["image"] != "debian:$RELEASE" or test["script"] != [".ci/run"]:
        yield f".gitlab-ci.yml does not call .ci/run on {supported(tree)}"
    if "./run docs" not in jobs["pages"]["script"]:
        yield ".gitlab-ci.yml does not make the site by ./run docs"


def commands(tree: Tree):
    """Programs of the repository that the files call exist, and so do the commands of ./run."""
    offered = set(re.findall(r"^cmd_(\w+)\(\)", tree.text("run"), re.MULTILINE))
    for name in (*tree.names(".github/**/*.*"), ".gitlab-ci.yml", ".pre-commit-config.yaml", ".ci/run"):
        text = tree.text(name)
        for command in re.findall(r"\./run (\w+)", text):
            if command not in offered:
                yield f"{name} calls ./run {command}, which does not exist"
        for program in re.findall(r"(?:Testing|Plugin)/[\w/]+\.(?:py|sh|md)", text):
            if not (tree.top / program).is_file():
                yield f"{name} names {program}, which does not exist"


def forms(tree: Tree):
    names = [name for name in tree.names(f"{FORMS}/*.yml") if not name.endswith("/config.yml")]
    if not names:
        yield "there is no issue form"
    for name in names:
        form = tree.yaml(name)
        for key in ("name", "description", "body"):
            if not form.get(key):
                yield f"{name} has no {key}"
        elements = form.get("body") or []
        ids = [element["id"] for element in elements if "id" in element]
        if len(set(ids)) != len(ids):
            yield f"{name} has an id twice"
        for element in elements:
            kind, attributes = element.get("type"), element.get("attributes", {})
            if ELEMENTS.get(kind, "?") not in attributes:
                yield f"{name} has an element {kind} without what it needs"
            if kind in ("dropdown", "checkboxes") and not attributes.get("options"):
                yield f"{name} has {kind} without options"
            if kind != "markdown" and "id" not in element:
                yield f"{name} has an element {kind} without an id"


def hooks(tree: Tree):
    repositories = tree.yaml(".pre-commit-config.yaml")["repos"]
    if [repository["repo"] for repository in repositories] != ["local"]:
        yield ".pre-commit-config.yaml has hooks that are not local"
    entries = ""
    for hook in (hook for repository in repositories for hook in repository["hooks"]):
        if hook.get("language") != "system" or not hook.get("id") or not hook.get("name"):
            yield f"the hook {hook.get('id')} of .pre-commit-config.yaml has no name, or is installed"
        entries += hook.get("entry", "") + "\n"
    tests = {Path(name).name for name in tree.names("Testing/Style/check_*.py")} - NEEDS_BUILD
    for test in sorted(test for test in tests if f"Testing/Style/{test} " not in entries):
        yield f".pre-commit-config.yaml does not call {test}"


def citation(tree: Tree):
    data = tree.yaml("CITATION.cff")
    missing = NEEDED - data.keys()
    if missing or data.keys() - CITATION:
        yield f"CITATION.cff lacks {sorted(missing)}, or has keys that CFF does not: {sorted(data.keys() - CITATION)}"
    if data.get("cff-version") != "1.2.0" or data.get("type", "software") not in ("software", "dataset"):
        yield "CITATION.cff is not of version 1.2.0, or of another type than software"
    if not isinstance(data.get("version"), str) or not isinstance(data.get("date-released"), datetime.date):
        yield "CITATION.cff has a version or a date of a wrong type"
    for reference in data.get("references", []):
        if not {"type", "title", "authors"} <= reference.keys() or reference.keys() - REFERENCE:
            yield f"CITATION.cff has a reference with wrong keys: {sorted(reference)}"
        if "name" not in reference.get("institution", {"name": ""}) or not isinstance(reference.get("year"), int):
            yield "CITATION.cff has a reference with an institution without name, or without year"
    for author in (author for work in (data, *data.get("references", [])) for author in work.get("authors", [])):
        if author.keys() != {"name"} and not {"family-names", "given-names"} <= author.keys():
            yield f"CITATION.cff has an author that is neither a person nor an entity: {author}"


def tidy(tree: Tree):
    settings = tree.yaml(".clang-tidy")
    checks = [check.strip() for check in settings["Checks"].split(",") if check.strip()]
    if checks[:1] != ["-*"] or len(checks) < 2 or settings.get("WarningsAsErrors") != "*":
        yield ".clang-tidy does not name its checks one by one, with warnings as errors"


def complaints(tree: Tree) -> list[str]:
    found = list(parsing(tree))
    if not found:
        for check in (github, gitlab, commands, forms, hooks, citation, tidy):
            try:
                found += check(tree)
            except (AttributeError, KeyError, TypeError) as error:
                found.append(f"{check.__name__}: another structure than expected: {error!r}")
    return found


def main(top: Path) -> int:
    tree = Tree(top)
    found = complaints(tree)
    print(*found, f"{len(found)} complaints; supported: Debian {', '.join(supported(tree))}", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
