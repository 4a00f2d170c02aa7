#!/usr/bin/env bash
# Puts what bench/run.sh printed into docs/reference/measures.md: each section's text between `<!-- bench: TITLE -->` and `<!-- /bench -->`,
# with the machine, the day and the commit under it. Sections that were not measured stay as they are.
#
#   bench/write_measures.sh MEASURED [PAGE]      PAGE: docs/reference/measures.md
#   bench/write_measures.sh --mark [PAGE]        measures nothing: marks sections whose commit is older than the code, and
#                                                takes the mark off others
set -euo pipefail
measured=${1:?"give the output of bench/run.sh as the first argument"} page=${2:-$(dirname "${BASH_SOURCE[0]}")/../docs/reference/measures.md}
written=$(mktemp)
trap 'rm -f "$written"' EXIT
if [[ $measured == --mark ]]; then
  page=$(realpath "$page")
  cd "$(dirname "${BASH_SOURCE[0]}")/.."
  # These two scripts measure nothing that the page holds. Commits of comments alone do not count either.
  code=(include backends bench examples ':!bench/against.sh' ':!bench/write_measures.sh')
  while IFS= read -r commit; do
    changed=0
    git diff --quiet --ignore-matching-lines='^ *(//|# )' "$commit" HEAD -- "${code[@]}" || changed=$?
    if ((changed > 1)); then
      echo "bench/write_measures.sh: $commit is not in this repository's history; its sections keep their marks" >&2
      exit 2
    elif ((changed == 1)); then
      echo "$commit *Older than the code: $(git rev-list --count "$commit..HEAD" -- "${code[@]}") commits from $commit to $(git rev-parse --short HEAD) have changed include, backends, bench or examples.*"
    fi
  done < <(sed -n 's/^.*; photongrid \([0-9a-f]*\)\.$/\1/p' "$page" | sort -u) >"$written.marks"
  trap 'rm -f "$written" "$written.marks"' EXIT
  awk '
    FILENAME == ARGV[1] { commit = $1; sub(/^[^ ]+ /, ""); mark[commit] = $0; next }
    /^\*Older than the code: .*\*$/ { next }
    { print }
    match($0, /; photongrid [0-9a-f]+\.$/) {
      commit = substr($0, RSTART + 13, RLENGTH - 14)
      if (commit in mark)
        print mark[commit]
    }' "$written.marks" "$page" >"$written"
  cat "$written" >"$page"
  exit
fi
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
