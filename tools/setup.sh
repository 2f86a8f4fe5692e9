#!/bin/sh
# setup.sh: what must be installed to build Boxwood? Installs what is missing and nothing else.
#
#   tools/setup.sh              everything that `make build`, `make demo`, `make test` and `make bench` need
#   tools/setup.sh PACKAGE...   these Debian packages as well
#
# Needs a Debian 12 or a relative of it (apt). Elsewhere it lists what to install by hand. A second run does nothing.
set -eu

packages() {  # name, and what for
  cat <<'LIST'
cmake                 the build
ninja-build           the build
g++                   the compiler, with C++20
ccache                makes a second build fast
python3               the layer check, the docs check and the test runner
python3-venv          the Python wheel and its tests; pip brings the rest
python3-dev           Python's headers, for the module
libtbb-dev            oneTBB: parallel loops
libhwy-dev            Highway: SIMD with a choice at run time
libopenimageio-dev    pictures and textures
libtinygltf-dev       glTF files
libtinyobjloader-dev  OBJ files
nlohmann-json3-dev    --json
libcli11-dev          the command line
libfmt-dev            text on the terminal
libopenmpi-dev        Open MPI: renders shared among machines
openmpi-bin           mpirun, which starts them
libgtest-dev          GoogleTest: the tests
libbenchmark-dev      Google Benchmark: make microbench
libembree-dev         Embree, a peer to compare with in tests and in boxwood bench
LIST
}

by_hand() {
  echo "Boxwood's set-up knows Debian's apt only. Please install these by hand (Debian's names), then use CMake:" >&2
  packages | sed 's/^/  /' >&2
  echo "  cmake --preset release && cmake --build --preset release && ctest --preset release" >&2
  exit 1
}

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# Without apt, go on only if the tools are there anyway; CMake names any library that is missing.
if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  command -v cmake >/dev/null && command -v ninja >/dev/null && command -v python3 >/dev/null && exit 0
  by_hand
fi

missing=
for package in $(packages | cut -d' ' -f1) "$@"; do
  is_installed "$package" || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "These packages are missing, and there is neither root nor sudo to install them:$missing" >&2
    exit 1
  }
  as_root=sudo
fi

echo "Installing$missing"
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq
# env, because sudo does not hand variables on.
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
