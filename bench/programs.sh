# Sourced by scripts of this folder: where the programs are that bench/run.sh builds, and what to say when they are not there.

# PHOTONGRID_BUILD: a build folder with -DPHOTONGRID_BENCH=ON
build=${PHOTONGRID_BUILD:-build-bench}

# need PROGRAM...: each in the build folder, or the script ends
need() {
  local name
  for name; do
    [[ -x $build/$name ]] || { echo "$0: $build/$name is not there; bench/run.sh builds it (PHOTONGRID_BUILD names another folder)" >&2; exit 2; }
  done
}
# need_povray: the same for POV-Ray
need_povray() {
  command -v povray >/dev/null || { echo "$0: no povray; apt-get install povray" >&2; exit 2; }
}
