#!/usr/bin/env bash
# Writes the table in docs/exchange.md anew: presses faces of every STEP and IGES file, and asks Open CASCADE. Minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh test
scripts/configure.sh release
cmake --build build/release --target oracle_test
KNEAD_LONG=1 KNEAD_EXCHANGE_TABLE=1 build/release/tests/oracle/oracle_test --gtest_filter='Files/Exchange.*'
