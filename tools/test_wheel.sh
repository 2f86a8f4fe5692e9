#!/bin/sh
# test_wheel.sh: does the wheel work where nothing else is?
#
# Builds it (build_wheel.sh), installs it into a clean virtual environment, and runs the Python tests there, away from the
# sources.
set -eu
cd "$(dirname "$0")/.."
wheel=$(tools/build_wheel.sh)
venv=$PWD/build/python/venv

"${PYTHON:-python3}" -m venv --clear "$venv"
"$venv/bin/pip" install --quiet --disable-pip-version-check "$wheel[test]"
echo "Testing $(basename "$wheel")"
exec "$venv/bin/python" -m pytest -q "$@" python/tests
