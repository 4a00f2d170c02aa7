#!/usr/bin/env bash
# Looks at what each header, preprocessed alone, does to a user's file. No macro of photongrid's may survive it but the version's:
# one that a file of photongrid's defines and none undefines. And a header that is not a backend's may read nothing of the
# packages that only backends need.
#
#   tests/headers.sh COMPILER HEADER... -- FLAG...
set -euo pipefail
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
for header in "${headers[@]}"; do
  core=yes
  [[ $header != */backends/* && $header != */backend_texts/* ]] || core=no
  # -dD keeps #define and #undef, among lines `# number "file"`. The texts of kernels have lines that look the same.
  complaints=$("$compiler" -std=c++20 -E -dD -x c++ "$@" - <<<"#include \"$header\"" | awk -v core=$core '
    /R"glsl\(/ { in_text = 1 }
    /\)glsl"/ { in_text = 0 }
    in_text { next }
    /^# [0-9]+ "/ {
      ours = $3 ~ /\/photongrid\//
      if (core == "yes" && $3 ~ /\/(tbb|oneapi|hwy|EGL|GL|vulkan|glslang|spirv-tools)\//) print "reads " $3
    }
    /^#define / && ours { name = $2; sub(/\(.*/, "", name); left[name] }
    /^#undef / { delete left[$2] }
    END { for (name in left) if (name !~ /^PHOTONGRID_VERSION_(MAJOR|MINOR|PATCH)$/) print "leaves the macro " name " behind" }')
  if [[ -n $complaints ]]; then
    printf '%s:\n%s\n' "$header" "$complaints"
    status=1
  fi
done
exit $status
