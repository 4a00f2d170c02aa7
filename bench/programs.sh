# Sourced by scripts of this folder: where the programs are that bench/run.sh builds, and what to say when they are not there;
# and the paper's settings of a scene as options.
# shellcheck shell=bash

# PHOTONGRID_BUILD: a build folder with -DPHOTONGRID_BENCH=ON
build=${PHOTONGRID_BUILD:-build-bench}

# need PROGRAM...: each in the build folder, or the script ends
need() {
  local name
  for name; do
    [[ -x $build/$name ]] || { echo "$0: $build/$name is not there; bench/run.sh builds it (PHOTONGRID_BUILD names another folder)" >&2; exit 2; }
  done
}
# paper_count SCENE KEY: the number at KEY in the scene's "as_paper", Table 1
paper_count() { sed -n "s/^ *\"as_paper\":.*\"$2\": *\([0-9]*\).*/\1/p" "examples/scenes/$1.json"; }
# one_map: options for one pass with all photons in one map, where a scene has more
one_map="--passes 1 --caustic-photons 0"
# paper_counts SCENE: options for one pass with Table 1's photons, all in one map, k and shadow rays; the scene's own
# differ (bench/defaults.sh compares them)
paper_counts() {
  local photons k samples
  photons=$(paper_count "$1" photons) k=$(paper_count "$1" k) samples=$(paper_count "$1" light_samples)
  echo "$one_map --photons $photons --k $k${samples:+ --light-samples $samples}"
}
# plain_estimate: options for the library's default estimate, where a scene has another
plain_estimate="--leaks side --edge-correction none"
# median: of numbers, one a line
median() { sort -n | awk '{ v[NR] = $1 } END { printf "%.3f", v[int((NR + 1) / 2)] }'; }
# seconds_of STATS: of a whole picture, without compiling kernels, from its statistics
seconds_of() {
  awk '$1 == "\"total_ms\":" { total = $2 + 0 }
    /^  "compile_ms":/ { compile = $2 + 0 }
    END { printf "%.4f\n", (total - compile) / 1000 }' "$1"
}
# need_povray: the same for POV-Ray
need_povray() {
  command -v povray >/dev/null || { echo "$0: no povray; apt-get install povray" >&2; exit 2; }
}
