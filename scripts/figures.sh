#!/usr/bin/env bash
# Regenerates the tables and figures of the thesis' evaluation of Gramians into out/figures.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
scripts/configure.sh release
cmake --build build/release --target knead_figures
build/release/apps/figures/knead_figures out/figures
