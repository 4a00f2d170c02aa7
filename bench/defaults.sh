#!/usr/bin/env bash
# What a picture by default costs and how it looks, beside the paper's method and the reference renderer. Writes
# docs/defaults/SCENE-{paper,default,reference}.png and prints a Markdown table: the structural similarity (SSIM) to the
# reference, of the default's first pass, too; and seconds without compiling kernels, medians of runs in turn. Exits 1 where
# the first pass takes over 1.5 times the paper's time, or the whole picture over 5 s.
#
#   bench/defaults.sh [BACKEND [REPETITIONS]]      default: cpu 5
#   bench/defaults.sh --quick                      tiny pictures, once, and no files, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid
backend=${1:-cpu} repetitions=${2:-5} size=() small=(256x192 256x192 256x256 256x256) paths=60000000 spp=1024 pictures=docs/defaults
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ $backend == --quick ]]; then
  backend=cpu repetitions=1 size=(--size 64x48) small=(64x48 64x48 48x48 48x48) paths=100000 spp=4 pictures=$work
fi
mkdir -p "$pictures"
scenes=(ring glass_ball cornell_box cornell_blocks)
# drawn SCENE OPTION...: draws $work/picture.exr and prints the seconds that took
drawn() {
  "$build/photongrid" render "examples/scenes/$1.json" --backend "$backend" --shader-cache "$work/cache" --stats "$work/stats.json" --quiet "${@:2}" -o "$work/picture.exr" >/dev/null
  seconds_of "$work/stats.json"
}
# similarity: of $work/picture.exr to the scene's reference
similarity() { "$build/photongrid" compare "$work/picture.exr" "$work/reference.exr" | sed -n 's/^SSIM *\([0-9.]*\).*/\1/p'; }
declare -A option=([paper]=--as-paper [pass]=--passes=1 [default]="")
failed=0
echo "| scene | the paper's method | default | reference | SSIM of its first pass | seconds, paper | first pass | ratio | wanted | default | wanted | |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
for i in "${!scenes[@]}"; do
  scene=${scenes[i]} exposure=$(sed -n 's/^ *"exposure": *\([-0-9.]*\).*/\1/p' "examples/scenes/${scenes[i]}.json")
  "$build/photongrid" reference "examples/scenes/$scene.json" --caustics bins --size "${small[i]}" --spp $spp --paths $paths --exposure "${exposure:-0}" --quiet \
    -o "$work/reference.exr" -o "$pictures/$scene-reference.png" >/dev/null
  cells=""
  for way in paper default; do
    drawn "$scene" ${option[$way]:+"${option[$way]}"} --size "${small[i]}" -o "$pictures/$scene-$way.png" >/dev/null
    cells+=" ![$scene, $way](../defaults/$scene-$way.png) SSIM $(similarity) |"
  done
  drawn "$scene" "${option[pass]}" --size "${small[i]}" >/dev/null
  of_pass=$(similarity)
  for way in paper pass default; do : >"$work/$way"; done
  for ((r = 0; r < repetitions; ++r)); do
    for way in paper pass default; do
      drawn "$scene" ${option[$way]:+"${option[$way]}"} "${size[@]}" >>"$work/$way"
    done
  done
  paper=$(median <"$work/paper") pass=$(median <"$work/pass") whole=$(median <"$work/default")
  verdict=$(awk -v o="$pass" -v p="$paper" -v w="$whole" 'BEGIN {
    printf "%.2f | 1.50 | %s | 5 | %s", o / p, w, (o <= 1.5 * p && w <= 5 ? "PASS" : "FAIL")
  }')
  [[ $verdict == *PASS ]] || failed=1
  echo "| $scene |$cells ![$scene, reference](../defaults/$scene-reference.png) | $of_pass | $paper | $pass | $verdict |"
done
exit $failed
