#!/bin/sh
# bench/report.sh with programs that are scripts: what fails or is not there is named, all else is made,
# and what was measured is kept.
#   tests/bench_report_script.sh SOURCES REPORT      REPORT: the program bench/report, built
set -eu
sources=$1
report=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() {
  echo "$1" >&2
  cat out >&2
  exit 1
}

mkdir -p tools tests bench/pictures driver/examples/pictures build/bench/bench
cp "$sources/bench/report.sh" "$sources/bench/paper.json" bench
cp "$sources/README.md" README.md
echo 'exit 0' >tests/install.sh
# Everything is built already, but for mesh_bench.
cat >tools/cmake <<'END'
#!/bin/sh
case "$*" in *"--target help"*) ls build/bench/bench | sed 's/$/: phony/' ;; esac
END
cat >build/bench/bench/good_bench <<'END'
#!/bin/sh
cat <<ROWS
{"program": "p", "command": "${0##*/} $*", "date": "2026-01-02T03:04:05Z", "commit": "c", "compiler": "g",
 "processor": "x", "processors": 2, "load": 0.1, "rows": [
  {"table": "table1", "scene": "S1", "kappa": 1.0, "method": "drumhead, averaged", "n": 100, "threads": 1,
   "status": "converged", "seconds": 0.25, "bytes": 1000000, "bytes_per_node": 100.0}
]}
ROWS
END
chmod +x tools/cmake build/bench/bench/good_bench
cd build/bench/bench
for program in speed direct amg solve curves drag membranes masks stability resample kernels; do
  cp good_bench ${program}_bench
done
# One ends badly after whole rows, one amid them.
printf '#!/bin/sh\n"${0%%/*}/good_bench"\necho "a matrix was singular" >&2\nexit 1\n' >warps_bench
printf '#!/bin/sh\necho "{ \\"rows\\": ["\nkill -SEGV $$\n' >rates_bench
chmod +x warps_bench rates_bench
rm good_bench
cp "$report" report
cp masks_bench good_bench
cd "$folder"

run() {
  code=0
  PATH="$folder/tools:$PATH" sh bench/report.sh "$@" >out 2>&1 || code=$?
}
run --large --direct 800
[ $code = 1 ] || fail "exit code $code where programs fail"
grep -q '^failed: .*/warps.json.log .*/rates_1024.json.log$' out || fail "failures are not named at the end"
grep -q 'failed: a matrix was singular' out || fail "the reason is not said"
grep -q 'not built.* mesh_bench$' out || fail "what is not built is not named"
grep -q 'direct_bench --sponge --truth .* 400 800$' out || fail "no direct solvers at 800²"
grep -q 'direct_bench --sponge --threads .* 400$' out || fail "no direct solvers at 400² on threads"
for made in build/report/index.html bench/tables.md bench/pictures/speed.svg; do
  [ -s $made ] || fail "$made is not made"
done
grep -q '| drumhead, averaged, 1 thread |' README.md || fail "the README has no new table"
[ ! -e build/report/results/rates_0128.json ] || fail "half a document counts"

# Again: only what failed is measured; and once it does not fail, all is well.
cp build/bench/bench/good_bench build/bench/bench/warps_bench
cp build/bench/bench/good_bench build/bench/bench/rates_bench
touch -d 2020-01-01 build/bench/bench/warps_bench build/bench/bench/rates_bench
run --large --direct 800
[ $code = 0 ] || fail "exit code $code where nothing fails"
grep -q 'table1: measured before' out || fail "what was measured is measured again"
grep -q ' warps_bench $' out || fail "what failed is not measured again"
run --page
[ $code = 0 ] || fail "exit code $code of the page alone"
run --direct 600
[ $code = 2 ] || fail "exit code $code of an argument that is not known"
