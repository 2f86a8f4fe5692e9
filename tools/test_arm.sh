#!/bin/sh
# test_arm.sh: do the kernels say the same on 64-bit ARM? Builds test_simd for it and runs it under QEMU.
#
#   tools/test_arm.sh [GOOGLETEST OPTIONS]     for instance --gtest_filter='KernelHash.*'
#
# Needs a Debian 12 or a relative of it (apt). The cross compiler and QEMU are installed like any package; the
# libraries for arm64 are only unpacked into build/arm-root, so the machine stays what it is. Takes minutes:
# QEMU runs the tests ten to forty times slower.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh g++-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user

# Fetch the libraries with a package list of our own, for arm64 alone.
root=$PWD/build/arm-root
if [ ! -e "$root/complete" ]; then
  state=$PWD/build/arm-packages
  mkdir -p "$root" "$state/lists/partial" "$state/cache/archives/partial" "$state/debs"
  : > "$state/status"
  apt_arm() {
    apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$state" \
      -o Dir::State::status="$state/status" -o Dir::Cache="$state/cache" -o APT::Sandbox::User="$(id -un)" "$@"
  }
  apt_arm update
  (cd "$state/debs" && apt_arm download libhwy-dev libhwy1 libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libgtest-dev)
  for package in "$state"/debs/*.deb; do dpkg-deb -x "$package" "$root"; done
  rm -rf "$state"
  touch "$root/complete"
fi

cmake -G Ninja -B build/arm -DCMAKE_BUILD_TYPE=Release -DBOXWOOD_BUILD_APP=OFF \
  -DCMAKE_TOOLCHAIN_FILE=cmake/toolchains/aarch64-linux-gnu.cmake -DBOXWOOD_ARM_ROOT="$root"
cmake --build build/arm --target test_simd
exec qemu-aarch64 -L /usr/aarch64-linux-gnu build/arm/tests/test_simd "$@"
