# SPDX-License-Identifier: BSD-3-Clause
"""make_manual.py OUTPUT: writes the manual page tautline.1.gz and the bash completion, tautline.bash.

Both are generated from the command-line parser, so they contain every command and option.
"""

import argparse
import gzip
import sys
from pathlib import Path

OUTPUT = Path(sys.argv[1])
sys.argv = ["tautline"]  # the name in the usage lines
from tautline import __version__  # noqa: E402
from tautline.__main__ import _parser  # noqa: E402

HEAD = r""".TH TAUTLINE 1 "" "tautline {version}" "User Commands"
.SH NAME
tautline \- measure, repair, deform and match meshes, and solve equations on them
.SH SYNOPSIS
.B tautline
.I COMMAND
.RI [ ARGUMENT ...]
.SH DESCRIPTION
Every command reads meshes from files and writes files; none changes a file that it reads.
\fBtautline\fP \fICOMMAND\fP \fB\-\-help\fP describes the most common options of a command,
\fB\-\-help\-all\fP all of them. The file to write is the option \fB\-o\fP or the last argument.
.SH COMMANDS
"""
TAIL = r""".SH EXIT STATUS
0 after success, 1 after an error, which is printed on standard error, 2 after incorrect usage or an unknown name, 3
if a mesh does not meet the criteria of \fBquality \-\-criteria\fP, 130 after Ctrl\-C.
.SH ENVIRONMENT
.TP
.B TAUTLINE_METRICS
Libraries with further metrics to load, separated by colons.
.SH SEE ALSO
.BR paraview (1)
"""

COMPLETION = r"""# shellcheck shell=bash disable=SC2207
# Completion of the command tautline in bash.
_tautline()
{
  local IFS=$'\n' # separates the candidates, so that file names may contain spaces
  local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD - 1]}" options=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(IFS=' ' compgen -W "@COMMANDS@" -- "$current"))
    return
  fi
  case "${COMP_WORDS[1]} $previous" in
@CHOICES@
  esac
  case "${COMP_WORDS[1]}" in
@OPTIONS@
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(IFS=' ' compgen -W "$options" -- "$current"))
    return
  fi
  compopt -o filenames 2>/dev/null
  COMPREPLY=($(compgen -f -- "$current"))
}
complete -F _tautline tautline
"""


def commands_of(parser: argparse.ArgumentParser):
    """The parsers of the commands and their one-line descriptions, by name."""
    action = next(a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    texts = {choice.dest: choice.help or "" for choice in action._choices_actions}
    return {name: (found, texts.get(name, "")) for name, found in action.choices.items()}


def escaped(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def help_of(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    return parser._get_formatter()._expand_help(action) if action.help else ""


def manual_of(name: str, parser: argparse.ArgumentParser, text: str):
    """The lines of one command."""
    formatter = argparse.HelpFormatter(prog=parser.prog)
    yield f".SS {escaped(name)}"
    yield escaped(text[:1].upper() + text[1:].rstrip(".") + ".")
    for action in parser._actions:
        if isinstance(action, argparse._HelpAction) or action.help == argparse.SUPPRESS:
            continue
        value = formatter._format_args(action, action.metavar or action.dest.upper()) if action.nargs != 0 else ""
        names = ", ".join(action.option_strings)
        yield ".TP"
        yield " ".join(part for part in (f"\\fB{escaped(names)}\\fP" if names else "",
                                         f"\\fI{escaped(value)}\\fP" if value else "") if part)  # fmt: skip
        yield escaped(help_of(parser, action)) or "A file, or a value as in the usage line."


def manual(commands: dict) -> str:
    lines = [line for name, (parser, text) in commands.items() for line in manual_of(name, parser, text)]
    return HEAD.format(version=escaped(__version__)) + "\n".join(lines) + "\n" + TAIL


def completion(commands: dict) -> str:
    """Completes commands, their options, values of options with choices, and otherwise files."""
    options, choices = [], []
    for name, (parser, _) in commands.items():
        options.append(f"  {name}) options=\"{' '.join(o for a in parser._actions for o in a.option_strings)}\" ;;")
        for action in parser._actions:
            if action.choices and action.option_strings and all(" " not in str(value) for value in action.choices):
                patterns = "|".join(f'"{name} {option}"' for option in action.option_strings)
                words = " ".join(map(str, action.choices))
                choose = f"""COMPREPLY=($(IFS=' ' compgen -W "{words}" -- "$current"))"""
                choices.append(f"  {patterns}) {choose}; return ;;")
    made = COMPLETION.replace("@COMMANDS@", " ".join([*commands, "--help", "--version", "-V"]))
    return made.replace("@OPTIONS@", "\n".join(options)).replace("@CHOICES@", "\n".join(choices or ["  :) ;;"]))


def main(output: Path) -> None:
    commands = commands_of(_parser())
    output.mkdir(parents=True, exist_ok=True)
    compressed = gzip.compress(manual(commands).encode(), mtime=0)  # reproducible bytes
    (output / "tautline.1.gz").write_bytes(compressed)
    (output / "tautline.bash").write_text(completion(commands), encoding="utf-8")


if __name__ == "__main__":
    main(OUTPUT)
