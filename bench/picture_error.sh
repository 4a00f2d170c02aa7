# The error and the cost of a picture, for the scripts beside this one, which source it from the repository's root after
# ./examples/run.sh. PHOTONGRID names another program than build/photongrid. Needs /usr/bin/time (Debian: time).
# shellcheck shell=bash
program=${PHOTONGRID:-build/photongrid}
source bench/programs.sh
[[ -x $program ]] || { echo "$0: $program is not there; run ./examples/run.sh first" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=128x96

# reference SCENE [OPTION...]: draws what pictures are compared with
reference() {
  local scene=$1
  shift
  "$program" reference "examples/scenes/$scene.json" --size $size "$@" -o "$work/reference.exr" --quiet >/dev/null
}
# cpu_seconds SCENE SPP OPTIONS: draws the picture at Table 1's k and shadow rays on the serial backend and prints its CPU seconds
cpu_seconds() {
  local plain=$plain_estimate
  [[ $3 == *--as-paper* ]] && plain=""
  [[ $3 == *--leaks* ]] && plain=${plain/--leaks side/}
  [[ $3 == *--edge-correction* ]] && plain=${plain/--edge-correction none/}
  # shellcheck disable=SC2086
  /usr/bin/time -f %U -o "$work/time" "$program" render "examples/scenes/$1.json" --backend serial --size $size $(paper_counts "$1") --spp "$2" $plain $3 -o "$work/picture.exr" --quiet >/dev/null
  cat "$work/time"
}
# median_of_three: of the numbers on standard input, one a line
median_of_three() { sort -n | sed -n 2p; }
# median_cpu_seconds SCENE SPP OPTIONS
median_cpu_seconds() {
  for _ in 1 2 3; do cpu_seconds "$@"; done | median_of_three
}
# relmse: of the picture drawn last
relmse() {
  "$program" compare "$work/picture.exr" "$work/reference.exr" | awk '$1 == "relMSE" { print $2 }'
}
