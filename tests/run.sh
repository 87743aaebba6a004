#!/bin/sh
# Installs what is missing, builds the release preset and runs its tests:
#   sh tests/run.sh                all of them
#   sh tests/run.sh unit numeric   only these labels (unit, numeric, slow)
set -eu
cd "$(dirname "$0")/.."
sh tests/install.sh tests
cmake --preset release
cmake --build --preset release
labels=$(echo "$*" | tr ' ' '|')
ctest --preset release --parallel "$(nproc)" ${labels:+--label-regex "$labels"}
