#!/bin/sh
# The tree against .clang-format and .clang-tidy (minutes; not a part of the tests):
#   sh tests/tidy.sh         shows what differs, exit code 1 if anything does
#   sh tests/tidy.sh --fix   formats in place
set -eu
cd "$(dirname "$0")/.."
sh tests/install.sh all
mode='--dry-run -Werror'
[ "${1:-}" != --fix ] || mode=-i
find kernels grid multigrid driver tests bench -name '*.h' -o -name '*.cpp' |
  xargs clang-format-14 $mode
[ "${1:-}" != --fix ] || exit 0
cmake --preset clang
run-clang-tidy-14 -p build/clang -quiet
