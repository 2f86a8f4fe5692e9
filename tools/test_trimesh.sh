#!/bin/sh
# test_trimesh.sh: do trimesh's own ray tests pass with boxwood in place of its engines?
#
#   tools/test_trimesh.sh FOLDER    a checkout of trimesh's repository; after `make test-python`
#
# Not part of `make test`, because those tests and their models come with the repository alone.
set -eu
checkout=$(realpath "$1")
python=$(realpath "$(dirname "$0")/..")/build/python/venv/bin/python
"$python" -m pip install --quiet --disable-pip-version-check manifold3d  # one test cuts a cavity
cd "$checkout"
PYTHONPATH=tests exec "$python" -c '
import sys, pytest, boxwood.trimesh
boxwood.trimesh.use_everywhere()
sys.exit(pytest.main(["-q", "-W", "ignore", "tests/test_ray.py", "tests/test_ray_upstream.py"]))'
