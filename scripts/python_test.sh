#!/usr/bin/env bash
# Tests the Python package alone, by the stage of `make test`: its wheel, in a new environment.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/stages.sh
source scripts/python_tests.sh
scripts/setup.sh test
stages "Python package" 1
stage "Python package" "" "scripts/python_test.sh" python_tests
stages_end
