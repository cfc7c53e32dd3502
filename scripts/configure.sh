#!/usr/bin/env bash
# Configures build/PRESET once; later calls return at once unless a cache entry differs from the one asked for.
#   scripts/configure.sh PRESET [NAME=VALUE...]
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
shift
cache=build/$preset/CMakeCache.txt
arguments=()
stale=false
[ -f "build/$preset/build.ninja" ] || stale=true
for setting in "$@"; do
  arguments+=("-D$setting")
  grep -qs "^${setting%%=*}:[A-Z]*=${setting#*=}\$" "$cache" || stale=true
done
if ! $stale; then exit 0; fi
if [ ! -f "$cache" ] && command -v ccache >/dev/null; then arguments+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset "$preset" "${arguments[@]}"
