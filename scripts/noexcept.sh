#!/usr/bin/env bash
# Builds the core with -fno-exceptions, checks that nothing in it throws, and builds an outside program against it.
#   scripts/noexcept.sh [noexcept | noexcept-alone]    the latter: each source by itself, so it includes what it uses
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-noexcept}
scripts/setup.sh build
scripts/configure.sh "$preset"
cmake --build "build/$preset"
if nm "build/$preset/libknead.a" "build/$preset/src/image/libknead_image.a" 2>/dev/null | grep -E '__cxa_(throw|begin_catch|allocate_exception)$'; then
  echo "noexcept: the core refers to the C++ exception runtime" >&2
  exit 1
fi
tests/house/consumer/build.sh "build/$preset" "build/$preset/consumer" -fno-exceptions
echo "noexcept: the core builds, links and runs without exceptions"
