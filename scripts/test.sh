#!/usr/bin/env bash
# Builds everything in a preset and runs all its tests.
#   scripts/test.sh release | asan
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
scripts/setup.sh test
scripts/configure.sh "$preset" KNEAD_BUILD_TESTS=ON
cmake --build "build/$preset"
scripts/setup.sh wasm
scripts/configure.sh wasm-test
cmake --build build/wasm-test
ctest --preset "$preset" -j "${KNEAD_JOBS:-$(nproc)}"
