#!/usr/bin/env bash
# Runs clang-tidy 19 (the first Clang that reads libstdc++'s <expected>) over the library and the command line.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh lint
scripts/configure.sh release KNEAD_BUILD_TESTS=ON
git ls-files -z -- 'src/*.cpp' 'apps/*.cpp' |
  xargs -0 -r -n 1 -P "${KNEAD_JOBS:-$(nproc)}" clang-tidy-19 --quiet -p build/release \
    --extra-arg=-Wno-unknown-warning-option
