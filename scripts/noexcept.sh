#!/usr/bin/env bash
# Builds the core with -fno-exceptions, checks that nothing in it throws, and builds an outside program against it.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
scripts/configure.sh noexcept
cmake --build build/noexcept
if nm build/noexcept/libknead.a 2>/dev/null | grep -E '__cxa_(throw|begin_catch|allocate_exception)$'; then
  echo "noexcept: the core refers to the C++ exception runtime" >&2
  exit 1
fi
tests/house/consumer/build.sh build/noexcept build/noexcept/consumer -fno-exceptions
echo "noexcept: the core builds, links and runs without exceptions"
