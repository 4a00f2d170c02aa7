#!/usr/bin/env bash
# Searches among photons in clusters against CGAL, FLANN and nanoflann (bench/clustered_peers.cpp): Markdown here; in
# out/clustered_peers/ the figures as TSV, and for each k a plot (SVG and PNG) of how many times as fast as the fastest
# peer each kind of map is.
#
#   bench/clustered_peers.sh [CLUSTERED_PEERS' OPTION...]
#
# bench/run.sh --peers installs what is missing, builds and calls this. Exits 1 where a map is slower than wanted.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need bench/clustered_peers
out=out/clustered_peers
mkdir -p $out
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

status=0
"$build/bench/clustered_peers" "$@" --data $out/clustered_peers.tsv || status=$?
if ((status > 1)); then
  exit $status
fi

# plot K: a group of boxes for each set, a box for each kind of map, from 1 (as fast as the fastest peer) up or down
plot() {
  local k=$1 kind map maps=() colours=("#888888" "#2a7fff" "#d08020" "#309030") separator i
  # set's number, set, map, ratio
  awk -F'\t' -v OFS='\t' -v k="$k" 'NR > 1 && $2 == k { if (!($1 in number)) number[$1] = count++; print number[$1], $1, $3, $6 }' $out/clustered_peers.tsv >"$work/rows"
  [[ -s $work/rows ]] || return 0
  mapfile -t maps < <(awk -F'\t' '!seen[$3]++ { print $3 }' "$work/rows")
  for map in "${maps[@]}"; do
    awk -F'\t' -v OFS='\t' -v map="$map" '$3 == map' "$work/rows" >"$work/$map"
  done
  for kind in svg png; do
    {
      echo "set terminal $([[ $kind == svg ]] && echo 'svg size 800,440 font "sans,13" background "white"' || echo 'pngcairo size 1600,880 font "sans,24"')"
      echo "set output '$out/speed_k$k.$kind'"
      echo "set title 'exact $k nearest photons: times the speed of the fastest peer'"
      echo "set logscale y; set format y '%g'; set grid ytics; set key outside top center horizontal samplen 2; set bmargin 5; set rmargin 3"
      echo "set xrange [-0.6:$(awk 'END { print $1 + 0.6 }' "$work/rows")]; set xtics scale 0 rotate by 35 right noenhanced ($(awk -F'\t' '!seen[$2]++ { printf "%s\"%s\" %d", separator, $2, $1; separator = ", " }' "$work/rows"))"
      echo "set style fill solid; set ylabel 'times as fast'"
      printf 'plot '
      separator=
      for i in "${!maps[@]}"; do
        # x, y, and the box: x from, x to, y from, y to
        printf "%s'%s' using (\$1 + (%d - %d / 2.0 + 0.5) * 0.8 / %d):4:(\$1 + (%d - %d / 2.0) * 0.8 / %d):(\$1 + (%d + 1 - %d / 2.0) * 0.8 / %d):(\$4 < 1 ? \$4 : 1):(\$4 < 1 ? 1 : \$4) with boxxyerror lc rgb '%s' title '%s' noenhanced" \
          "$separator" "$work/${maps[i]}" "$i" ${#maps[@]} ${#maps[@]} "$i" ${#maps[@]} ${#maps[@]} "$i" ${#maps[@]} ${#maps[@]} "${colours[i % 4]}" "${maps[i]}"
        separator=', '
      done
      echo ", 1 with lines lc rgb '#000000' lw 1.5 notitle"
    } | gnuplot 2>"$work/log" || { cat "$work/log" >&2; exit 2; }
  done
}
while read -r k; do
  plot "$k"
done < <(awk -F'\t' 'NR > 1 { print $2 }' $out/clustered_peers.tsv | sort -nu)
echo
echo "All of it: $out/clustered_peers.tsv; plots: $out/speed_k*.svg, $out/speed_k*.png"
exit $status
