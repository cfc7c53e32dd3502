#!/usr/bin/env bash
# Tests the Python package alone, as `make test` does: its wheel, in a new environment.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/python_tests.sh
scripts/setup.sh test
python_tests
