#!/usr/bin/env python3
"""What automatic settings lose: their error after some seconds over that of the best settings found by a random search.
Prints Markdown.

  bench/best_settings.py [--size N] [--seconds S] [--tries N] [--repeats N] [--spp N] [--own] [--half chosen|held]
                         [SCENE...]

SCENE is a scene file of any format, or a scene of bench/made_scenes.py. --half: the scenes that the rules were chosen
on, or those that were looked at once they stood. Both references of a scene, with different seeds, and their error stay
in out/best_settings/; relMSE is the mean of (x - a)(x - b) / (d + 0.01 mean)^2, where d is the mean of both, smoothed
over 3 x 3 pixels: their noise drops out. The worst 0.1 % of the pixels are left out. PHOTONGRID names the program.
"""
import argparse
import math
import os
import random
import statistics
import subprocess
import sys

from error_curves import read_picture
from made_scenes import SCENES as MADE, write_scene
from time_to_error_settings import AUTOMATIC_OPTIONS

CHOSEN = ("examples/scenes/cornell_blocks.json", "examples/scenes/cornell_box.json", "examples/scenes/ring.json",
          "examples/scenes/glass_ball.json", "bench/scenes/door.json", "bench/scenes/house.json", "satin_ring",
          "examples/scenes/table.gltf", "examples/scenes/still_life.pbrt", "tests/first_scenes/chair_room.gltf",
          "tests/first_scenes/bunny_sun.gltf", "tests/first_scenes/window_pane.pbrt")
HELD = ("coffee_maker", "glass_of_water", "examples/scenes/room.gltf", "examples/scenes/pool.json",
        "examples/scenes/terrace.json", "tests/first_scenes/kitchen_point.glb", "tests/first_scenes/room_lamp.obj",
        "tests/first_scenes/tumbler.glb", "tests/first_scenes/stage_spot.gltf", "tests/first_scenes/ring_gold.glb",
        "tests/first_scenes/forest.gltf")
OUT = "out/best_settings"
PROGRAM = os.environ.get("PHOTONGRID", "build/photongrid")


def drawn(command, path, size, picture, *options):
    subprocess.run([PROGRAM, command, path, "--size", f"{size}x{size}", "--quiet", "-o", picture, *map(str, options)],
                   check=True, stdout=subprocess.DEVNULL)
    return read_picture(picture)[1]


class Reference:
    def __init__(self, name, path, size, spp):
        self.both = []
        for seed in (1, 2):
            kept = f"{OUT}/{name}-{size}-{spp}-{seed}.pfm"
            if not os.path.exists(kept):
                drawn("reference", path, size, kept + ".part.pfm", "--spp", spp, "--paths", 20000 * spp, "--caustics",
                      "bins", "--seed", seed)
                os.replace(kept + ".part.pfm", kept)
            self.both.append(read_picture(kept)[1])
        a, b = self.both
        mean = [(x + y) / 2 for x, y in zip(a, b)]
        floor = 0.01 * statistics.fmean(mean)

        def smooth(i):
            y, x = divmod(i // 3, size)
            near = [mean[3 * (v * size + u) + i % 3] for v in range(max(y - 1, 0), min(y + 2, size))
                    for u in range(max(x - 1, 0), min(x + 2, size))]
            return (sum(near) / len(near) + floor)**2

        self.weights = [smooth(i) for i in range(len(mean))]

    def error(self, picture):
        of = [(x - a) * (x - b) / w for x, a, b, w in zip(picture, *self.both, self.weights)]
        pixels = sorted((sum(of[i:i + 3]) / 3 for i in range(0, len(of), 3)), key=abs)
        kept = pixels[:len(pixels) - max(len(pixels) // 1000, 1)]
        return max(sum(kept) / len(kept), 1e-9)


def with_automatic(settings):
    return settings + [word for name in AUTOMATIC_OPTIONS if name not in settings for word in (name, "auto")]


def drawn_at_random(chance):
    def spread(low, high):
        return round(math.exp(chance.uniform(math.log(low), math.log(high))))
    options = ["--photons", spread(1000, 500000), "--k", spread(20, 1000), "--spp", chance.choice([1, 1, 2, 4]),
               "--light-samples", chance.choice([1, 2, 4, 8]),
               "--caustic-photons", chance.choice([0, spread(1000, 300000), spread(1000, 300000)]),
               "--caustic-k", spread(15, 200)]
    way = chance.choice(["map", "map", "map", "gather", "paths"])
    return options + ["--indirect", way] + (["--gather-rays", chance.choice([1, 2, 4])] if way != "map" else [])


def measure(scene, options):
    name = os.path.basename(scene).replace(".", "-")
    path = write_scene(scene, OUT) if scene in MADE else scene
    reference = Reference(name, path, options.size, options.spp)
    picture = f"{OUT}/{name}.pfm"

    def error(settings, seed):
        return reference.error(drawn("render", path, options.size, picture, "--backend", "cpu", "--seconds",
                                     options.seconds, "--seed", seed, *settings))

    own = [] if options.own else with_automatic([])
    default = statistics.fmean(error(own, seed) for seed in range(1, options.repeats + 1))
    chance, tried = random.Random(name), []
    for _ in range(options.tries):
        settings = drawn_at_random(chance)
        tried.append((error(with_automatic(settings), 1), settings))
        print(f"{name}: {tried[-1][0]:.4g} {' '.join(map(str, settings))}", file=sys.stderr, flush=True)
    tried.sort()
    if not tried:
        print(f"| {name} | {default:.4g} | | | |", flush=True)
        return
    # The best of many is lucky: other seeds tell.
    again = [(statistics.fmean(error(with_automatic(settings), seed) for seed in range(2, options.repeats + 2)),
              settings) for _, settings in tried[:5]]
    best, settings = min(again)
    # How far the error falls in time is left out: a ratio of errors is one of times, or more.
    print(f"| {name} | {default:.4g} | {best:.4g} | {default / best:.2f} | `{' '.join(map(str, settings))}` |",
          flush=True)


parser = argparse.ArgumentParser()
parser.add_argument("scenes", nargs="*")
parser.add_argument("--size", type=int, default=128)
parser.add_argument("--seconds", type=float, default=4)
parser.add_argument("--tries", type=int, default=100)
parser.add_argument("--repeats", type=int, default=3)
parser.add_argument("--spp", type=int, default=1024)
parser.add_argument("--own", action="store_true", help="compare the scene's own numbers, not automatic ones")
parser.add_argument("--half", choices=("chosen", "held"), default="chosen")
given = parser.parse_args()
os.makedirs(OUT, exist_ok=True)
print("| scene | relMSE | best found | ratio | settings |")
print("|---|---|---|---|---|")
for scene_name in given.scenes or (CHOSEN if given.half == "chosen" else HELD):
    measure(scene_name, given)
