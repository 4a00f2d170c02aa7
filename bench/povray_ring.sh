#!/usr/bin/env bash
# The ring scene's caustic by POV-Ray's photons and by ours: how far the brightest parts overlap. Needs
# povray (Debian package povray) and what bench/run.sh builds.
#
#   bench/povray_ring.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid bench/povray_ring
need_povray
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scene=examples/scenes/ring.json
for photons in on off; do
  "$build/bench/povray_ring" export "$scene" "$([[ $photons == on ]] && echo 2000000 || echo 0)" >"$work/$photons.pov"
  povray "+I$work/$photons.pov" "+O$work/$photons.exr" +FE +W512 +H384 -D +A0.1 -GA >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
done
# shellcheck disable=SC2086
"$build/photongrid" render "$scene" --backend serial $one_map --photons 500000 --k 100 --spp 4 --quiet -o "$work/ours.exr" >/dev/null
if [[ -n ${KEEP:-} ]]; then
  cp "$work"/*.exr "$work"/*.pov "$KEEP"
fi
"$build/bench/povray_ring" compare "$scene" "$work/ours.exr" "$work/on.exr" "$work/off.exr"
