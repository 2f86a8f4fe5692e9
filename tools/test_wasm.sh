#!/bin/sh
# test_wasm.sh: do the kernels say the same on WebAssembly? Builds test_simd for it and runs it under Node.js.
#
#   tools/test_wasm.sh [GOOGLETEST OPTIONS]     for instance --gtest_filter='KernelHash.*'
#
# Needs a Debian 12 or a relative of it (apt). Takes minutes.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh emscripten libgtest-dev libhwy-dev
command -v node > /dev/null || tools/setup.sh nodejs

# Debian keeps the modules that Emscripten needs here; a Node.js of another origin does not look there.
export NODE_PATH=/usr/share/nodejs

cmake -G Ninja -B build/wasm -DCMAKE_BUILD_TYPE=Release -DBOXWOOD_BUILD_APP=OFF \
  -DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
cmake --build build/wasm --target test_simd
# Emscripten 3.1 would fetch the module by its path as if it were an address, where Node.js can fetch.
exec node --no-experimental-fetch build/wasm/tests/test_simd.js "$@"
