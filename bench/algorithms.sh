#!/usr/bin/env bash
# Every algorithm on every backend by number of photons and by entropy of their cells (bench/algorithms.cpp): JSON and plots in
# out/algorithms/, Markdown here.
#
#   bench/algorithms.sh [GOOGLE BENCHMARK'S OPTION...]
#
# bench/run.sh --algorithms installs what is missing, builds and calls this.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need bench/algorithms
out=out/algorithms
mkdir -p $out
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$build/bench/algorithms" --benchmark_out=$out/algorithms.json --benchmark_out_format=json "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }
# algorithm, backend, photons, bits of entropy, million items per second
jq -r '.benchmarks[] | select(.error_occurred | not)
  | [(.name | split("/")[0, 1]), (.name | capture("photons:(?<n>[0-9]+)").n), (.key_entropy_bits * 10 | round / 10), (.items_per_second / 1e6)] | @tsv' $out/algorithms.json >"$work/rows"
jq -r '.benchmarks[] | select(.error_occurred) | "\(.name): \(.error_message)"' $out/algorithms.json >"$work/errors"
[[ -s $work/rows ]] || { cat "$work/log" >&2; exit 2; }

# table COLUMN KEPT_COLUMN KEPT_VALUE HEADING: a row for an algorithm and a backend, a column for each value of COLUMN
table() {
  awk -F'\t' -v column="$1" -v kept="$2" -v value="$3" -v heading="$4" '
    $kept == value || (kept == 4 && $1 == "prefix_sums") {
      row = "| `" $1 "` | " $2 " |"
      if (!(row in rows)) { rows[row] = ++count; names[count] = row }
      if (!($column in columns)) { columns[$column] = ++width; titles[width] = $column }
      cells[row, $column] = sprintf(" %.3g |", $5)
    }
    END {
      printf "| algorithm | backend |"; for (c = 1; c <= width; ++c) printf " %s |", titles[c] heading
      printf "\n|---|---|"; for (c = 1; c <= width; ++c) printf "---|"
      printf "\n"
      for (r = 1; r <= count; ++r) {
        printf "%s", names[r]
        for (c = 1; c <= width; ++c) printf "%s", ((names[r], titles[c]) in cells) ? cells[names[r], titles[c]] : " |"
        printf "\n"
      }
    }' "$work/rows"
}
echo "Million photons per second (searches: points), by number of photons; keys of 15 bits of entropy:"
echo
table 3 4 15 ""
largest=$(cut -f 3 "$work/rows" | sort -n | uniq | awk '$1 <= 1048576' | tail -n 1)
echo
echo "By entropy of the keys, $largest photons:"
echo
table 4 3 "$largest" " bits"
if [[ -s $work/errors ]]; then
  echo
  cat "$work/errors"
fi

while read -r algorithm; do
  for kind in svg png; do
    {
      echo "set terminal $([[ $kind == svg ]] && echo 'svg size 720,480 font "sans,13" background "white"' || echo 'pngcairo size 1080,720 font "sans,18"')"
      echo "set output '$out/$algorithm.$kind'"
      echo 'set logscale xy; set format x "2^{%L}"; set logscale x 2; set xlabel "photons"; set ylabel "million a second"; set key outside right top; set grid'
      echo "set title '$algorithm' noenhanced"
      printf 'plot '
      separator=
      while read -r backend; do
        printf "%s\"< awk '\$1 == \\\\\"%s\\\\\" && \$2 == \\\\\"%s\\\\\" && \$4 == 15' %s\" using 3:5 with linespoints title '%s'" "$separator" "$algorithm" "$backend" "$work/rows" "$backend"
        separator=', '
      done < <(cut -f 2 "$work/rows" | sort -u)
      echo
    } | gnuplot 2>"$work/log" || { cat "$work/log" >&2; exit 2; }
  done
done < <(cut -f 1 "$work/rows" | sort -u)
echo
echo "All of it: $out/algorithms.json; plots: $out/*.svg, $out/*.png"
