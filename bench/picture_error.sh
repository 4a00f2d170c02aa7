# The error and the cost of a picture, for the scripts beside this one, which source it from the repository's root after
# ./examples/run.sh, with their arguments: --quick draws tiny pictures, once. PHOTONGRID names another program than
# build/photongrid.
# shellcheck shell=bash
program=${PHOTONGRID:-build/photongrid}
source bench/programs.sh
[[ -x $program ]] || { echo "$0: $program is not there; run ./examples/run.sh first" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=128x96 quick=no few=()
if [[ ${1:-} == --quick ]]; then
  size=32x24 quick=yes few=(--spp 4 --paths 20000)
fi

# reference SCENE [OPTION...]: draws what pictures are compared with
reference() {
  local scene=$1
  shift
  [[ $quick == no ]] || set -- "${few[@]}"
  "$program" reference "examples/scenes/$scene.json" --size $size "$@" -o "$work/reference.exr" --quiet >/dev/null
}
# cpu_seconds SCENE SPP OPTIONS: draws the picture at Table 1's k and shadow rays on the serial backend and prints its CPU seconds
cpu_seconds() {
  local plain=$plain_estimate
  [[ $3 == *--as-paper* ]] && plain=""
  [[ $3 == *--leaks* ]] && plain=${plain/--leaks side/}
  [[ $3 == *--edge-correction* ]] && plain=${plain/--edge-correction none/}
  local TIMEFORMAT=%2U
  # shellcheck disable=SC2086
  { time "$program" render "examples/scenes/$1.json" --backend serial --size $size $(paper_counts "$1") --spp "$2" $plain $3 -o "$work/picture.exr" --quiet >/dev/null 2>&3; } 3>&2 2>"$work/time"
  cat "$work/time"
}
# times_measured: how often a picture is drawn for its seconds
times_measured() { [[ $quick == yes ]] && echo 1 || echo 1 2 3; }
# median: of the numbers on standard input, one a line; an odd number of them
median() { sort -n | awk '{ v[NR] = $1 } END { print v[(NR + 1) / 2] }'; }
# median_cpu_seconds SCENE SPP OPTIONS
median_cpu_seconds() {
  for _ in $(times_measured); do cpu_seconds "$@"; done | median
}
# relmse: of the picture drawn last
relmse() {
  "$program" compare "$work/picture.exr" "$work/reference.exr" | awk '$1 == "relMSE" { print $2 }'
}
