#!/usr/bin/env bash
# Does the window answer while passes run? The Cornell box at 512 x 512 on a display of its own (Xvfb, OpenGL in software), its camera
# turned by the mouse for some three seconds. Prints Markdown: how often the window looked at events, how often that took longer
# than a thirtieth of a second, and the requests and pictures meanwhile. One look in a hundred may take longer, since
# other processes run too: exits 1 where more do. Needs Debian's xvfb and xdotool.
#
#   bench/window.sh [BACKEND...]      default: cpu vulkan
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || { echo "$0: no $tool; apt-get install xvfb xdotool" >&2; exit 2; }
done
backends=("$@")
((${#backends[@]})) || backends=(cpu vulkan)
work=$(mktemp -d)
server=
trap '[[ -z $server ]] || kill $server; rm -rf "$work"' EXIT
mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 1280x900x24 -nolisten tcp -noreset 3>"$work/number" >"$work/log" 2>&1 &
server=$!
read -r number <"$work/number"
export DISPLAY=:$number

failed=0
echo "| backend | looked at events | longer than 33 ms | wanted at most | longest, ms | requests begun | pictures | |"
echo "|---|---|---|---|---|---|---|---|"
for backend in "${backends[@]}"; do
  "$build/photongrid" view examples/scenes/cornell_box.json --size 512x512 --backend "$backend" --shader-cache "$work/cache" --quiet --journal "$work/journal" >"$work/log" 2>&1 &
  window=$!
  for ((i = 0; i < 600; ++i)); do
    ! grep -q '"whole"' "$work/journal" 2>/dev/null || break
    sleep 0.1
  done
  xdotool mousemove 30 400 mousedown 1
  for ((x = 31; x <= 180; ++x)); do
    xdotool mousemove $x 400
    sleep 0.015
  done
  xdotool mouseup 1
  sleep 1
  kill -INT $window
  wait $window
  awk -v backend="$backend" '
    /"start"/ { ++starts }
    /"picture"/ { ++pictures }
    /"closed"/ { gsub(/[{}",:]/, " "); for (i = 1; i < NF; ++i) said[$i] = $(i + 1) }
    END {
      most = int(said["turns"] / 100)
      slow = said["turns_above_33_ms"] > most
      printf "| %s | %d | %d | %d | %.0f | %d | %d | %s |\n", backend, said["turns"], said["turns_above_33_ms"], most, said["slowest_turn_ms"], starts, pictures, (slow ? "FAIL" : "PASS")
      exit slow
    }' "$work/journal" || failed=1
  rm -f "$work/journal"
done
exit $failed
