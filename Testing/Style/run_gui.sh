#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The command line of ./run gui: ParaView must not take a file for the name of a plugin, which is what
# it does with a file after --plugins; and its welcome does not cover the mesh, without a change of the user's settings.
# ParaView, CMake and the packages are replaced by stand-ins.
# usage: run_gui.sh TOP
set -eu
top="$1"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
printf '#!/bin/sh\nfor a in "$@"; do printf "[%%s]" "$a"; done; printf " %%s\\n" "${TAUTLINE_SAMPLE:-}"
cat "${XDG_CONFIG_DIRS%%%%:*}/ParaView/ParaView5.11.0.ini" >"$(dirname "$0")/welcome" 2>/dev/null || true\n' >"$scratch/paraview"
printf '#!/bin/sh\necho "paraview version 5.11.0-RC1"\n' >"$scratch/pvpython"
printf '#!/bin/sh\nexit 0\n' >"$scratch/cmake"
# All packages are installed: nothing must be installed by a test.
printf '#!/bin/sh\nfor a in "$@"; do printf "installed=%%s " "$a"; done\n' >"$scratch/dpkg-query"
printf '#!/bin/sh\nexit 1\n' >"$scratch/apt-get"
chmod +x "$scratch"/*
export PATH="$scratch:$PATH" DISPLAY=:none TAUTLINE_BUILD="$scratch/build"
expect() { # EXPECTED ARGUMENT...
  local expected="$1" found
  shift
  found="$("$top/run" gui "$@" 2>/dev/null)"
  [[ $found == "$expected" ]] || { echo "run gui $*: '$found', expected '$expected'" >&2; exit 1; }
}
expect "[part.vtu][--plugins=Tautline] " part.vtu
expect "[a b.vtu][--dr][--plugins=Tautline] " "a b.vtu" --dr
expect "[--script=$top/Plugin/open_sample.py][--plugins=Tautline] $top/Data/bracket-tangled.vtu"
[[ -f $top/Plugin/open_sample.py && -f $top/Data/bracket-tangled.vtu ]]
grep -q '^GeneralSettings.ShowWelcomeDialog=false$' "$scratch/welcome" ||
  { echo "run gui: the welcome of ParaView is shown" >&2; exit 1; }
