#!/usr/bin/env bash
# ctest starts every test program through this, so that a program and its cases, each of which is a test too, do not
# run twice. A run of the whole program leaves its log behind; a case that the same ctest has already run so is looked
# up there, any other is run alone.
#
#   tests/case.sh LOG PROGRAM [ARGUMENT...]      LOG: where its logs go, a path without an ending
set -uo pipefail
log=$1
shift
name=
for argument in "$@"; do
  case $argument in
    --gtest_list_tests) # without the types and values, of which gtest_discover_tests would make names
      "$@" | sed 's/ *# \(TypeParam\|GetParam()\) = .*//'
      exit "${PIPESTATUS[0]}"
      ;;
    --gtest_filter=*) name=${argument#--gtest_filter=} ;;
  esac
done
# The ctest that started this: its process and when that began, since numbers of processes come again.
status=()
[[ ! -r /proc/$PPID/stat ]] || read -r -a status <"/proc/$PPID/stat"
session=$PPID-${status[21]:-0}

if [[ -z $name || $name == *[*?:-]* ]]; then
  for old in "$log".*; do
    [[ $old == "$log.$session."* ]] || rm -f "$old"
  done
  mkdir -p "${log%/*}"
  "$@" 2>&1 | tee "$log.$session.$$"
  exit "${PIPESTATUS[0]}"
fi
for run in "$log.$session."*; do
  [[ -e $run ]] || break
  awk -v name="$name" '
    index($0, "[ RUN      ] " name) == 1 && length($0) == 13 + length(name) { inside = 1 }
    inside { print }
    inside && /^\[       OK \] / { found = 1; exit 0 }
    inside && /^\[  SKIPPED \] / { found = 1; exit 0 }
    inside && /^\[  FAILED  \] / { found = 1; failed = 1; exit 1 }
    END { exit found ? failed + 0 : 2 }' "$run"
  result=$?
  ((result == 2)) || exit $result
done
exec "$@"
