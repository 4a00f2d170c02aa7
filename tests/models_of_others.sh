#!/usr/bin/env bash
# Reads every scene below a folder with `photongrid check`: it must be loaded, or refused with its name.
#
#   tests/models_of_others.sh FOLDER [PHOTONGRID]      default: build/photongrid
#
# Prints a line for each .obj, .ply, .gltf and .glb file: what became of it, and the refusal. A file is broken if the
# program crashes, needs more than 5 s or 1 GiB of address space, or refuses it without its name. Exits 1 if one is.
# Debian's assimp-testmodels has such a folder, /usr/share/assimp/models.
set -euo pipefail
folder=${1:-} program=${2:-build/photongrid}
if [[ ! -d $folder ]]; then
  echo "models_of_others.sh: SKIPPED: \"$folder\" is no folder of models" >&2
  exit 0
fi
if [[ ! -x $program ]]; then
  echo "models_of_others.sh: there is no program $program; build it, or name another" >&2
  exit 2
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
loaded=0 refused=0 broken=0
bad_input=3 # the program's exit status for scene files
while IFS= read -r -d '' file; do
  status=0
  (
    ulimit -v $((1 << 20)) # KiB
    exec timeout 5 "$program" check "$file"
  ) >"$work/out" 2>"$work/err" || status=$?
  said=$(head -n 1 "$work/err")
  if [[ $status == 0 ]]; then
    loaded=$((loaded + 1))
    echo "loaded   $file"
  elif [[ $status == "$bad_input" && $said == "$file"* ]]; then
    refused=$((refused + 1))
    echo "refused  $said"
  else
    broken=$((broken + 1))
    echo "BROKEN   $file: exit status $status: $said"
  fi
done < <(find "$folder" -type f \( -iname '*.obj' -o -iname '*.ply' -o -iname '*.gltf' -o -iname '*.glb' \) -print0 |
  sort -z)
echo "$loaded loaded, $refused refused, $broken broken"
[[ $broken == 0 ]]
