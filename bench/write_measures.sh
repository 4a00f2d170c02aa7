#!/usr/bin/env bash
# Puts what bench/run.sh printed into docs/reference/measures.md: each section's text between `<!-- bench: TITLE -->` and `<!-- /bench -->`,
# with the machine, the day and the commit under it. Sections that were not measured stay as they are.
#
#   bench/write_measures.sh MEASURED [PAGE]      PAGE: docs/reference/measures.md
set -euo pipefail
measured=${1:?"give the output of bench/run.sh as the first argument"} page=${2:-$(dirname "${BASH_SOURCE[0]}")/../docs/reference/measures.md}
written=$(mktemp)
trap 'rm -f "$written"' EXIT
awk '
  function trimmed(text) { gsub(/^\n+|\n+$/, "", text); return text }
  FNR == NR && /^Machine: / {
    split($0, part, "; ")
    short = part[1] "; " part[2] "; " substr($0, match($0, /photongrid [^ ]+$/))
    known["Machine"] = 1
    text["Machine"] = substr($0, 10)
    next
  }
  FNR == NR && /^### / { title = substr($0, 5); known[title] = 1; next }
  FNR == NR { if (title != "") text[title] = text[title] $0 "\n"; next }
  /^<!-- bench: .* -->$/ {
    title = substr($0, 13, length($0) - 16)
    print
    if (title in known) {
      print trimmed(text[title])
      if (title != "Machine")
        printf "\n%s.\n", substr(short, 10)
      used[title] = skipping = 1
    }
    next
  }
  /^<!-- \/bench -->$/ { skipping = 0 }
  !skipping { print }
  END {
    for (title in known)
      if (!(title in used)) {
        print "bench/write_measures.sh: the page has no place for \"" title "\": <!-- bench: " title " -->" >"/dev/stderr"
        failed = 1
      }
    exit failed
  }' "$measured" "$page" >"$written"
cat "$written" >"$page"
