#!/usr/bin/env bash
# Builds the examples, runs the programs and draws the scripts of the thesis' figures into out/examples.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
scripts/configure.sh release
cmake --build build/release --target example_draw_script example_plate_frequencies example_unification
mkdir -p out/examples
for script in examples/figures/*.json; do
  name=$(basename "$script" .json)
  file=
  case $name in figure_6_11*) file=examples/figures/patches.step ;; esac
  build/release/examples/example_draw_script "$script" "out/examples/$name.svg" ${file:+"$file"}
  echo "wrote out/examples/$name.svg"
done
build/release/examples/example_plate_frequencies
build/release/examples/example_unification
