#!/usr/bin/env bash
# Packs the build that is there into out/dist/knead_cad-VERSION-….whl, with no more packages than it needs.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh python
/usr/bin/python3 bindings/python/backend/knead_backend.py out/dist
