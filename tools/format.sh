#!/bin/sh
# format.sh: is every C++ file laid out as .clang-format says? Lays them out, or with --check only says which are not.
set -eu
cd "$(dirname "$0")/.."
files=$(git ls-files --cached --others --exclude-standard '*.h' '*.cpp')
if [ "${1:-}" = --check ]; then
  clang-format --dry-run --Werror $files
else
  clang-format -i $files
fi
