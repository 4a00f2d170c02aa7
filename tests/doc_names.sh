#!/usr/bin/env bash
# Checks README.md, CONTRIBUTING.md and docs/**/*.md: every name in backticks exists in the tree, and every relative link
# resolves, its heading too. docs/README.md links every page of docs/.
#
#   tests/doc_names.sh
#
# A name is an identifier or an option in a tracked source (comments and measures do not count), a tracked path or the
# end of one, or a word of tests/doc_words.txt. What the pages add_a_*.md make is there, too (tests/growth.sh).
# In paths <...>, * and words in capitals stand for anything. Single letters, numbers and what build folders hold are
# not looked up. Prints what is missing as PAGE:LINE and exits 1.
# shellcheck disable=SC2016 # awk's variables
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if git rev-parse --git-dir >/dev/null 2>&1; then
  git ls-files >"$work/paths"
else # a copy without its history
  find . -type d \( -name 'build*' -o -name out \) -prune -o -type f -print | sed 's|^\./||' >"$work/paths"
fi
sources() { grep -E "$1" "$work/paths" | grep -vxE 'tests/doc_words\.txt|tests/doc_names\.sh|tests/io/scene_corpus/.*/.*|bench/results/.*' | tr '\n' '\0' | xargs -0 cat; }
{
  sources '\.(hpp|cpp|glsl)$' | sed -E 's|(^\|[^:])//.*|\1|'
  sources '(\.(cmake|sh|py|in|supp)|CMakeLists\.txt|Doxyfile|\.ci/run)$' | sed -E 's/(^|[[:space:]])#.*//'
  sources '\.(json|dict)$'
  cat .clang-format 2>/dev/null || true
  awk '/^```/ { fenced = !fenced; next } fenced' docs/guide/add_a_*.md
} >"$work/text"
sed -n 's/^New file `\(.*\)`:$/\1/p' docs/guide/add_a_*.md >>"$work/paths"
grep -oE '[A-Za-z_][A-Za-z0-9_]*' "$work/text" | sort -u >"$work/names"
grep -oE -e '--[a-z][a-z0-9_-]*' "$work/text" | sort -u >"$work/options"
awk '!/^#/ && NF { if (NF < 2) { print "tests/doc_words.txt:" FNR ": " $1 ": give a reason" >"/dev/stderr"; exit 1 } print $1 }' \
  tests/doc_words.txt >"$work/words"

grep -E '^(README|CONTRIBUTING)\.md$|^docs/.*\.md$' "$work/paths" >"$work/pages"
xargs awk -v work="$work" '
  function note(text) { print FILENAME ":" FNR ": " text; failed = 1 }
  # The paths that end in `path`, in which capitals and <...> stand for anything.
  function is_path(path,   pattern, candidate) {
    sub(/\/$/, "", path)
    sub(/^<?photongrid\/backends\//, "backends/", path)
    sub(/\.kernel\.hpp$/, ".glsl", path) # made of it
    if (path in ends || (path ".cpp") in ends)
      return 1
    if (path !~ /[*<]|[A-Z][A-Z]|\.\.\./)
      return 0
    pattern = path
    gsub(/\.\.\./, "@", pattern)
    gsub(/<[a-z]+>|[A-Z][A-Z_]+|\*+/, "@", pattern)
    gsub(/[.+()\[\]$^|{}?]/, "[&]", pattern)
    gsub(/@/, "[^/]+", pattern)
    for (candidate in ends)
      if (candidate ~ ("^" pattern "$"))
        return 1
    return 0
  }
  # Is there a name that begins with `start`? Pages shorten long ones: every_kernel_...
  function begins(start,   name) {
    for (name in known)
      if (index(name, start) == 1)
        return 1
    return 0
  }
  function check(span,   shown, rest, token) { # changes RSTART, RLENGTH
    shown = "`" span "`: "
    rest = span
    # Paths.
    while (match(rest, /[A-Za-z0-9_.*<>-]*[A-Za-z0-9_*>-](\/[A-Za-z0-9_.*<>-]+)*\/?/)) {
      token = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH)
      gsub(/^<|>$/, "", token)
      if (token ~ /^(\.\/)?(build|out)[^\/]*\// || token ~ /^http/)
        continue
      if (token in ends || token ~ /^(backends|bench|cmake|docs|examples|include|photongrid|tests)\// || token ~ /[a-z]\/$/ \
          || token ~ /[A-Za-z_*]\.(hpp|cpp|glsl|md|cmake|sh|supp|txt|svg|dict)$/) {
        if (!is_path(token) && !(token in known))
          note(shown "no path ends in " token)
        gsub(/[]^$.*+?(){}|[\\]/, "\\\\&", token)
        sub(token, " ", span)
      }
    }
    # Options, then identifiers.
    rest = span
    while (match(rest, /--[a-z][a-z0-9_-]*/)) {
      token = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH)
      if (!(token in known))
        note(shown "no source has the option " token)
    }
    gsub(/--[a-z][a-z0-9_-]*/, " ", span)
    rest = span
    while (match(rest, /[A-Za-z0-9_]+/)) {
      token = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH)
      if (length(token) > 1 && token !~ /^[0-9]/ && !(token in known) && !(rest ~ /^(\.\.\.|\342\200\246)/ && begins(token)))
        note(shown "no source has the name " token)
    }
  }
  function link(target,   page, heading, folder) {
    if (target ~ /^(https?|mailto):/)
      return
    page = target
    heading = ""
    if (index(page, "#")) {
      heading = substr(page, index(page, "#") + 1)
      page = substr(page, 1, index(page, "#") - 1)
    }
    folder = FILENAME
    sub(/[^\/]*$/, "", folder)
    page = page == "" ? FILENAME : folder page
    if (system("test -e \"" page "\"") != 0)
      note("(" target "): no such file")
    else if (heading != "" && !has_heading(page, heading))
      note("(" target "): no such heading")
  }
  function has_heading(page, heading,   line, found) {
    while ((getline line < page) > 0)
      if (line ~ /^#+ /) {
        sub(/^#+ /, "", line)
        line = tolower(line)
        gsub(/[^a-z0-9 _-]/, "", line)
        gsub(/ /, "-", line)
        if (line == heading)
          found = 1
      }
    close(page)
    return found
  }
  BEGIN {
    while ((getline line < (work "/names")) > 0) known[line] = 1
    while ((getline line < (work "/options")) > 0) known[line] = 1
    while ((getline line < (work "/words")) > 0) known[line] = 1
    while ((getline line < (work "/paths")) > 0) {
      for (folder = line; folder != ""; folder = folder ~ /\// ? substr(folder, 1, match(folder, /\/[^\/]*$/) - 1) : "")
        for (end = folder; end != ""; end = index(end, "/") ? substr(end, index(end, "/") + 1) : "")
          ends[end] = 1
    }
  }
  FNR == 1 { fenced = 0; open = "" }
  /^```/ { fenced = !fenced; next }
  fenced || /^    / || /^<!-- / { next }
  {
    line = open == "" ? $0 : open " " $0 # a span may go on in the next line of its paragraph
    open = ""
    if ($0 == "")
      next
    while (match(line, /`[^`]+`/)) {
      span = substr(line, RSTART + 1, RLENGTH - 2)
      line = substr(line, 1, RSTART - 1) " " substr(line, RSTART + RLENGTH)
      check(span)
    }
    if (index(line, "`")) {
      open = substr(line, index(line, "`"))
      line = substr(line, 1, index(line, "`") - 1)
    }
    while (match(line, /\]\([^) ]+\)/)) {
      span = substr(line, RSTART + 2, RLENGTH - 3)
      line = substr(line, RSTART + RLENGTH)
      link(span)
    }
  }
  END { exit failed }' <"$work/pages" || {
  echo "tests/doc_names.sh: correct these pages, or explain the word in tests/doc_words.txt" >&2
  exit 1
}
# The index.
while read -r page; do
  name=${page#docs/}
  if [[ $page == docs/*/*.md ]] && ! grep -qF "]($name)" docs/README.md; then
    echo "docs/README.md: has no link to $name"
    missing=yes
  fi
done <"$work/pages"
[[ -z ${missing:-} ]] || exit 1
echo "doc_names: $(wc -l <"$work/pages") pages"
