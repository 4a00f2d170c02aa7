#!/usr/bin/env bash
# How many object files of a build does an edit of one kernel make stale? Asks ninja what each was made of; fails above
# the limit, where nothing was built, and where a kernel has moved.
#
#   tests/staleness.sh BUILD [KERNEL LIMIT]...      KERNEL: its path in include/photongrid
set -euo pipefail
build=$1
shift
status=0
deps=$(ninja -C "$build" -t deps)
while (($# > 0)); do
  kernel=$1 limit=$2
  shift 2
  stale=$(awk -v file="include/photongrid/$kernel" '
    /^[^ ].*: #deps/ { object = $1; sub(/:$/, "", object) }
    index($0, file) && length($0) == index($0, file) + length(file) - 1 && object ~ /\.o$/ { print object }' <<<"$deps")
  count=$(grep -c . <<<"$stale" || true)
  echo "$kernel: an edit makes $count object files stale, at most $limit should be"
  if ((count > limit || count == 0)); then
    printf '%s\n' "$stale" | sed 's/^/    /'
    status=1
  fi
done
exit $status
