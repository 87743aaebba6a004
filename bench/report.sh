#!/bin/sh
# Measures drumhead and its rivals and makes one page of it, from a clean clone of a Debian 12, as root
# or with sudo: installs what is missing, builds, runs the programs of bench/ one after another, writes
#     build/report/index.html     the page: plots, tables, pictures, in one file
#     bench/tables.md             all tables
#     bench/pictures/*.svg        the README's plots; its tables are put into README.md itself
#   sh bench/report.sh              some 25 minutes on two quiet cores
#   sh bench/report.sh --large      also solves at 1600² and 3200², errors up to 1600² against finer
#                                   references, algebraic multigrid at 400², rates at 1024² (10 minutes)
#   sh bench/report.sh --direct N   also direct solvers on the sponge at 400² (N 400) or up to 800² (N 800;
#                                   some GB and 8 minutes)
#   sh bench/report.sh --page       measures nothing: the page of what was measured before
# What was measured since a program was last built is kept: run again, it goes on where it stopped.
# Leave the machine alone meanwhile; the page says how loaded it was. A program that fails is named at the
# end, the rest is made without it, and the exit code is 1.
set -eu
cd "$(dirname "$0")/.."

large=
direct=
measure=yes
while [ $# -gt 0 ]; do
  case $1,${2:-} in
    --large,*) large=--large ;;
    --direct,400)
      direct="400"
      shift
      ;;
    --direct,800)
      direct="400 800"
      shift
      ;;
    --page,*) measure= ;;
    *)
      echo "usage: bench/report.sh [--large] [--direct 400|800] [--page]" >&2
      exit 2
      ;;
  esac
  shift
done

programs="speed_bench direct_bench mesh_bench amg_bench warps_bench solve_bench curves_bench drag_bench
  rates_bench membranes_bench masks_bench stability_bench resample_bench kernels_bench report"
folder=build/bench
results=build/report/results
mkdir -p $results bench/pictures

sh tests/install.sh bench
cmake --preset release -B $folder -DDRUMHEAD_BUILD_BENCH=ON -DDRUMHEAD_BUILD_TESTS=OFF \
  -DDRUMHEAD_BUILD_DRIVER=OFF >build/report/configure.log
# A rival whose package is not there has no program.
cmake --build $folder --target help >build/report/targets.log
targets=
for program in $programs; do
  ! grep -q "^$program:" build/report/targets.log || targets="$targets $program"
done
[ "$measure" ] || targets=report
cmake --build $folder --target $targets

# libgomp's threads otherwise spin between loops, on whatever else the machine does; direct solvers say
# themselves how many threads their BLAS gets.
export OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1
failed=
missing=
# stage NAME PROGRAM ARGUMENT…: leaves its rows in NAME.json.
stage() {
  file=$results/$1.json
  program=$folder/bench/$2
  if [ ! -x "$program" ]; then
    missing="$missing $2"
    return 0
  fi
  if [ "$file" -nt "$program" ]; then
    echo "$(date +%T) $1: measured before"
    return 0
  fi
  shift 2
  echo "$(date +%T) ${program##*/} $*"
  if "$program" "$@" >"$file.part" 2>"$file.log"; then
    mv "$file.part" "$file"
  else
    failed="$failed $file.log"
    echo "failed: $(tail -n 1 "$file.log")"
    # Rows until then count, if the program could end its document, and are measured again next time.
    if [ "$(tail -n 1 "$file.part")" = "]}" ]; then
      mv "$file.part" "$file"
      touch -d 1970-01-02 "$file"
    else
      rm -f "$file" "$file.part"
    fi
  fi
}
if [ "$measure" ]; then
  cores=$(nproc)
  # Fine references are solved once and shared, unless the solver is newer.
  truth=
  if [ "$large" ]; then
    [ build/report/truth -nt $folder/bench/speed_bench ] || rm -rf build/report/truth
    mkdir -p build/report/truth
    truth="--truth build/report/truth"
  fi
  stage table1 speed_bench table1 $large
  stage precision speed_bench precision $truth
  stage tolerances speed_bench tolerances
  stage solvers speed_bench solvers $truth
  stage curves curves_bench $truth
  stage solve solve_bench $large
  stage drag drag_bench
  stage mesh mesh_bench $truth
  stage amg amg_bench $large $truth
  stage warps warps_bench
  stage stability stability_bench
  stage study stability_bench --exact 32 --exact 128
  stage membranes membranes_bench
  stage masks masks_bench
  for n in 128 256 512 ${large:+1024}; do
    stage rates_$(printf %04d $n) rates_bench $n
  done
  stage direct direct_bench $truth
  stage direct_sponge direct_bench --sponge $truth 150 300
  stage direct_threads direct_bench --sponge --threads "$cores" 50 100 150 200 300
  if [ "$direct" ]; then
    stage direct_large direct_bench --sponge $truth $direct
    stage direct_large_threads direct_bench --sponge --threads "$cores" 400
  fi
  stage resample resample_bench
  stage kernels kernels_bench
fi

report=$folder/bench/report
# Without measurements there is the paper's table alone.
set -- $(ls $results/*.json 2>/dev/null) bench/paper.json
$report -o build/report/index.html --plots bench/pictures --pictures driver/examples/pictures "$@"
{
  echo '# Everything that was measured'
  echo
  echo 'Made by `sh bench/report.sh`; what it means stands in [README.md](README.md).'
  echo
  $report --markdown "$@"
} >bench/tables.md
$report --readme README.md "$@"
echo
echo "$PWD/build/report/index.html"
echo "bench/tables.md bench/pictures README.md"
[ -z "$missing" ] || echo "not built, because a package is not there:$missing"
[ -z "$failed" ] || {
  echo "failed:$failed" >&2
  exit 1
}
