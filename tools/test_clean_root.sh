#!/bin/sh
# test_clean_root.sh: does the wheel work on a machine that has nothing else?
#
#   tools/test_clean_root.sh FOLDER    as root, on Debian; FOLDER is made, about 400 MB
#
# Makes a minimal Debian 12 with Python and no compiler in FOLDER (debootstrap), installs the wheel of build_wheel.sh and NumPy into it
# from files, with no index to ask, and uses it. Not part of `make test`: it downloads a system.
set -eu
root=$(realpath -m "$1")
cd "$(dirname "$0")/.."
tools/setup.sh debootstrap

[ -x "$root/usr/bin/python3" ] || debootstrap --variant=minbase --include=python3,python3-venv bookworm "$root"
wheel=$(PYTHON=/usr/bin/python3 tools/build_wheel.sh)
mkdir -p "$root/wheels"
cp "$wheel" "$root/wheels"
build/python/tools/bin/pip download --quiet --only-binary :all: --dest "$root/wheels" numpy

chroot "$root" sh -euc '
  ! command -v cc c++ gcc g++ cmake
  rm -rf /venv
  python3 -m venv /venv
  /venv/bin/pip install --quiet --no-index --find-links /wheels boxwood
  cd / && /venv/bin/python -c "
import numpy as np, boxwood as bw
scene = bw.load(\"stilllife\")
hits = scene.closest_hit([0, 1, 9], np.random.default_rng(0).normal(size=(100000, 3)))
assert 0 < (hits.primitive_id >= 0).sum() < 100000
print(bw.cpu_target(), scene, hits)
"'
