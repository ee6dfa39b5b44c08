#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# fuzz.sh FUZZER BUILD SECONDS [SEED [RUNS]]: runs every target of a fuzzer for this many seconds, two at a time, and fails
# on any finding.
# SEED: the seed of the random numbers, so that a run can be repeated; 0, the default: another one each time.
# RUNS: the largest number of inputs of a target, the corpus among them; -1, the default: any number.
# New inputs that reach new code are kept in BUILD/corpus; an input that fails is saved in BUILD/findings. To keep
# one as a regression test, fix the cause and copy it to Testing/Fuzz/Corpus/TARGET.
set -euo pipefail
fuzzer="$1" build="$2" seconds="$3" seed="${4:-0}" runs="${5:--1}"
top="$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd -P)"
mapfile -t targets < <(TAUTLINE_FUZZ_TARGET=list "$fuzzer" list)
parallel=2
# Memory and time of one input: far above what any input of the corpus needs.
memory=2048 longest=20

base="${TMPDIR:-/tmp}"
[[ -w /dev/shm ]] && base=/dev/shm # files in memory
work="$(mktemp -d "$base/tautline-fuzz-XXXXXX")"
trap 'rm -rf "$work"' EXIT
mkdir -p "$build/findings"

# libFuzzer prints its help to stderr; the seeded mutator has no such option. (No pipe to grep -q: it ends too early.)
((${#targets[@]} > 0)) || { echo "fuzz: $fuzzer lists no targets" >&2; exit 1; }
help="$(TAUTLINE_FUZZ_TARGET=off "$fuzzer" -help=1 2>&1 || true)"
libfuzzer=0
[[ $help != *max_total_time* ]] || libfuzzer=1

fuzz() {
  local target="$1"
  export TAUTLINE_FUZZ_TARGET="$target" TAUTLINE_FUZZ_DIR="$work/$target"
  mkdir -p "$TAUTLINE_FUZZ_DIR" "$build/corpus/$target"
  # PETSc has no frame pointers: leaks.supp names one of its functions, which only whole stacks show.
  [[ $target != petscoptions ]] || export ASAN_OPTIONS="${ASAN_OPTIONS:-}:fast_unwind_on_malloc=0"
  if ((libfuzzer)); then
    "$fuzzer" -seed="$seed" -max_total_time="$seconds" -runs="$runs" \
      -timeout="$longest" -rss_limit_mb="$memory" -max_len=16384 -print_final_stats=1 \
      -artifact_prefix="$build/findings/$target-" "$build/corpus/$target" "$top/Corpus/$target"
  else
    "$fuzzer" "$target" "$top/Corpus/$target" "$seconds" "$((seed > 0 ? seed : RANDOM))" "$build/findings/$target-input" "$runs"
    rm -f "$build/findings/$target-input"
  fi
}

failed=()
finish() { # the oldest of the running ones
  local target="${running[0]%%:*}" pid="${running[0]##*:}"
  running=("${running[@]:1}")
  if wait "$pid"; then
    echo "fuzz: $target: $(grep -oE 'number_of_executed_units: .*|^[0-9]+ runs' "$work/$target.log" | grep -oE '[0-9]+') inputs"
  else
    failed+=("$target")
    tail -n 60 "$work/$target.log" >&2
    echo "fuzz: $target FAILED; the input is in $build/findings" >&2
  fi
}
running=()
for target in "${targets[@]}"; do
  fuzz "$target" >"$work/$target.log" 2>&1 &
  running+=("$target:$!")
  ((${#running[@]} < parallel)) || finish
done
while ((${#running[@]} > 0)); do finish; done
((${#failed[@]} == 0)) || { echo "fuzz: findings in ${failed[*]}" >&2; exit 1; }
