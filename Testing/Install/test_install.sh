#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# test_install.sh CMAKE BUILD_TREE WORK_DIRECTORY COMPILER PYTHON
# The install tree must work wherever it is moved to, so it is moved before it is used.
set -euo pipefail
cmake="$1" build="$2" work="$3" compiler="$4" python="$5"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)"

rm -rf "$work"
mkdir -p "$work/first"
"$cmake" --install "$build" --prefix "$work/first" >"$work/install.log"
tree="$work/moved here" # with a space
mv "$work/first" "$tree"
unset LD_LIBRARY_PATH PYTHONPATH PV_PLUGIN_PATH

echo "--- no library of Tautline is missing, nothing points into the build tree"
while IFS= read -r -d '' library; do
  if ldd "$library" | grep -E 'not found'; then echo "in $library" >&2; exit 1; fi
  if readelf -d "$library" | grep -E 'R(UN)?PATH' | grep -F "$build"; then echo "in $library" >&2; exit 1; fi
done < <(find "$tree" \( -name '*.so' -o -name 'libTautline*.so.*' -o -name tautline-mesher \) -print0)
if grep -rlF --include='*.cmake' -e "$build" -e "$work/first" "$tree"; then
  echo "these package files contain paths of the build" >&2; exit 1
fi

echo "--- a C++ program finds the package, first without VTK, then with a module"
for program in kernel_consumer solvers_consumer module_consumer metric_consumer; do
  "$cmake" -S "$here/$program" -B "$work/$program" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$tree" >"$work/$program.log"
  "$cmake" --build "$work/$program" >>"$work/$program.log"
  arguments=()
  if [[ $program == metric_consumer ]]; then arguments=("$work/$program/libmy_metrics.so"); fi
  "$work/$program/$program" "${arguments[@]}"
done

if [[ -d $tree/lib/python3 ]]; then
  echo "--- the shell knows the metrics of a library"
  for name in my_distortion longest_edge; do
    metrics="$(PYTHONPATH="$tree/lib/python3/dist-packages" TAUTLINE_METRICS="$work/metric_consumer/libmy_metrics.so" \
      "$python" -m tautline metrics)"
    if [[ $metrics != *"$name"* ]]; then echo "the metric $name is not listed" >&2; exit 1; fi
  done
fi

echo "--- a program that evaluates a metric loads the kernel, oneTBB and the compiler's own libraries, nothing else"
expected='TautlineKernel|tbb|stdc\+\+|m|gcc_s|c|pthread|dl|rt'
others="$(ldd "$work/kernel_consumer/kernel_consumer" | awk '{ print $1 }' |
  grep -vE "^(lib($expected)\.so|linux-vdso|/lib.*/ld-linux|libasan|libubsan)" || true)"
if [[ -n $others ]]; then echo "Tautline::Kernel links $others" >&2; exit 1; fi
# Not into grep -q: it ends at the first match, and the pipe fails when ldd still writes.
if [[ $(ldd "$work/solvers_consumer/solvers_consumer") != *petsc* ]]; then
  echo "the check of linked libraries finds nothing: Tautline::Solvers does link PETSc" >&2; exit 1
fi

echo "--- every public header of the kernel compiles, alone and with all others, and none lies outside its directories"
while IFS= read -r -d '' header; do
  "$compiler" -std=c++17 -Wall -Wextra -Werror -fsyntax-only -x c++ -I "$tree/include" "$header"
done < <(find "$tree/include/tautline" -name '*.h' -print0)
(cd "$tree/include" && find tautline -name '*.h' -printf '#include "%p"\n') >"$work/all_headers.cxx"
"$compiler" -std=c++17 -Wall -Wextra -Werror -fsyntax-only -I "$tree/include" "$work/all_headers.cxx"
strays="$(find "$tree/include" -name '*.h' -not -path '*/include/tautline/*' \
  -not -name 'vtk*.h' -not -name 'Tautline*.h' -printf '%f ')"
if [[ -n $strays ]]; then echo "installed headers without prefix or directory: $strays" >&2; exit 1; fi

if [[ -d $tree/lib/python3 ]]; then
  echo "--- the Python package is found in the moved tree"
  PYTHONPATH="$tree/lib/python3/dist-packages" "$python" - "$tree" <<'PYTHON'
import sys
import tautline
assert tautline.__file__.startswith(sys.argv[1]), tautline.__file__
print(tautline.vtkElementQuality().GetClassName(), tautline.__file__)
PYTHON

  program="$tree/libexec/tautline/tautline-mesher"
  if [[ -x $program ]]; then
    echo "--- the program of the mesh generators is found in the moved tree, and named where it is missing"
    tet_mesh() {
      PYTHONPATH="$tree/lib/python3/dist-packages" "$python" -m tautline tet-mesh "$tree/share/tautline/samples/cube.smesh" \
        -o "$work/cube.vtu"
    }
    tet_mesh
    mv "$program" "$work/program"
    without="$(tet_mesh 2>&1 || true)"
    mv "$work/program" "$program"
    if [[ $without != *"$program; install the Debian package tautline-meshers"* ]]; then echo "$without" >&2; exit 1; fi
  fi

  echo "--- the studies are part of the documents, not of the package"
  study() { PYTHONPATH="$tree/lib/python3/dist-packages" "$python" -m tautline study list; }
  if [[ $(study) != *peridynamics_kernel* ]]; then echo "the studies are not listed" >&2; exit 1; fi
  rm -r "$tree"/share/doc/*/studies
  code=0
  study 2>"$work/study.log" || code=$?
  if ((code != 2)); then echo "study list without studies exits with $code" >&2; exit 1; fi
fi

plugin="$(find "$tree" -name Tautline.so -path '*plugins*')"
if [[ -n $plugin ]]; then
  echo "--- pvpython loads the plugin"
  pvpython "$here/../../Plugin/list_proxies.py" "$plugin"
fi
