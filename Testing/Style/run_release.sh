#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run_release.sh SOURCE_TREE WORK_DIRECTORY VERSION: a release of a copy of the tree, as it is now. A change that is not
# joined stops it; a joined one is in the change log of the tarball. ./run release makes the same bytes twice, also with
# another mask and in another time zone, and ./run works in the unpacked tarball.
set -euo pipefail
source="$1" work="$2" version="$3" next="${3%%.*}.999.0"
fail() { echo "run_release.sh: $*" >&2; exit 1; }
git -C "$source" rev-parse HEAD >/dev/null 2>&1 || { echo "no git checkout: skipped"; exit 77; }
rm -rf "$work"
mkdir -p "$work/tree"
# Tracked files and new ones, without those that were deleted.
(cd "$source" && git ls-files -z --cached --others --exclude-standard | sort -zu |
  while IFS= read -r -d '' file; do [[ ! -e $file && ! -L $file ]] || printf '%s\0' "$file"; done |
  tar -c --null -T -) | tar -x -C "$work/tree"
# Nothing of the settings of the user, such as signed commits.
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
repository() { git -C "$work/tree" -c user.name=Tester -c user.email=tester@localhost "$@"; }
repository init -q
repository add -A
repository commit -q -m "Documents: state the changes"
printf '### Fixed\n\n- **Test** of a release.\n' >"$work/tree/Plugin/Changes/test-of-a-release.md"
repository add -A
repository commit -q -m "Testing: fix a test"

if "$work/tree/run" release "$work/early" 2>"$work/early.log"; then fail "a release without a change that is not joined"; fi
grep -q 'not in CHANGELOG.md' "$work/early.log" || fail "$(<"$work/early.log")"
if "$work/tree/run" release join "$version" 2>/dev/null; then fail "version $version was released twice"; fi
"$work/tree/run" release join "$next" 2030-01-31
repository add -A
repository commit -q -m "Release $next"
[[ $(repository show --format= --name-status HEAD) == *$'D\tPlugin/Changes/test-of-a-release.md'* ]] || fail "the change is still there"

"$work/tree/run" release "$work/first"
(umask 077 && TZ=Asia/Tokyo "$work/tree/run" release "$work/second")
cmp "$work/first/tautline-$next.tar.gz" "$work/second/tautline-$next.tar.gz"
(cd "$work/first" && sha256sum -c "tautline-$next.tar.gz.sha256")
tar -xzf "$work/first/tautline-$next.tar.gz" -C "$work"
unpacked="$work/tautline-$next"
for file in run CMakeLists.txt LICENSE CITATION.cff README.md Data/bracket.vtu; do
  [[ -s $unpacked/$file ]] || fail "the tarball has no $file"
done
[[ $(sed -n '/^## '"$next"' - 2030-01-31$/,/^## '"$version"' - /p' "$unpacked/CHANGELOG.md") == *$'\n### Fixed\n\n- **Test** of a release.\n'* ]] ||
  fail "the change log of the tarball: $(head -n 20 "$unpacked/CHANGELOG.md")"
grep -q "^project(Tautline VERSION $next " "$unpacked/CMakeLists.txt" || fail "the version of the tarball"
"$unpacked/run" help >/dev/null || fail "./run does not work in the tarball"
if "$unpacked/run" release 2>/dev/null; then fail "a release of a tree that is no checkout"; fi
rm -rf "$work/tree" "$unpacked"
echo "a release joins its changes, and its tarball is the same twice"
