#!/usr/bin/env bash
# Counts the instructions of the kernels of bench/instructions.cpp by callgrind, all of the portable instruction set, and
# compares them with bench/instructions.json: unlike times, counts repeat on a machine that does other things too.
#   scripts/instructions.sh            fails where one differs by more than 3 %
#   scripts/instructions.sh --renew    writes what was counted to bench/instructions.json
# Compilers differ by more than that, so the file names its own; by another one nothing is compared.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${KNEAD_BUILD:-build/release}
if [ -z "${KNEAD_BUILD:-}" ]; then
  scripts/setup.sh instructions
  scripts/configure.sh release KNEAD_BUILD_BENCH=ON
fi
cmake --build "$build" --target knead_instructions knead_bench_judge

# Of ours vectors of two, and of the C library's the ones that every x86-64 has.
export KNEAD_INSTRUCTION_SET=vector128
export KNEAD_THREADS=1
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-AVX2,-AVX512F,-FMA_Usable,-FMA,-FMA4,-ERMS
program=$build/bench/knead_instructions judge=$build/bench/knead_bench_judge expected=bench/instructions.json
[ "$("$program" --set)" = vector128 ] || { echo "instructions: this build has no portable vectors" >&2; exit 1; }
compiler=$("$program" --compiler)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count() {  # count KERNEL: instructions below knead_measured
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=knead_measured \
    "$program" "$1" >"$work/$1.log" 2>&1 || { cat "$work/$1.log" >&2; exit 1; }
  sed -n 's/.*Collected : \([0-9]*\).*/\1/p' "$work/$1.log" >"$work/$1.count"
}
export -f count
export program work
"$program" | xargs -P "${KNEAD_JOBS:-$(nproc)}" -I{} bash -euo pipefail -c 'count {}'

counted=$work/counted.json
{
  printf '{\n  "compiler": "%s",\n  "instructions": {\n' "$compiler"
  separator=""
  for kernel in $("$program"); do
    printf '%b    "%s": %s' "$separator" "$kernel" "$(cat "$work/$kernel.count")"
    separator=',\n'
  done
  printf '\n  }\n}\n'
} >"$counted"

if [ "${1:-}" = --renew ]; then
  cp "$counted" "$expected"
  cat "$expected"
elif ! grep -qF "\"compiler\": \"$compiler\"" "$expected"; then
  cat "$counted"
  echo "instructions: not compared, $expected is of another compiler than $compiler"
elif "$judge" counts "$expected" "$counted"; then
  echo "instructions: all within 3 % of $expected"
else
  echo "instructions: if that is meant, scripts/instructions.sh --renew writes the new counts" >&2
  exit 1
fi
