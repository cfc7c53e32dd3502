#!/usr/bin/env bash
# Tests under the address and undefined-behaviour sanitizers. The library is compiled by clang with both, as a shared library
# that takes the place of the one which the test programs of the release load; so nothing but the library and the command line
# is compiled. With KNEAD_LONG everything is: the tests too, with all checks, and all of them run.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/stages.sh

root=$PWD
export KNEAD_JOBS=${KNEAD_JOBS:-$(nproc)}
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$root/tests/support/lsan.supp:print_suppressions=0

build() {  # build LONG
  scripts/setup.sh sanitizers
  scripts/configure.sh asan KNEAD_BUILD_TESTS=ON KNEAD_LONG_CHECKS="$1"
  cmake --build build/asan
}
build_release() {
  scripts/setup.sh test
  scripts/configure.sh release KNEAD_BUILD_TESTS=ON
  cmake --build build/release
}

# Each room's program runs in as many processes as have something to do, each with every n-th test.
rooms=(cli)
for room in $(sed -n 's/^\([a-z]*\):.*/\1/p' src/rooms.txt); do [ ! -d "tests/$room" ] || rooms+=("$room"); done
shards=4
export results=$root/build/log/asan
shard() {  # shard ROOM INDEX
  local log=$results/$1-$2.log status=0
  GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$2 LD_LIBRARY_PATH=$root/build/asan/tests LD_PRELOAD=$runtime \
    KNEAD_PROGRAM=$root/build/asan/knead "$root/build/release/tests/$1/$1_test" --gtest_filter="$filter" >"$log" 2>&1 </dev/null || status=$?
  [ $status -eq 0 ] || grep -q '^\[  FAILED  \]' "$log" || echo "[  FAILED  ] $(sed -n 's/^\[ RUN      \] //p' "$log" | tail -n 1) (the last that began)" >>"$log"
  echo "$1 $2: $(grep -cE '^\[       OK \]' "$log") passed, exit code $status"
  [ $status -eq 0 ] || { grep -vE '^\[ (RUN  |      OK)' "$log" | tail -n 60; return 1; }
}
export -f shard
tests() {
  local status=0
  rm -rf "$results"
  mkdir -p "$results"
  filter=-$(grep -v '^#' tests/long_under_sanitizers.txt | paste -sd :)
  runtime=$(clang++-19 -print-file-name="libclang_rt.asan-$(uname -m).so")
  export filter runtime shards root
  for room in "${rooms[@]}"; do for ((k = 0; k < shards; ++k)); do echo "$room $k"; done; done |
    xargs -P "$KNEAD_JOBS" -L 1 bash -euo pipefail -c 'shard $0 $1' || status=$?
  echo "$(cat "$results"/*.log | grep -cE '^\[       OK \]') $(failed_tests | wc -l) $(cat "$results"/*.log | grep -cE '^\[  SKIPPED \] [^ ]+ \(')" >"$stage_counts"
  failed_tests >"$stage_failed"
  return $status
}
failed_tests() {
  local log room
  for log in "$results"/*.log; do
    room=$(basename "$log" | sed 's/-[0-9]*\.log$//')
    sed -nE 's/^\[  FAILED  \] ([^ ,]+)( \(the last that began\)|, where .*|)$/\1/p' "$log" | sort -u |
      sed "s|.*|LD_LIBRARY_PATH=build/asan/tests LD_PRELOAD=$runtime build/release/tests/$room/${room}_test --gtest_filter='&'|"
  done
}

if [ -n "${KNEAD_LONG:-}" ]; then
  stages asan 3
  stage "build" "" "scripts/asan.sh" build ON
  stage "tests" "build" "ctest --preset asan" ctest --preset asan -j "$KNEAD_JOBS"
else
  echo "asan: builds the library and the command line under sanitizers (some 5 minutes on two cores), runs tests (3) and fuzz targets (1)"
  stages asan 4
  stage "build of the tests" "" "scripts/test.sh" build_release
  stage "build" "" "scripts/asan.sh" build OFF
  stage "tests" "build" "scripts/asan.sh" tests
fi
stage "fuzz targets" "build" "scripts/fuzz.sh" scripts/fuzz.sh
stages_end
