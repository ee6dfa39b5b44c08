#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# test_packages.sh PACKAGES VERSION SOURCE_TREE [SUITE [MIRROR]]: installs the packages of a directory in a fresh chroot
# of a Debian release, uses them as a user would, removes them, and checks that no file remains. Needs root, debootstrap
# and the network; takes about 2 GB in TMPDIR. TAUTLINE_CHROOT names a chroot to reuse.
set -euo pipefail
packages="$(cd "$1" && pwd -P)" version="$2" source="$3" suite="${4:-bookworm}" mirror="${5:-http://deb.debian.org/debian}"
names=(libtautline python3-tautline paraview-tautline tautline-meshers libtautline-dev tautline-doc)
fail() { echo "test_packages.sh: $*" >&2; exit 1; }
((EUID == 0)) || fail "a chroot needs root"

root="${TAUTLINE_CHROOT:-}"
if [[ -z $root ]]; then
  command -v debootstrap >/dev/null || fail "no debootstrap: apt-get install debootstrap"
  root="$(mktemp -d)"
  trap "rm -rf --one-file-system $root" EXIT
  echo "--- a bare $suite in $root"
  debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$root.log" 2>&1 || fail "debootstrap failed: $root.log"
fi
# Programs expect /proc, and hwloc prints a message without /sys; if one cannot be mounted, the test continues without it.
for place in proc:proc sysfs:sys; do
  mount -t "${place%:*}" "${place%:*}" "$root/${place#*:}" 2>/dev/null || continue
  remove="$(trap -p EXIT | sed "s/^trap -- '//; s/' EXIT$//")"
  # shellcheck disable=SC2064 # expands now
  trap "umount $root/${place#*:}; $remove" EXIT
done
# A shell in the chroot with a user's environment: nothing is inherited from this machine.
inside() { chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
  PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LIBGL_ALWAYS_SOFTWARE=1 \
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 bash -euo pipefail -c "$1"; }
files() { (cd "$root" && find usr etc opt -not -path '*/__pycache__*' | sort); }

inside 'apt-get update -q; apt-get install -y -q --no-install-recommends xvfb xauth libgl1-mesa-dri man-db g++ cmake ninja-build' \
  >"$root/apt.log" 2>&1 || fail "apt-get: $root/apt.log"
inside "apt-get purge -y -q ${names[*]}" >>"$root/apt.log" 2>&1 || true # left by an earlier test in this chroot
mkdir -p "$root/packages" "$root/consumers"
cp "$packages"/*.deb "$root/packages"
cp -r "$source"/Testing/Install/*_consumer "$root/consumers"
cp "$source/Testing/headless.sh" "$root/packages"

echo "--- the dependencies are installed first, so that they do not count as left behind"
inside 'apt-get install -y -q --no-install-recommends --simulate /packages/*.deb' >"$root/plan.log" ||
  fail "the packages cannot be installed: $root/plan.log"
wanted="$(sed -n 's/^Inst \([^ ]*\) .*/\1/p' "$root/plan.log" | grep -v tautline || true)"
inside "apt-get install -y -q --no-install-recommends $(tr '\n' ' ' <<<"$wanted")" >>"$root/apt.log" 2>&1 ||
  fail "apt-get: $root/apt.log"
files >"$root/before.txt"

echo "--- the packages are installed"
inside 'apt-get install -y -q --no-install-recommends /packages/*.deb' >>"$root/apt.log" 2>&1 || fail "apt-get: $root/apt.log"
for name in "${names[@]}"; do
  [[ $(inside "dpkg-query -W -f='\${db:Status-Status} \${Version}' $name") == "installed $version-1" ]] || fail "$name is not installed"
done
installed="$(comm -13 <(cat "$root/before.txt") <(files) | wc -l)"
echo "$installed files and directories"

echo "--- the command, its manual page and its completion"
[[ $(inside 'tautline --version') == "tautline $version" ]] || fail "tautline --version"
[[ $(inside 'man -w tautline') == */tautline.1* ]] || fail "no manual page"
completed="$(inside 'source /usr/share/bash-completion/completions/tautline; COMP_WORDS=(tautline unt); COMP_CWORD=1; _tautline; echo "${COMPREPLY[*]}"')"
[[ $completed == untangle ]] || fail "completion gives '$completed'"
inside 'cd /tmp; tautline untangle /usr/share/tautline/samples/bracket-tangled.vtu -o valid.vtu; tautline quality valid.vtu' |
  tee "$root/quality.log"
grep -q 'inverted' "$root/quality.log" || fail "no quality"
inside 'cd /tmp; python3 -c "import tautline as tl; q = tl.quality(\"valid.vtu\"); print(tl.__version__, q.inverted); assert q.inverted == 0"'

echo "--- the mesh generators are a separate package; the others work without it"
without="$(inside 'cd /tmp; mv /usr/libexec/tautline/tautline-mesher /tmp; code=0
  tautline tet-mesh /usr/share/tautline/samples/cube.smesh -o cube.vtu 2>&1 || code=$?
  mv /tmp/tautline-mesher /usr/libexec/tautline; echo "code $code"')"
[[ $without == *"install the Debian package tautline-meshers"*"code 1" ]] || fail "without tautline-meshers: $without"
inside 'cd /tmp; tautline tet-mesh /usr/share/tautline/samples/cube.smesh -o cube.vtu'
inside 'python3 -c "import tautline; maps = open(\"/proc/self/maps\").read(); assert \"libtet\" not in maps and \"petsc\" not in maps"'
for name in "${names[@]}"; do
  inside "grep -q '^License: BSD-3-Clause' /usr/share/doc/$name/copyright" || fail "no copyright of $name"
done
# Debian has no copy of the AGPL in /usr/share/common-licenses.
for text in "^License: AGPL-3+" "GNU AFFERO GENERAL PUBLIC LICENSE" "END OF TERMS AND CONDITIONS"; do
  inside "grep -q '$text' /usr/share/doc/tautline-meshers/copyright" || fail "no text of the AGPL with tautline-meshers"
done

echo "--- every example script runs"
inside 'shopt -s nullglob; mkdir -p /tmp/examples; cd /tmp/examples
  for script in /usr/share/doc/tautline/examples/[0-9]*.py; do python3 "$script" /usr/share/tautline/samples >/dev/null || { echo "$script"; exit 1; }; done'

echo "--- ParaView finds the plugin without settings: pvpython and the program with its window"
cat >"$root/packages/plugin.py" <<'PYTHON'
import sys
from paraview.simple import *
mesh = OpenDataFile("/usr/share/tautline/samples/bracket-tangled.vtu")
quality = ElementQuality(Input=mesh)
quality.UpdatePipeline()
quality.UpdatePropertyInformation()
open("/tmp/summary.txt", "w").write(quality.Summary)
PYTHON
inside 'pvpython /packages/plugin.py; grep -i inverted /tmp/summary.txt; rm /tmp/summary.txt'
echo 'from paraview.simple import *; import os; open("/tmp/gui.txt", "w").write(str("ElementQuality" in globals())); os._exit(0)' \
  >"$root/packages/gui.py"
inside 'timeout 120 bash /packages/headless.sh paraview --script=/packages/gui.py >/tmp/gui.log 2>&1 || true; cat /tmp/gui.txt; echo; grep -q True /tmp/gui.txt'

echo "--- C++ programs find the CMake files"
for program in kernel_consumer solvers_consumer module_consumer; do
  inside "cmake -S /consumers/$program -B /tmp/$program -G Ninja -DCMAKE_BUILD_TYPE=Release && cmake --build /tmp/$program" \
    >"$root/$program.log" 2>&1 || { tail -n 20 "$root/$program.log" >&2; fail "$program"; }
  inside "/tmp/$program/$program"
done

inside 'cd /tmp && cmake -S /usr/share/doc/tautline/examples/cxx -B gallery -G Ninja -DCMAKE_BUILD_TYPE=Release && cmake --build gallery' \
  >"$root/gallery.log" 2>&1 || { tail -n 20 "$root/gallery.log" >&2; fail "the C++ programs of the gallery"; }
inside 'cd /tmp; for source in /usr/share/doc/tautline/examples/cxx/[0-9]*.cxx; do
  gallery/$(basename $source .cxx) /usr/share/tautline/samples; done'

echo "--- help pages, samples"
for file in share/doc/tautline/help/index.html share/tautline/samples/bracket.vtu share/doc/tautline/CHANGELOG.md; do
  [[ -s $root/usr/$file ]] || fail "no /usr/$file"
done

echo "--- the studies are part of the documentation package"
[[ $(inside 'tautline study list') == *peridynamics_kernel* ]] || fail "no studies"
inside "apt-get purge -y -q tautline-doc" >>"$root/apt.log" 2>&1 || fail "apt-get: $root/apt.log"
code=0
inside 'tautline study list' || code=$?
((code == 2)) || fail "tautline study without tautline-doc exits with $code"

echo "--- removal leaves nothing behind"
inside "apt-get purge -y -q ${names[*]}" >>"$root/apt.log" 2>&1 || fail "apt-get: $root/apt.log"
left="$(comm -13 "$root/before.txt" <(files))"
[[ -z $left ]] || fail "left behind: $left"
if inside 'tautline --version' 2>/dev/null; then fail "the command is still there"; fi
echo "the packages of $suite install, work and are removed"
