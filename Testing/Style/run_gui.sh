#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The command line of ./run: ParaView must not take a file for the name of a plugin, which is what
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
# An old ParaView is named before CMake is asked; of a newer one nothing is said.
rm -rf "$scratch/build"
for version in 5.9.1 5.10.0 5.11.0 5.13.2 6.1.1; do
  printf '#!/bin/sh\necho paraview version %s\n' "$version" >"$scratch/pvpython"
  chmod +x "$scratch/pvpython"
  told="$("$top/run" build 2>&1)" && old=no || old=yes
  [[ $version == 5.9.1 || $version == 5.10.0 ]] && wanted=yes || wanted=no
  [[ $old == "$wanted" && ($old == no || $told == *"ParaView $version is too old, 5.11 or later"*) ]] ||
    { echo "run build with ParaView $version: '$told'" >&2; exit 1; }
  [[ $old == no || ! -e $scratch/build ]] || { echo "something was configured with ParaView $version" >&2; exit 1; }
  rm -rf "$scratch/build"
done
[[ -f $top/Plugin/open_sample.py && -f $top/Data/bracket-tangled.vtu ]]
grep -q '^GeneralSettings.ShowWelcomeDialog=false$' "$scratch/welcome" ||
  { echo "run gui: the welcome of ParaView is shown" >&2; exit 1; }

# The help of a command does nothing else.
for command in demo build test sanitize gui doctor env tidy docs package clean; do
  rm -rf "$scratch/build"
  told="$("$top/run" "$command" --help)"
  [[ $told == "  $command"* && $told != *$'\n'"  "[a-z]* && ! -e $scratch/build ]] ||
    { echo "run $command --help: '$told'" >&2; exit 1; }
done
# A tree that was configured by hand is not configured again; one that ./run made with other options is, and that is told.
printf '#!/bin/sh\necho "$@" >>"%s/calls"\n' "$scratch" >"$scratch/cmake"
mkdir -p "$scratch/build"
touch "$scratch/build/build.ninja" "$scratch/calls"
told="$("$top/run" build 2>&1)"
if [[ $told != *"its options are kept"* ]] || grep -q -e '-S' "$scratch/calls"; then
  echo "run build in a tree configured by hand: '$told'" >&2
  exit 1
fi
printf '%s -DOTHER=ON' "$top" >"$scratch/build/run-options"
told="$("$top/run" build 2>&1)"
if [[ $told != *"made with other options"*"-DOTHER=ON"* ]] || ! grep -q -e '-S' "$scratch/calls"; then
  echo "run build in a tree with other options: '$told'" >&2
  exit 1
fi
# The tests: arguments of ctest, and slow tests where they are chosen.
printf '#!/bin/sh\necho "$@"\n' >"$scratch/ctest"
chmod +x "$scratch/ctest"
tested() { "$top/run" test "$@" 2>/dev/null | head -n 1; }
[[ $(tested) == *"-LE slow"* && $(tested -V) == *"-V -LE slow"* ]] || { echo "run test: $(tested)" >&2; exit 1; }
[[ $(tested -R TestMesh) == *"-R TestMesh" && $(tested --all) != *slow* ]] ||
  { echo "run test -R TestMesh: $(tested -R TestMesh)" >&2; exit 1; }
