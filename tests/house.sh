#!/bin/sh
# Checks of the source tree and of the built libraries that no compiler makes:
#   sh tests/house.sh files | functions | arrows | readme
#   sh tests/house.sh sparse LIBRARY.a…   |   sh tests/house.sh instruction_sets KERNELS.a
# Prints every offending line; exit code 1 if there is one.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8
check=$1
shift
found=$(mktemp)
trap 'rm -f "$found"' EXIT

# offend "reason": the lines on standard input are offences.
offend() {
  sed "s|^|$1: |" >>"$found"
}
sources() {
  find "$@" -name '*.h' -o -name '*.cpp'
}
# lines REGEX FOLDER…: matching lines as file:line:text
lines() {
  pattern=$1
  shift
  sources "$@" | xargs -r grep -nHE "$pattern" || true
}

check_files() {
  sources kernels grid multigrid driver tests bench | while read -r file; do
    count=$(wc -l <"$file")
    [ "$count" -le 400 ] || echo "$file ($count)"
  done | offend "more than 400 lines"
  # \X: x̂ is two code points in one column.
  sources kernels grid multigrid driver tests bench | xargs -r grep -nHP '^\X{101}' |
    offend "more than 100 columns"
  sources kernels grid multigrid driver tests bench | while read -r file; do
    head -n 1 "$file" | grep -qF '// SPDX-License-Identifier: MIT' || echo "$file"
  done | offend "no SPDX line"
}

# In text as clang-format leaves it, a function begins at its scope's indent and ends with a brace at
# the same. Tables (return {…) and the one formula of a flattened row kernel may be longer.
check_functions() {
  sources kernels grid multigrid driver bench | xargs awk '
    FNR == 1 { begin[0] = begin[2] = 0 }
    /^(  )?[^ }#\/]/ {
      indent = match($0, /[^ ]/) - 1
      begin[indent] = FNR
      free[indent] = /gnu::flatten/
    }
    /^  return \{$/ && begin[0] == FNR - 1 { free[0] = 1 }
    /^(  )?\}$/ {
      indent = match($0, /[^ ]/) - 1
      count = FNR - begin[indent] + 1
      if (count > 60 && !free[indent]) print FILENAME ":" begin[indent] " (" count ")"
    }' | offend "more than 60 lines"
}

# driver → multigrid → grid → kernels, and where other libraries may be seen.
check_arrows() {
  lines '#include [<"]drumhead/(grid|multigrid)/' kernels | offend "arrow drawn backwards"
  lines '#include [<"]drumhead/multigrid/' grid | offend "arrow drawn backwards"
  lines '#include "[^"]*/' kernels grid multigrid driver | offend "a folder's insides, or <> wanted"
  lines '#include' kernels/include grid/include multigrid/include |
    grep -vE '#include <(drumhead/[a-z]+/[a-z_]+\.h|[a-z_]+)>$' | offend "in a public header"
  lines 'xsimd[:/]' grid multigrid driver tests bench | offend "xsimd outside kernels/"
  { lines 'Eigen[:/]' kernels grid driver
    lines 'Eigen[:/]' multigrid | grep -v '^multigrid/[a-z_]*\.cpp:'; } |
    offend "Eigen outside multigrid/*.cpp and tests/"
  lines '#pragma omp|<omp\.h>' kernels grid multigrid driver |
    grep -vE '^kernels/(parallel\.h|resample[a-z_]*\.(h|cpp)):' | offend "threads"
  lines '_mm[0-9]*_|intrin\.h' kernels grid multigrid driver | grep -v '^kernels/batch\.h:' |
    offend "intrinsics outside kernels/batch.h"
  lines '<iostream>|<fstream>|printf\(|std::(cout|cerr|exit|abort)' kernels grid multigrid |
    grep -v 'snprintf' | offend "printing or exiting in the library"
}

# The two commands of the README exist, and each of its C++ blocks is a program of tests/consumer/.
check_readme() {
  for command in 'sh driver/demo.sh' 'sh tests/run.sh'; do
    grep -qF "$command" README.md || echo "$command" | offend "not in README.md"
    [ -f "${command#sh }" ] || echo "$command" | offend "named in README.md but missing"
  done
  programs=$(sed -n 's/^```cpp //p' README.md)
  [ -n "$programs" ] || echo 'no ```cpp tests/consumer/… block' | offend "README.md"
  for program in $programs; do
    awk -v fence="\`\`\`cpp $program" '$0 == "```" { on = 0 } on; $0 == fence { on = 1 }' README.md |
      diff - "$program" | grep '^[<>]' | grep -v 'SPDX-License-Identifier' |
      offend "README.md (<) against $program (>)" || true
  done
}

check_sparse() {
  for library in "$@"; do
    nm -C --defined-only "$library" 2>/dev/null | grep -q ' T ' ||
      echo "$library" | offend "holds no function"
    nm -C "$library" 2>/dev/null | grep -F 'Eigen::Sparse' | offend "$library"
  done
}

# An inline function compiled for AVX-512 and also for every processor is one function to the linker,
# which keeps either: everything visible in an instruction set's object must carry that set's name.
check_instruction_sets() {
  symbols=$(mktemp)
  nm -C --defined-only "$1" 2>/dev/null >"$symbols"
  awk -v sets='scalar sse2 avx2 avx512' '
    # Leaves the sets met in what the object defines, by object; then judges each of its symbols.
    BEGIN { n = split(sets, set) }
    /^[^ ]*:$/ { object = ++objects; name[object] = $0; next }
    $2 ~ /^[TWVuBDRGS]$/ {
      for (k = 1; k <= n; ++k)
        if (index($0, "drumhead::kernels::" set[k] "::")) of[object] = of[object] " " set[k]
      line[object, ++count[object]] = $0
    }
    END {
      for (o = 1; o <= objects; ++o) {
        if (!of[o]) continue
        split(of[o], met, " ")
        ++seen[met[1]]
        for (l = 1; l <= count[o]; ++l) {
          ok = index(line[o, l], "drumhead::kernels::" met[1] "::") || line[o, l] ~ /DW\.ref\./
          if (!ok) print name[o] " " line[o, l]
        }
      }
      for (k = 1; k <= n; ++k) if (!seen[set[k]]) print "no object of " set[k]
    }' "$symbols" | offend "outside its instruction set's namespace"
  rm -f "$symbols"
}

"check_$check" "$@"
cut -c 1-240 "$found"
[ ! -s "$found" ]
