#!/bin/sh
# Builds the benchmarks and prints the tables of bench/README.md, headed by the processor:
#   sh bench/run.sh            kernels, then whole solves up to 800²
#   sh bench/run.sh --large    also solves at 1600² and 3200²
#   sh bench/run.sh --petsc    installs Debian's PETSc first, as one more competitor
#   sh bench/run.sh --direct   installs UMFPACK first, for the same Newton's method with a direct solver
#   sh bench/run.sh --samplers installs OpenCV and libvips first, to sample by our maps
set -eu
cd "$(dirname "$0")/.."

large=
direct=
install() {
  as_root=
  [ "$(id -u)" = 0 ] || as_root=sudo
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@" >&2
}
for argument in "$@"; do
  case $argument in
    --large) large=--large ;;
    --petsc) install libpetsc-real-dev ;;
    --direct)
      install libsuitesparse-dev
      direct=direct_bench
      ;;
    --samplers) install libopencv-imgproc-dev libvips-dev ;;
    *)
      echo "usage: bench/run.sh [--large] [--petsc] [--direct] [--samplers]" >&2
      exit 2
      ;;
  esac
done
sh tests/install.sh >&2

folder=build/bench
cmake --preset release -B $folder -DDRUMHEAD_BUILD_BENCH=ON -DDRUMHEAD_BUILD_TESTS=OFF \
  -DDRUMHEAD_BUILD_DRIVER=OFF >&2
cmake --build $folder --target kernels_bench resample_bench solve_bench curves_bench rates_bench \
  membranes_bench $direct >&2

# libgomp's threads otherwise spin between loops, on whatever else the machine does.
export OMP_WAIT_POLICY=passive
export OPENBLAS_NUM_THREADS=1
field() {
  lscpu | sed -n "s/^$1: *//p" | head -n 1
}
echo "$(field 'Model name'), family $(field 'CPU family') model $(field Model), $(field 'CPU(s)')" \
  "processors; caches: L1d $(field 'L1d cache'), L2 $(field 'L2 cache'), L3 $(field 'L3 cache');" \
  "$(c++ --version | head -n 1); commit $(git rev-parse --short HEAD 2>/dev/null || echo none)"
echo
$folder/bench/kernels_bench
echo
$folder/bench/resample_bench
echo
$folder/bench/solve_bench $large
echo
$folder/bench/curves_bench
echo
$folder/bench/rates_bench
echo
$folder/bench/membranes_bench
[ -z "$direct" ] || {
  echo
  $folder/bench/direct_bench
}
