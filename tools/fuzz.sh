#!/bin/sh
# fuzz.sh: do the readers stand any bytes? Builds them with libFuzzer and the sanitizers, and runs each for a while.
#
#   tools/fuzz.sh [SECONDS] [FORMAT...]    60 seconds for each of pbrt glb gltf obj ply stl
#
# New inputs are kept in build/fuzz/corpus and used again; one that crashes is named, and stays in build/fuzz/found.
# Bring it to tests/fuzz/findings/, where every test run reads it.
set -eu
cd "$(dirname "$0")/.."

seconds=${1:-60}
[ $# -eq 0 ] || shift
formats=${*:-pbrt glb gltf obj ply stl}

compiler=
for name in clang++ clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14; do
  command -v $name >/dev/null && compiler=$name && break
done
[ -n "$compiler" ] || { echo "fuzz.sh needs clang (Debian: clang-14 libclang-rt-14-dev)" >&2; exit 1; }

cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DBOXWOOD_BUILD_TESTS=OFF -DBOXWOOD_BUILD_FUZZ=ON -DBUILD_SHARED_LIBS=OFF \
  -DCMAKE_CXX_FLAGS="-O1 -fsanitize=fuzzer-no-link,address,undefined -fsanitize-coverage-ignorelist=$PWD/tests/fuzz/not_traced.txt -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-unknown-warning-option" \
  >/dev/null
cmake --build build/fuzz --target boxwood_fuzz

mkdir -p build/fuzz/found
for format in $formats; do
  mkdir -p "build/fuzz/corpus/$format"
  echo "fuzzing the $format reader for $seconds s"
  # Leaks are looked for; 2 GB and 10 s for one input are the bounds of what is taken for a bomb or a hang.
  status=0
  "build/fuzz/fuzz_$format" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
    -artifact_prefix="build/fuzz/found/$format-" -print_final_stats=1 -verbosity=0 \
    "build/fuzz/corpus/$format" tests/fuzz/seeds/"$format" >build/fuzz/log 2>&1 || status=$?
  grep -E "ERROR|SUMMARY|Test unit|exec_per_sec|executed_units" build/fuzz/log || true
  if [ $status -ne 0 ] || ls build/fuzz/found/"$format"-* >/dev/null 2>&1; then
    tail -n 5 build/fuzz/log >&2
    echo "the $format reader fails; what it failed on is in build/fuzz/found" >&2
    exit 1
  fi
done
rm -rf "${TMPDIR:-/tmp}"/boxwood_fuzz_*
