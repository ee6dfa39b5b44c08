#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# gallery_cxx.sh CMAKE SOURCES PREFIX WORK COMPILER DATA: builds the C++ programs of the gallery with the CMake files below
# PREFIX, as their readers do, and runs them. Each fails if a number is not what the example says.
set -euo pipefail
cmake="$1" sources="$2" prefix="$3" work="$4" compiler="$5" data="$6"
rm -rf "$work"
mkdir -p "$work"
"$cmake" -S "$sources" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$prefix" >"$work/build.log" && "$cmake" --build "$work/build" -j2 >>"$work/build.log" ||
  { cat "$work/build.log" >&2; exit 1; }
cd "$work"
count=0
for source in "$sources"/[0-9]*.cxx; do
  program="$(basename "$source" .cxx)"
  echo "--- $program"
  "build/$program" "$data"
  count=$((count + 1))
done
((count >= 5)) || { echo "only $count programs in $sources" >&2; exit 1; }
