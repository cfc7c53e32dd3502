#!/usr/bin/env bash
# Runs the notebook of examples/python with the package from its wheel, makes a page of it and turns its models in Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/python_tests.sh
scripts/setup.sh notebook
scripts/setup.sh web
[ -d web/node_modules ] || (cd web && npm ci --silent)
python_tests test_notebook.py
