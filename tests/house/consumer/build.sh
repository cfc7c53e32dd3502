#!/usr/bin/env bash
# Installs a build of Knead into a directory of its own, builds the outside project against it and runs it.
#   build.sh BUILD_DIR WORK_DIR [COMPILER_FLAGS...]
set -euo pipefail

source_dir=$(dirname "$(realpath "$0")")
build_dir=$(realpath "$1")
work_dir=$(realpath -m "$2")
shift 2
rm -rf "$work_dir"
cmake --install "$build_dir" --prefix "$work_dir/prefix" >/dev/null
# By the compiler of the build: a library with one compiler's sanitizers does not link by another.
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build_dir/CMakeCache.txt")
cmake -S "$source_dir" -B "$work_dir/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$work_dir/prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="$*" >/dev/null
cmake --build "$work_dir/build"
"$work_dir/build/consumer"
"$work_dir/build/image_consumer"
