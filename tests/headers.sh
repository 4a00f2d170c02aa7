#!/usr/bin/env bash
# Looks at what each header, preprocessed alone, does to a user's file. No macro of photongrid's may survive it but the version's:
# one that a file of photongrid's defines and none undefines; and HWY_DISABLED_TARGETS, which Highway needs from its first
# header on, and would define itself. And a header that is not a backend's may read nothing of the
# packages that only backends need. Nor may any file undefine a macro that the user's file may have, unless it is saved first.
#
#   tests/headers.sh [--together] COMPILER HEADER... -- FLAG...
#
#   --together  not each header alone, but all that are no backend's in one file, and all of backends in another: quicker
set -euo pipefail
together=no
if [[ $1 == --together ]]; then
  together=yes
  shift
fi
compiler=$1
shift
headers=()
while [[ $1 != -- ]]; do
  headers+=("$1")
  shift
done
shift
if ((${#headers[@]} == 0)); then
  echo "no headers"
  exit 2
fi

status=0
# Those of kernels are saved by begin.hpp and taken back by end.hpp; any other file saves its own.
root=$(dirname "${BASH_SOURCE[0]}")/..
find "$root"/include "$root"/backends \( -name '*.hpp' -o -name '*.glsl' \) -print0 | xargs -0 awk '
  FNR == 1 { delete saved; ++files; reads_begin = FILENAME ~ /\.glsl$|\/core\/end\.hpp$/ }
  /^#pragma push_macro/ { split($0, part, "\""); saved[part[2]]; if (files == 1) in_begin[part[2]] }
  match($0, /^ *# *undef +/) {
    name = substr($0, RLENGTH + 1)
    sub(/[^A-Za-z0-9_].*/, "", name)
    if (name !~ /^PHOTONGRID_/ && !(name in saved) && !(reads_begin && name in in_begin)) {
      print FILENAME ":" FNR ": undefines " name ", which may be the macro of a user, and no push_macro has saved it"
      failed = 1
    }
  }
  END { exit failed }' "$root"/include/photongrid/core/begin.hpp || status=1
is_core() { [[ $1 != */backends/* && $1 != */backend_texts/* ]]; }
include() { printf '#include "%s"\n' "$@"; }
files=()
if [[ $together == yes ]]; then
  core_headers=() backend_headers=()
  for header in "${headers[@]}"; do
    if is_core "$header"; then core_headers+=("$header"); else backend_headers+=("$header"); fi
  done
  files=("$(include "${core_headers[@]}")" "$(include "${backend_headers[@]}")")
else
  for header in "${headers[@]}"; do files+=("$(include "$header")"); done
fi
for file in "${files[@]}"; do
  core=no
  if is_core "$file"; then core=yes; fi
  # -dD keeps #define and #undef, among lines `# number "file"`. The texts of kernels have lines that look the same.
  complaints=$("$compiler" -std=c++20 -E -dD -x c++ "$@" - <<<"$file" | awk -v core=$core '
    /R"glsl\(/ { in_text = 1 }
    /\)glsl"/ { in_text = 0 }
    in_text { next }
    /^# [0-9]+ "/ {
      ours = $3 ~ /\/photongrid\//
      if (core == "yes" && $3 ~ /\/(tbb|oneapi|hwy|EGL|GL|vulkan|glslang|spirv-tools)\//) print "reads " $3
    }
    /^#define / && ours { name = $2; sub(/\(.*/, "", name); left[name] }
    /^#undef / { delete left[$2] }
    END { for (name in left) if (name !~ /^(PHOTONGRID_VERSION_(MAJOR|MINOR|PATCH)|HWY_DISABLED_TARGETS)$/) print "leaves the macro " name " behind" }')
  if [[ -n $complaints ]]; then
    printf '%s:\n%s\n' "$file" "$complaints"
    status=1
  fi
done
exit $status
