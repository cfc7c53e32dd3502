#!/usr/bin/env bash
# Builds everything and runs all tests; goes on after a failed stage and ends with one table. Tests of CAD files of other
# systems take them from the folder that KNEAD_SHARED names (unset: ../shared, where it is; empty: none) and are skipped
# without it.
#   scripts/test.sh            all
#   scripts/test.sh skipped    after that, with such a folder: what was skipped for want of it
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/stages.sh
source scripts/native_tests.sh
source scripts/python_tests.sh

build() {
  scripts/setup.sh test
  scripts/configure.sh release KNEAD_BUILD_TESTS=ON KNEAD_BUILD_BENCH=ON KNEAD_BUILD_PYTHON=ON Python_EXECUTABLE="$python"
  cmake --build build/release
}
build_wasm() {
  scripts/setup.sh wasm
  scripts/configure.sh wasm KNEAD_BUILD_TESTS=ON
  cmake --build build/wasm --target gramian_values
}
npm_tests() {
  scripts/npm.sh
  studio_tests package npm
}
build_studio() {
  scripts/setup.sh web
  scripts/studio.sh
}

# Names of tests that were skipped because a file of another system was not there.
without_foreign_files() {
  [ -f "$results/native.xml" ] || return 0  # where the build failed
  awk '/<testcase name=/ { split($0, part, "\""); name = part[2] } /no foreign file/ && name { print name; name = "" }' \
    "$results/native.xml" | unescaped
}

again_with_foreign_files() {
  # ctest chooses by number; its list gives the number of each name.
  local numbers
  numbers=$(ctest --preset release -N | awk 'NR == FNR { wanted[$0] = 1; next } $1 == "Test" { number = $2; sub(/.*#[0-9]+: /, ""); gsub(/[^0-9]/, "", number); if ($0 in wanted) printf ",%s", number }' \
    <(without_foreign_files) -)
  [ -z "$numbers" ] || native_tests foreign -I "0,0,0$numbers"  # without a number it would run all
}

studio_tests() {  # studio_tests SCRIPT RESULTS [FOLDER [files of tests...]]
  local script=$1 folder=$results/${3:-} status=0
  local json=$folder/$2.json
  rm -f "$json"
  (cd web && KNEAD_TEST_RESULTS=$folder npm run --silent "$script" -- "${@:4}") || status=$?
  [ -f "$json" ] || return 1
  node scripts/vitest_counts.mjs counts "$json" "$script" "$stage_counts" "$stage_failed"
  return $status
}
studio_again() {  # studio_again SCRIPT RESULTS: files of which a test was skipped
  local files
  files=$(node scripts/vitest_counts.mjs skipped "$results/$2.json")
  [ -z "$files" ] || studio_tests "$1" "$2" foreign $files
}

if [ "${1:-}" = skipped ]; then
  stages "test with files of other systems" 3
  stage "native tests" "" "scripts/test.sh skipped" again_with_foreign_files
  stage "studio in node" "" "scripts/test.sh skipped" studio_again test studio_node
  stage "studio in Chromium" "" "scripts/test.sh skipped" studio_again e2e studio_chromium
  stages_end
  exit
fi

about=$([ -f build/release/build.ninja ] && echo "about 10 minutes where everything was built before" || echo "about 20 minutes from nothing")
echo "test: builds the library, the command line, the Python package and their tests; the engine for WebAssembly; the studio. Runs the native tests,"
echo "test: those of the packages for Python and npm as they are packed, the studio's in node and in Chromium. On two cores $about; logs in build/log."
stages test 8
rm -f "$results/native.xml"
stage "build" "" "make test" build
stage "build for WebAssembly" "" "scripts/wasm.sh" build_wasm
stage "native tests" "build" "ctest --preset release" native_tests native
stage "Python package" "build" "scripts/python_test.sh" python_tests
stage "build of the studio" "build for WebAssembly" "scripts/studio.sh" build_studio
stage "npm package" "build of the studio" "scripts/npm_test.sh" npm_tests
stage "studio in node" "build of the studio" "(cd web && npm test)" studio_tests test studio_node
stage "studio in Chromium" "build of the studio" "(cd web && npm run e2e)" studio_tests e2e studio_chromium
foreign=$(without_foreign_files | wc -l)
if [ "$foreign" -gt 0 ]; then
  stages_note="skipped: $foreign native tests are of CAD files of other systems, which are not part of the repository (KNEAD_SHARED names their folder)"
fi
stages_end
