#!/usr/bin/env bash
# The checks that take longer than CI should: all tests, repeated in random order with and without sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."

export GTEST_SHUFFLE=1 GTEST_REPEAT=3 KNEAD_LONG=1
scripts/test.sh
scripts/notebook_test.sh
KNEAD_FUZZ_SECONDS=${KNEAD_FUZZ_SECONDS:-60} KNEAD_FUZZ_SEED=${KNEAD_FUZZ_SEED:-0} scripts/asan.sh
scripts/noexcept.sh noexcept-alone
scripts/lint.sh
