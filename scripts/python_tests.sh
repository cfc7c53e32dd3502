# The tests of the Python package as a stage, to be sourced after stages.sh from the root of the project.

# Debian's, whose NumPy and SciPy the tests use.
python=$(realpath /usr/bin/python3)

# Installs the wheel of the build that is there into a new environment, without network, and tests it in a fresh directory.
python_tests() (  # python_tests [FILES]: all, or those of these names
  fresh=$(mktemp -d)
  trap 'rm -rf "$fresh"' EXIT
  "$python" bindings/python/backend/knead_backend.py "$fresh/dist"
  "$python" -m venv --system-site-packages "$fresh/venv"
  "$fresh/venv/bin/pip" install --quiet --no-index --no-deps "$fresh"/dist/*.whl
  cp -r tests/python "$fresh/tests"
  cp -r samples tests/scenarios examples/figures/patches.step "$fresh"
  cp bindings/python/README.md "$fresh/README-python.md"
  cp -r examples/python "$fresh/examples-python"
  export KNEAD_PROGRAM=$PWD/build/release/knead KNEAD_CLI_TEST=$PWD/build/release/tests/cli/cli_test KNEAD_WEB=$PWD/web
  cd "$fresh/tests"
  "$fresh/venv/bin/python" -X faulthandler run.py "${stage_counts:-/dev/null}" "${stage_failed:-/dev/null}" "$@"
)
