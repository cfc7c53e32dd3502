#!/usr/bin/env bash
# Builds the examples, runs the programs and draws the scripts of the thesis' figures into out/examples.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
scripts/configure.sh release
cmake --build build/release --target example_draw_script example_draw_analysis example_plate_frequencies example_unification
mkdir -p out/examples
for script in examples/figures/*.json; do
  name=$(basename "$script" .json)
  file=
  case $name in figure_6_11*) file=examples/figures/patches.step ;; esac
  build/release/examples/example_draw_script "$script" "out/examples/$name.svg" ${file:+"$file"}
  echo "wrote out/examples/$name.svg"
done
for name in drape_in_folds drape_linear; do
  build/release/examples/example_draw_script "examples/analysis/$name.json" "out/examples/$name.svg"
  echo "wrote out/examples/$name.svg"
done
draw_analysis() {  # draw_analysis WHAT NAME [FILE]
  build/release/examples/example_draw_analysis "$1" "examples/analysis/$2.json" "out/examples/$2.svg" ${3:+"$3"}
  echo "wrote out/examples/$2.svg"
}
draw_analysis stress loaded_bonnet samples/bonnet.step
draw_analysis modes free_plate
draw_analysis modes buckling_can
build/release/examples/example_plate_frequencies
build/release/examples/example_unification
