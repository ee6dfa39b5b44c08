#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# test_platform.sh SOURCE_TREE SUITE LOG [MIRROR]: builds and tests the committed files in a bare chroot of a Debian
# release. The last line printed is a table row: suite, ParaView, compiler, packages, build, tests. Needs root,
# debootstrap, the network, and about 7 GB in TMPDIR. TAUTLINE_PLATFORM_ROOT names a chroot that is kept and, if it
# exists, reused with its packages and object files; ccache is used if it is installed in the chroot.
set -uo pipefail
source="$1" suite="$2" log="$3" mirror="${4:-http://deb.debian.org/debian}"
fail() { echo "test_platform.sh: $*; see $log" >&2; row; exit 1; }
paraview="-" compiler="-" packages="no" build="no" tests="-"
row() { printf '| Debian %s | %s | %s | %s | %s | %s |\n' "$suite" "$paraview" "$compiler" "$packages" "$build" "$tests"; }
((EUID == 0)) || fail "a chroot needs root"
command -v debootstrap >/dev/null || fail "no debootstrap: apt-get install debootstrap"

root="${TAUTLINE_PLATFORM_ROOT:-$(mktemp -d)}"
mounted=()
cleanup() {
  for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do umount "${mounted[i]}"; done
  [[ -n ${TAUTLINE_PLATFORM_ROOT:-} ]] || rm -rf --one-file-system "$root"
}
trap cleanup EXIT
: >"$log"
[[ -x $root/usr/bin/apt-get ]] || debootstrap --variant=minbase "$suite" "$root" "$mirror" >>"$log" 2>&1 || fail "debootstrap"
# Programs expect these mounts: hwloc prints a message without /sys, progress-bar tests open terminals, MPI shares memory.
for place in proc:proc sysfs:sys devpts:dev/pts tmpfs:dev/shm; do
  mkdir -p "$root/${place#*:}"
  if mount -t "${place%:*}" "${place%:*}" "$root/${place#*:}" 2>>"$log"; then mounted+=("$root/${place#*:}"); fi
done
# Nothing is inherited from this machine. One process per core: ninja's two more need memory that small machines lack.
launcher=()
[[ ! -x $root/usr/bin/ccache ]] || launcher=(CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache)
inside() {
  chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive CI=true \
    CMAKE_BUILD_PARALLEL_LEVEL="$(nproc)" "${launcher[@]}" \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -c "$1"
}
mkdir -p "$root/tautline"
git -C "$source" archive HEAD | tar -x -C "$root/tautline" || fail "git archive"
# The style tests also need a checkout.
inside 'apt-get update -q && apt-get install -y -q --no-install-recommends ca-certificates git' >>"$log" 2>&1 || fail "apt-get"
inside 'cd /tautline && ./run build' >>"$log" 2>&1 && build=yes
paraview="$(inside "dpkg-query -W -f='\${source:Upstream-Version}' paraview" 2>>"$log" || echo -)"
compiler="$(inside 'c++ -dumpfullversion' 2>>"$log" || echo -)"
[[ $paraview == - ]] || packages=yes
[[ $build == yes ]] || fail "the build"
inside 'cd /tautline && ./run test' >>"$log" 2>&1
tests="$(sed -n 's/^\([0-9]*% tests passed, [0-9]* tests failed out of [0-9]*\).*/\1/p' "$log" | tail -n 1)"
row
[[ $tests == 100%* ]]
