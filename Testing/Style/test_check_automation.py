# SPDX-License-Identifier: BSD-3-Clause
"""test_check_automation.py SOURCE_TREE: check_automation.py reports what is wrong in a file, and nothing else."""

import sys
from pathlib import Path

import check_automation

CI, DOCS, LAB = ".github/workflows/ci.yml", ".github/workflows/docs.yml", ".gitlab-ci.yml"
BUG, HOOKS, CITED = ".github/ISSUE_TEMPLATE/bug.yml", ".pre-commit-config.yaml", "CITATION.cff"
#: A file, a text in it, what stands there instead, and a part of the complaint.
VIOLATIONS = (
    (CI, "jobs:\n", "jobs: [\n", "does not parse"),
    (CI, "release: [bookworm, trixie]", "release: [bookworm]", "the supported releases are"),
    (CI, "release: [bookworm, trixie]", "release: [bookworm, trixie, sid]", "the supported releases are"),
    (CI, "image: debian:${{ matrix.release }}", "image: ubuntu:24.04", "in the container of the release"),
    (CI, "run: .ci/run", "run: ./run test", "calls .ci/run on []"),
    (CI, "  pull_request:\n", "", "for each push and pull request"),
    (CI, "actions/checkout@v4", "somebody/checkout@v4", "not an action of GitHub's"),
    (CI, "actions/checkout@v4", "actions/checkout@main", "not an action of GitHub's"),
    (CI, "jobs:", "work:", "another structure"),
    (DOCS, "./run docs", "./run demo", "does not publish the site"),
    (DOCS, "path: build/site", "path: build", "does not publish the site"),
    (LAB, "- RELEASE: [bookworm, trixie]", "- RELEASE: [trixie]", "does not call .ci/run"),
    (LAB, "./run docs", "./run site", "calls ./run site, which does not exist"),
    (BUG, "name: Bug report\n", "", "has no name"),
    (BUG, "id: steps", "id: what", "has an id twice"),
    (BUG, "type: dropdown", "type: menu", "without what it needs"),
    (BUG, "      label: Steps\n", "", "without what it needs"),
    (HOOKS, "repo: local", "repo: https://example.org/hooks", "not local"),
    (HOOKS, "language: system", "language: python", "is installed"),
    (HOOKS, "check_layers.py", "check_files.py", "does not call check_layers.py"),
    (HOOKS, "check_files.py", "check_nothing.py", "which does not exist"),
    (CITED, "abstract:", "summary:", "lacks ['abstract'], or has keys that CFF does not: ['summary']"),
    (CITED, "cff-version: 1.2.0", "cff-version: 1.0.3", "is not of version 1.2.0"),
    (CITED, "date-released: 20", "date-released: in 20", "date of a wrong type"),
    (CITED, "    institution:\n      name:", "    institution:\n      title:", "institution without name"),
    (CITED, "    title: Opt", "    name: Opt", "reference with wrong keys"),
    (CITED, "family-names", "last-name", "neither a person nor an entity"),
    (".clang-tidy", "-*,", "", "one by one"),
    (".clang-tidy", "WarningsAsErrors", "Warnings", "one by one"),
)


class Changed(check_automation.Tree):
    """A source tree with another text in one file."""

    def __init__(self, top: Path, name: str, old: str, new: str):
        super().__init__(top)
        self.name = name
        self.changed = super().text(name).replace(old, new)
        assert self.changed != super().text(name), f"{name} has no {old!r}"

    def text(self, name: str) -> str:
        return self.changed if name == self.name else super().text(name)


def main(top: Path) -> None:
    assert check_automation.complaints(check_automation.Tree(top)) == []
    for name, old, new, part in VIOLATIONS:
        found = check_automation.complaints(Changed(top, name, old, new))
        assert any(part in text for text in found), (name, old, new, found)
    print(f"{len(VIOLATIONS)} violations found")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
