#!/usr/bin/env bash
# Builds and runs every benchmark, and gathers the results in out/bench: report.md and summary.json. With arguments, runs
# them with these instead (--benchmark_filter=...) and gathers nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh bench
scripts/configure.sh release KNEAD_BUILD_BENCH=ON
cmake --build build/release --target knead_benchmarks
programs=build/release/bench out=out/bench
export KNEAD_THREADS=${KNEAD_THREADS:-1}  # times are of the processor; threads_bench chooses for itself
if [ $# -gt 0 ]; then
  for program in "$programs"/*_bench; do
    [ -x "$program" ] || continue
    echo "== $(basename "$program")"
    "$program" "$@"
  done
  exit 0
fi

rm -rf "$out"
mkdir -p "$out"
for program in "$programs"/*_bench; do
  [ -x "$program" ] || continue
  name=$(basename "$program" _bench)
  echo "== $name"
  if [ "$name" = gramian ]; then
    "$program" 21 3 | tee "$out/gramian.md"
  else
    "$program" --benchmark_out="$out/$name.json" --benchmark_out_format=json
  fi
done
# Alone, for the memory of its process.
"$programs/contact_bench" --benchmark_filter='^contact/256$' --benchmark_out="$out/memory.json" \
  --benchmark_out_format=json >/dev/null
"$programs/contact_bench" --benchmark_filter='^contact_iterative/256$' --benchmark_out="$out/memory_iterative.json" \
  --benchmark_out_format=json >/dev/null
"$programs/knead_bench_report" "$out"
