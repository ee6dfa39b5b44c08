#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run_release.sh SOURCE_TREE WORK_DIRECTORY VERSION: ./run release makes the same bytes twice, also with another mask and
# in another time zone, of a tree that configures.
set -euo pipefail
source="$1" work="$2" version="$3"
git -C "$source" rev-parse HEAD >/dev/null 2>&1 || { echo "no git checkout: skipped"; exit 77; }
rm -rf "$work"
"$source/run" release "$work/first"
(umask 077 && TZ=Asia/Tokyo "$source/run" release "$work/second")
cmp "$work/first/tautline-$version.tar.gz" "$work/second/tautline-$version.tar.gz"
(cd "$work/first" && sha256sum -c "tautline-$version.tar.gz.sha256")
tar -xzf "$work/first/tautline-$version.tar.gz" -C "$work"
for file in run CMakeLists.txt LICENSE CITATION.cff README.md Data/bracket.vtu; do
  if [[ ! -s $work/tautline-$version/$file ]]; then echo "the tarball has no $file" >&2; exit 1; fi
done
if ! "$work/tautline-$version/run" help >/dev/null; then echo "./run does not work in the tarball" >&2; exit 1; fi
