#!/usr/bin/env bash
# Builds and runs every benchmark; arguments go to Google Benchmark (--benchmark_filter=...).
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh bench
scripts/configure.sh release KNEAD_BUILD_BENCH=ON
cmake --build build/release --target knead_benchmarks
for program in build/release/bench/*_bench; do
  [ -x "$program" ] || continue
  echo "== $(basename "$program")"
  "$program" "$@"
done
