#!/usr/bin/env bash
# Draws all scenes of this folder as they are, without settings, and prints a table of the pictures.
#
#     tests/first_scenes/draw.sh PROGRAM OUT_FOLDER [NAME...]      e.g. draw.sh build/photongrid /tmp/first
#
# What the program said about NAME is in OUT_FOLDER/NAME.txt. "black" is the share of pixels below 5 of 255 in all
# channels, "white" that of pixels above 250 in all; "mean" is the mean of all channels, from 0 to 255.
set -u
program=$(realpath "$1")
out=$(mkdir -p "$2" && realpath "$2")
shift 2
cd "$(dirname "$0")" || exit 2

statistics() {
    python3 - "$1" <<'END'
import struct
import sys
import zlib

content, place, data = open(sys.argv[1], 'rb').read(), 8, b''
while place < len(content):
    size, kind = struct.unpack('>I4s', content[place:place + 8])
    chunk = content[place + 8:place + 8 + size]
    if kind == b'IHDR':
        width, height, _, colour = struct.unpack('>IIBB', chunk[:10])
    if kind == b'IDAT':
        data += chunk
    place += 12 + size
data, n = zlib.decompress(data), {0: 1, 2: 3, 4: 2, 6: 4}[colour]
before, rows = bytearray(width * n), []
for y in range(height):
    filtered, *row = data[y * (width * n + 1):(y + 1) * (width * n + 1)]
    for i in range(width * n):
        a, b, c = row[i - n] if i >= n else 0, before[i], before[i - n] if i >= n else 0
        nearest = min((a, b, c), key=lambda v: abs(a + b - c - v))
        row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[filtered]) % 256
    rows.append(row)
    before = row
pixels = [row[i:i + n] for row in rows for i in range(0, width * n, n)]
print('%6.1f %6.3f %6.3f' % (sum(map(sum, pixels)) / len(pixels) / n, sum(max(p) < 5 for p in pixels) / len(pixels),
                             sum(min(p) > 250 for p in pixels) / len(pixels)))
END
}

printf '%-28s %7s %7s %4s %6s %6s %6s\n' file seconds 'CPU s' exit mean black white
TIMEFORMAT='%R %U'
[ $# -gt 0 ] || set -- *.obj *.ply *.gltf *.glb *.pbrt *.xml *.json no_faces/*
for file in "$@"; do
    name=$(basename "$file")
    picture=$out/${name%.*}.png
    rm -f "$picture"
    { time "$program" render "$file" --size 256x256 -o "$picture" >"$out/$name.txt" 2>&1; } 2>"$out/$name.time"
    code=$?
    read -r seconds cpu <"$out/$name.time"
    rm -f "$out/$name.time"
    printf '%-28s %7s %7s %4s %s\n' "$name" "$seconds" "$cpu" $code "$([ -f "$picture" ] && statistics "$picture")"
done
