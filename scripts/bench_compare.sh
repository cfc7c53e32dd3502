#!/usr/bin/env bash
# Is this commit slower than another? Builds the benchmarks of both in worktrees of their own and runs them in turn, one
# after the other, so that whatever the machine does meets both. Fails where a benchmark takes more than 10 % longer
# than in BASE and three repeats, each beside its own run of BASE, confirm it.
#   scripts/bench_compare.sh BASE [FILTER]    FILTER: Google Benchmark's regular expression; default: all
set -euo pipefail
cd "$(dirname "$0")/.."

base=${1:?usage: scripts/bench_compare.sh BASE [FILTER]}
filter=${2:-.}
compare=$PWD/build/compare
git rev-parse --verify --quiet "$base^{commit}" >/dev/null || { echo "bench-compare: there is no commit $base" >&2; exit 2; }
[ -z "$(git status --porcelain --untracked-files=no)" ] ||
  echo "bench-compare: what is not committed is not measured" >&2

scripts/setup.sh bench
for side in base head; do
  commit=$(git rev-parse "$([ "$side" = base ] && echo "$base" || echo HEAD)^{commit}")
  tree=$compare/$side
  if [ -e "$tree/.git" ]; then
    git -C "$tree" checkout --quiet --force --detach "$commit"
  else
    git worktree prune
    git worktree add --quiet --detach "$tree" "$commit"
  fi
  (cd "$tree" && scripts/configure.sh release KNEAD_BUILD_BENCH=ON KNEAD_BUILD_TESTS=OFF KNEAD_BUILD_APPS=OFF KNEAD_BUILD_EXAMPLES=OFF >/dev/null &&
    cmake --build build/release --target knead_benchmarks)
done
judge=$compare/head/build/release/bench/knead_bench_judge
export KNEAD_THREADS=${KNEAD_THREADS:-1}

results=$compare/results
rm -rf "$results"
run() {  # run ROUND PART PROGRAM FILTER: in base and head
  local round=$1 part=$2 name=$3 wanted=$4 side program out
  for side in base head; do
    program=$compare/$side/build/release/bench/${name}_bench out=$results/$round/$side/$part/$name.json
    [ -x "$program" ] || continue
    mkdir -p "$(dirname "$out")"
    "$program" --benchmark_filter="$wanted" --benchmark_out="$out" --benchmark_out_format=json >/dev/null 2>&1 || true
    [ -s "$out" ] || rm -f "$out"  # no result is no JSON
  done
}

programs=()
for program in "$compare"/head/build/release/bench/*_bench; do
  name=$(basename "$program" _bench)
  [ "$name" = gramian ] || programs+=("$name")  # its own table, without a filter
done
for name in "${programs[@]}"; do
  echo "bench-compare: $name"
  run 0 all "$name" "$filter"
done
status=0
"$judge" slower "$results" 0 0 >"$results/suspects" || status=$?
[ "$status" -le 1 ] || exit "$status"
if [ "$status" -eq 0 ]; then
  echo "bench-compare: nothing is more than 10 % slower than in $base"
  exit 0
fi

echo "bench-compare: slower in one run, to be confirmed:"
cat "$results/suspects"
for round in 1 2 3; do
  while read -r suspect _; do
    benchmark=${suspect#*:}
    part=$(printf '%s' "$benchmark" | tr -c 'a-zA-Z0-9' _)
    run "$round" "$part" "${suspect%%:*}" "^$(printf '%s' "$benchmark" | sed 's/[].*+?(){}|^$\\[]/\\&/g')\$"
  done <"$results/suspects"
done
status=0
"$judge" slower "$results" 1 3 || status=$?
if [ "$status" -eq 0 ]; then
  echo "bench-compare: three repeats do not confirm it"
elif [ "$status" -eq 1 ]; then
  echo "bench-compare: these are slower than in $base by more than 10 %, in each of three repeats (head / base)" >&2
fi
exit "$status"
