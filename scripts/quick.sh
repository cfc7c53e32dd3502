#!/usr/bin/env bash
# For every day: checks the format of what was changed, builds it, and runs the tests of the rooms that the change touches, but
# those that took more than a second when they last ran. A change is what differs from the last commit, or what that one brought.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/stages.sh
source scripts/native_tests.sh

changed=$(git diff --name-only --diff-filter=d HEAD; git ls-files --others --exclude-standard)
[ -n "$changed" ] || changed=$(git show --name-only --diff-filter=d --pretty= HEAD)
changes() { grep -E "$1" <<<"$changed" || true; }

rooms=$(changes '^(src|include/knead|tests)/' | sed -nE 's!^(src|include/knead|tests)/([a-z]+)/.*!\2!p' | sort -u)
[ -z "$(changes '^apps/knead/')" ] || rooms+=$'\n'cli
[ -z "$(changes '^bindings/')" ] || rooms+=$'\n'bindings
[ -z "$(changes '\.(cpp|hpp|txt|md)$')" ] || rooms+=$'\n'house
rooms=$(for room in $rooms; do [ ! -f "tests/$room/CMakeLists.txt" ] || [ "$room" = fuzz ] || echo "$room"; done | sort -u)
web=$(changes '^(web/src|tests/web|bindings/npm/src)/')

format() { changes '\.(cpp|hpp)$' | xargs -r clang-format --dry-run --Werror; }
build() {
  scripts/setup.sh test
  scripts/configure.sh release KNEAD_BUILD_TESTS=ON
  local targets=()
  for room in $rooms; do targets+=("${room}_test"); done
  cmake --build build/release --target knead_shared "${targets[@]}"
}
# What takes long, by the times that ctest keeps once tests have run: a name, which may have spaces, how often it ran, and the mean.
long_tests() {
  local times=build/release/Testing/Temporary/CTestCostData.txt
  [ ! -f $times ] || awk '
    $0 == "---" { exit }
    $NF > 1 { sub(/ [0-9]+ [^ ]+$/, ""); gsub(/[.[\]*^$()+?{}|\\]/, "\\\\&"); print "^" $0 "$" }' $times | paste -sd '|'
}
quick_tests() {
  local long
  long=$(long_tests)
  native_tests quick -L "^($(paste -sd '|' <<<"$rooms"))\$" ${long:+--exclude-regex "$long"}
}
studio_tests() { (cd web && npx tsc --noEmit && npx vitest related --run --config vitest.config.ts $(sed 's!^!../!' <<<"$web")); }

count=1
[ -z "$rooms" ] || count=$((count + 2))
[ -z "$web" ] || count=$((count + 1))
stages quick $count
stage "format" "" "make format" format
if [ -n "$rooms" ]; then
  stage "build" "" "make quick" build
  stage "tests of: $(paste -sd ' ' <<<"$rooms")" "build" "make quick" quick_tests
fi
if [ -n "$web" ]; then stage "studio in node" "" "(cd web && npm test)" studio_tests; fi
stages_end
