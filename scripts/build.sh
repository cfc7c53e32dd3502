#!/usr/bin/env bash
# Builds the command line, build/release/knead, with no more packages than it needs.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
# A build directory that already has tests and benchmarks keeps them.
if [ ! -f build/release/build.ninja ]; then
  scripts/configure.sh release KNEAD_BUILD_TESTS=OFF KNEAD_BUILD_BENCH=OFF
fi
cmake --build build/release --target knead_cli
