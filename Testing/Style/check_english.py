#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""check_english.py SOURCE_TREE: comments, texts and documents use plain American English.

Prints file, line, pattern and words of each hit, and the hits of each pattern by folder. In C++ and Python only
comments and strings with several words are checked, not names; other files are checked as a whole. Words in quotation
marks or backticks, and parts of names and paths, are not spelling errors.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from pathlib import Path

from check_files import DIRECTORIES

LANGUAGES = {".h": "c++", ".cxx": "c++", ".py": "python"}
PLAIN = {".cff", ".cmake", ".html", ".in", ".json", ".md", ".module", ".plugin", ".qrc", ".sh", ".svg", ".toml", ".txt",
         ".xml", ".yml"}  # fmt: skip
NAMES = {"run", "triggers"}
#: Data, findings of studies, the list of changes, and the files that contain the patterns.
SKIPPED = re.compile(
    r"Testing/(Baseline|Fuzz/Corpus|States)/|python/studies/evidence/|CHANGELOG|(.*/)?__pycache__/"
    r"|Testing/Style/(test_)?check_english\.py"
)

_BRITISH = (
    "neighbours? neighbouring neighbourhoods? colours? coloured colouring centres? centred"
    " behaviours? licences? licenced analysed? analysing greys? greyed labelled labelling modelled"
    " modelling (?:nano|micro|milli|centi|kilo)?metres?"
    " (?:re)?(?:optimi|minimi|maximi|vectori|orthogonali|normali|recogni)s(?:ed?|ing|ation)"
)
#: By name: the pattern, and how many hits are allowed in all files together.
PATTERNS = {
    "those of, that of": (r"\bth(?:at|ose)\s+of\b", 60),
    "sentence begins with Of": (r"(?<![\w,]\s)\bOf(?=\s)", 0),
    "refuse": (r"\brefus\w*", 0),
    "anew": (r"(?<![\w-])anew\b", 0),  # not in an identifier of a text
    "so many": (r"\bso\s+many\b", 0),
    "mend": (r"\bmend(?:s|ed|ing)?\b", 0),
    "but for": (r"\(but\s+for\b|\bbut\s+for\s+(?:the|a|an|its|their|those|this|one|rounding)\b", 0),
    "British spelling": (
        # Neither a part of a name or path, nor a parameter, nor an attribute of a numpydoc section.
        rf"\b(?<!@param )(?<![./\"'`-])(?:{_BRITISH.replace(' ', '|')})(?![\w\"'`_(]|\.\w|-\w+\.|(?:, \w+)* : )",
        0,
    ),
}
COMPILED = {
    name: re.compile(pattern, 0 if "Of" in name else re.IGNORECASE) for name, (pattern, _) in PATTERNS.items()
}

_STRING = r'"(?:\\.|[^"\\\n])*"'
_CHARACTER = r"'(?:\\.|[^'\\\n])*'"
#: Comments and strings.
TOKENS = {
    "c++": rf'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|{_STRING}|(?<![0-9a-fA-F]){_CHARACTER}',
    "python": rf'#[^\n]*|[rRbBfFuU]{{0,2}}(?:"""(?:\\.|[^\\])*?"""|{_STRING}|{_CHARACTER})',
}
TOKENS = {language: re.compile(pattern, re.DOTALL) for language, pattern in TOKENS.items()}
#: The marks at the beginning of a line of a comment, and the quotation marks of a string.
MARKS = re.compile(
    r"^[ \t]*(?:///?!?<?|/?\*+/?|#[:!]?)|\*/$|^[ \t]*(?:[rRbBfFuU]{0,2}\"{1,3}|')|(?:\"{1,3}|')$", re.MULTILINE
)
#: Stands for code between two pieces of prose.
CODE = "\x01"


def blank(text: str, filler: str) -> str:
    """As many characters, with the line ends."""
    return re.sub(r"[^\n]", filler, text)


def words_of(token: str) -> str:
    """A comment or a string without its marks; a string of one word is code, unless it ends a longer text."""
    quoted = token.lstrip("rRbBfFuU")[:1] in ("'", '"')
    if quoted and " " not in token:
        return blank(token, CODE)
    text = MARKS.sub(lambda marks: " " * len(marks[0]), token)
    return text.replace("\\n", ". ") if quoted else text


def prose(text: str, language: str | None) -> str:
    """The comments and texts of a source at their places; code is replaced by CODE, a character each."""
    if language not in TOKENS:
        return text
    result, end = [], 0
    for token in TOKENS[language].finditer(text):
        between = text[end : token.start()]
        # Adjacent strings are one text, and so are the lines of a comment.
        result += [blank(between, CODE) if between.strip() else between, words_of(token[0])]
        end = token.end()
    return "".join(result) + blank(text[end:], CODE)


def hits(text: str, language: str | None) -> list[tuple[int, str, str]]:
    """Line, name of the pattern and words of each hit."""
    words = prose(text, language)
    return sorted(
        (words.count("\n", 0, match.start()) + 1, name, " ".join(match[0].split()))
        for name, pattern in COMPILED.items()
        for match in pattern.finditer(words)
    )


def sources(top: Path):
    for path in [*top.iterdir(), *(path for name in (*DIRECTORIES, "Data") for path in (top / name).rglob("*"))]:
        if path.suffix in LANGUAGES or path.suffix in PLAIN or path.name in NAMES:
            if path.is_file() and not SKIPPED.match(path.relative_to(top).as_posix()):
                yield path


def main(top: Path) -> int:
    files, counts, folders = sorted(sources(top)), Counter(), Counter()
    for path in files:
        name = path.relative_to(top).as_posix()
        for line, pattern, words in hits(path.read_text(encoding="utf-8"), LANGUAGES.get(path.suffix)):
            print(f"{name}:{line}: {pattern}: {words}")
            counts[pattern] += 1
            folders[pattern, name.split("/")[0]] += 1
    wrong = 0
    for pattern, (_, allowed) in PATTERNS.items():
        where = ", ".join(f"{count} in {folder}" for (other, folder), count in folders.items() if other == pattern)
        print(f"{pattern}: {counts[pattern]}, {allowed} allowed{': ' if where else ''}{where}")
        wrong += counts[pattern] > allowed
    print(f"{len(files)} files, {wrong} patterns occur too often")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
