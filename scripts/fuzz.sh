#!/usr/bin/env bash
# Builds the fuzz targets on the library that the tests under sanitizers have (preset asan), and runs each for some seconds.
#   scripts/fuzz.sh SECONDS [TARGET...]
# What is found stays in build/asan/fuzz/found, what leads into new code in build/asan/fuzz/corpus. Without arguments:
# KNEAD_FUZZ_SECONDS, or 10, of every target, from the seed KNEAD_FUZZ_SEED, or 1 (0: another each time). A run ends with an
# error at a crash, a leak, undefined behaviour, an input that takes more than 60 s, 2 GB of memory, or 512 MB in one piece;
# readers check how many bytes they held at once.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-${KNEAD_FUZZ_SECONDS:-10}}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(step iges brep text packed script snapshot document)

scripts/setup.sh sanitizers
scripts/configure.sh asan KNEAD_BUILD_TESTS=ON
cmake --build build/asan --target knead_fuzz
programs=build/asan/tests/fuzz work=build/asan/fuzz
mkdir -p "$work/found" "$work/seeds"
"$programs/knead_fuzz_seeds" "$work/seeds"

fuzz() {  # fuzz TARGET
  local target=$1 dictionary=tests/fuzz/dictionaries/$1.dict
  case $target in packed) dictionary= ;; document) dictionary=tests/fuzz/dictionaries/step.dict ;; snapshot) dictionary= ;; esac
  mkdir -p "$work/corpus/$target"
  UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 \
    "$programs/fuzz_$target" -seed="${KNEAD_FUZZ_SEED:-1}" -max_total_time="$seconds" -timeout=60 \
    -rss_limit_mb=2048 -malloc_limit_mb=512 -max_len=16384 -print_final_stats=1 ${dictionary:+-dict="$dictionary"} -artifact_prefix="$work/found/$target-" \
    "$work/corpus/$target" "$work/seeds/$target" >"$work/$target.log" 2>&1 || {
    echo "fuzz: $target failed:" >&2
    tail -n 40 "$work/$target.log" >&2
    return 1
  }
  echo "fuzz: $target: $(awk '/number_of_executed_units/ { print $2 }' "$work/$target.log") inputs in $seconds s"
}
export -f fuzz
export seconds programs work
printf '%s\n' "${targets[@]}" | xargs -n 1 -P "${KNEAD_JOBS:-$(nproc)}" bash -ec 'fuzz "$0"'
