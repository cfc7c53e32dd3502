#!/usr/bin/env bash
# Builds everything in a preset and runs all its tests; in the release also those of the studio, under sanitizers also the
# fuzz targets. Says what took how long. What takes long under sanitizers is checked where KNEAD_LONG is set.
#   scripts/test.sh release | asan
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
long=${KNEAD_LONG:+true}
long=${long:-false}
report=""
timed() {  # timed NAME COMMAND...
  local name=$1 start=$SECONDS
  shift
  "$@"
  report+=$(printf '  %-28s %4d s' "$name" $((SECONDS - start)))$'\n'
}

build() {
  if [ "$preset" = asan ]; then scripts/setup.sh sanitizers; else scripts/setup.sh test; fi
  scripts/configure.sh "$preset" KNEAD_BUILD_TESTS=ON KNEAD_LONG_CHECKS=$($long && echo ON || echo OFF)
  cmake --build "build/$preset"
}
build_wasm_tests() {
  scripts/setup.sh wasm
  scripts/configure.sh wasm KNEAD_BUILD_TESTS=ON
  cmake --build build/wasm --target gramian_values
}
studio_tests() (cd web && npm run --silent "$1")

timed "build" build
if [ "$preset" = release ] || $long; then timed "build for WebAssembly" build_wasm_tests; fi
chosen=()
if [ "$preset" = asan ] && ! $long; then chosen=(--exclude-regex "$(grep -v '^#' tests/long_under_sanitizers.txt | paste -sd '|')"); fi
timed "tests" ctest --preset "$preset" "${chosen[@]}" -j "${KNEAD_JOBS:-$(nproc)}"
if [ "$preset" = release ]; then
  scripts/setup.sh web
  timed "build of the studio" scripts/studio.sh
  timed "studio: in node" studio_tests test
  timed "studio: in Chromium" studio_tests e2e
fi
if [ "$preset" = asan ]; then timed "fuzz targets" scripts/fuzz.sh; fi
echo "test: all passed"
printf '%s' "$report"
