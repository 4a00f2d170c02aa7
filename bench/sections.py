#!/usr/bin/env python3
"""Sections of bench/run.sh that run programs; prints Markdown. bench/run.sh installs what is missing, builds, calls it.

  bench/sections.py SECTION [--quick] [ARGUMENT...]      --quick: little of it, to see that it runs

  algorithms [OPTION...]   every algorithm on every backend, by number of photons and by entropy of their cells; takes
                           Google Benchmark's options; JSON and plots in out/algorithms/
  clusters [OPTION...]     searches among photons in clusters against CGAL, FLANN and nanoflann; takes the options of
                           `photongrid_bench_native clusters`; TSV and plots in out/clusters/
  convergence [BACKEND...] time to visual convergence (3.1, figure 8): when the running picture first stays within 1e-3
                           of the final one in relMSE, when it looks like it (a structural similarity of 0.98), and when
                           the final one is there; from the first photon on, without compiling kernels. The paper's
                           glass ball looked converged after 4 s of 14.9 s of its radiance estimate. Default: cpu vulkan
  defaults                 what a picture by default costs and how it looks, beside the paper's method and the reference
                           renderer; writes docs/defaults/. Too slow: a first pass of over 1.5 times the paper's time,
                           or a picture of over 5 s
  edges                    what edge correction does to the error of a picture, and what it costs on serial
  error [BACKEND...]       time against error of every way to estimate, on scenes and on fields of light with a known
                           answer: CSV and plots in out/error/. The last column says whether a row is on its scene's
                           Pareto front. Default: serial gl vulkan, beside cpu
  estimates                error and cost on serial of searches, filters and leak policies, at Table 1's photons and k
  figure7                  the paper's figure 7: sorting, routing and the reference renderer; writes docs/figure7/
  gather                   ways to compute indirect light and caustics: relMSE of pixels and of means over 4 x 4, in
                           which noise counts less and blur the same; bias, seconds on cpu, photon paths
  inclusion                what including the headers costs g++ -O2, and the stripped size of the smallest programs,
                           from an installed tree. Too slow: 1.5 s for the core's headers
  lamps                    direct light of one lamp and of a hundred of the same power in all. Too slow: 3 times as long
  panes [BACKEND...]       nine surfaces under a pane of glass by five lights, over what they get without it, times what
                           the pane lets through (Fresnel); also of the reference renderer. FAIL: off by over 3 %.
                           Default: cpu serial gl vulkan
  pictures                 whole pictures with Table 1's counts, against POV-Ray's where there are any: same size, as
                           many photons sent at what makes the caustic as we store, two threads, no antialiasing
  ring                     the ring's caustic by POV-Ray's photons and by ours: how far the brightest parts overlap
  stages BACKEND...        whole pictures by stage
  strips                   brightness along edges of floors, walls, boxes, meshes and a disk: rows of pixels over the
                           reference's. FAIL: the worst row is off by over 1 % and twice the noise
  table1 [BACKEND...]      the paper's Table 1. Default: serial vulkan gl
  water [BACKEND...]       a glass of water with ice as nested bodies, against pbrt-v3's paths through its interfaces:
                           relMSE of 16 x 16 blocks. FAIL: over twice what the noise of both explains. PHOTONGRID_PEERS
                           names the folder with pbrt; without it the other picture is the reference's. Default: cpu
  window [BACKEND...]      does the window answer while passes run? On a display of its own (Xvfb), the camera turned by
                           the mouse for some three seconds. Too slow: over one look at events in a hundred takes longer
                           than a thirtieth of a second. Default: cpu vulkan

PHOTONGRID_BUILD names the build folder, else build-bench. Exit status: 1 where something is too slow, 2 where something
is broken.
"""
import atexit
import csv
import json
import math
import os
import re
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import traceback

from error_curves import block_means, pixel_errors, read_picture
from made_scenes import box as box_mesh, write_scene
from peer_scenes import pbrt_film

os.chdir(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get("PHOTONGRID_BUILD", "build-bench")
PROGRAM = os.environ.get("PHOTONGRID", f"{BUILD}/photongrid")
BENCH = f"{BUILD}/bench/photongrid_bench"
WORK = tempfile.mkdtemp()
atexit.register(shutil.rmtree, WORK, True)
ONE_MAP = ["--passes", "1", "--caustic-photons", "0"]  # all photons in one map, where a scene has more
PLAIN_ESTIMATE = ["--leaks", "side", "--edge-correction", "none"]  # the library's default, where a scene has another
failed = 0


class Broken(Exception):
    pass


def need(tool, package):
    if not shutil.which(tool):
        raise Broken(f"there is no {tool}; apt-get install {package}" if package else
                     f"{tool} is not there; bench/run.sh builds it (PHOTONGRID_BUILD names another folder)")


def said(*command, allowed=(0,), **how):
    """What a program prints."""
    if os.sep in command[0]:
        need(command[0], "")
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, **how)
    if done.returncode not in allowed:
        raise Broken(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def heading(columns):
    row(*columns)
    print("|" + "---|" * len(columns))


def row(*cells):
    print("|" + "".join(f" {cell} |" if cell != "" else " |" for cell in cells), flush=True)


def verdict(good):
    global failed
    failed |= not good
    return "PASS" if good else "FAIL"


def scene_file(scene):
    return scene if scene.endswith(".json") else f"examples/scenes/{scene}.json"


def render(scene, *options, picture="picture.exr"):
    """Draws WORK/picture; returns its statistics."""
    said(PROGRAM, "render", scene_file(scene), *options, "--shader-cache", f"{WORK}/cache", "--stats",
         f"{WORK}/stats.json", "--quiet", "-o", os.path.join(WORK, picture))
    with open(f"{WORK}/stats.json", encoding="utf-8") as f:
        return json.load(f)


def seconds_of(stats):
    """Of a whole picture, without compiling kernels."""
    return (stats["total_ms"] - stats["compile_ms"]) / 1000


def draw_reference(scene, *options, picture="reference.exr"):
    said(PROGRAM, "reference", scene_file(scene), *options, "--quiet", "-o", os.path.join(WORK, picture))


def compared(key="relMSE", picture="picture.exr", reference="reference.exr", *options):
    """A figure of `photongrid compare`, as it prints it."""
    text = said(PROGRAM, "compare", os.path.join(WORK, picture), os.path.join(WORK, reference), *options)
    return re.search(rf"^{key} *(\S+)", text, re.MULTILINE)[1]


def paper_counts(scene, *keys):
    """The scene's counts of Table 1 as options."""
    with open(scene_file(scene), encoding="utf-8") as f:
        paper = json.load(f).get("as_paper", {})
    return [word for key in keys or ("photons", "k", "light_samples") if key in paper
            for word in ("--" + key.replace("_", "-"), paper[key])]


def plot(path, width, height, lines, blocks):
    """Draws PATH.svg and PATH.png with gnuplot from rows by name."""
    data = "".join(f"${name} << END\n" + "".join(" ".join(map(str, r)) + "\n" for r in rows) + "END\n"
                   for name, rows in blocks.items())
    for kind, terminal in (("svg", f'svg size {width},{height} font "sans,13" background "white"'),
                           ("png", f'pngcairo size {width * 3 // 2},{height * 3 // 2} font "sans,18"')):
        said("gnuplot", input=f"set terminal {terminal}\nset output '{path}.{kind}'\n{data}" + "\n".join(lines) + "\n")


def algorithms(arguments, quick):
    out = "out/algorithms"
    os.makedirs(out, exist_ok=True)
    said(BENCH, "algorithms", f"--benchmark_out={out}/algorithms.json", "--benchmark_out_format=json",
         *(["--benchmark_filter=photons:4096/ands:0/", "--benchmark_min_time=0.001"] if quick else arguments))
    rows, errors = [], []  # algorithm, backend, photons, bits of entropy, million items a second
    with open(f"{out}/algorithms.json", encoding="utf-8") as f:
        for run in json.load(f)["benchmarks"]:
            if run.get("error_occurred"):
                errors.append(f"{run['name']}: {run['error_message']}")
                continue
            algorithm, backend, photons = run["name"].split("/")[:3]
            rows.append((algorithm, backend, int(photons.split(":")[1]), round(run["key_entropy_bits"], 1),
                         run["items_per_second"] / 1e6))
    if not rows:
        raise Broken("\n".join(errors))

    def table(column, kept, unit):
        columns = list(dict.fromkeys(r[column] for r in rows if kept(r)))
        heading(["algorithm", "backend"] + [f"{c:g}{unit}" if unit else str(c) for c in columns])
        for name in dict.fromkeys(r[:2] for r in rows if kept(r)):
            cells = {r[column]: f"{r[4]:.3g}" for r in rows if r[:2] == name and kept(r)}
            row(f"`{name[0]}`", name[1], *(cells.get(c, "") for c in columns))

    print("Million photons per second (searches: points), by number of photons; keys of 15 bits of entropy:\n")
    table(2, lambda r: r[3] == 15, "")
    largest = max(r[2] for r in rows if r[2] <= 1048576)
    print(f"\nBy entropy of the keys, {largest} photons:\n")
    table(3, lambda r: r[2] == largest, " bits")
    if errors:
        print("\n" + "\n".join(errors))
    for algorithm in dict.fromkeys(r[0] for r in rows):
        of = {b: [(r[2], r[4]) for r in rows if r[:2] == (algorithm, b) and r[3] == 15]
              for b in sorted({r[1] for r in rows})}
        plot(f"{out}/{algorithm}", 720, 480, [
            "set logscale xy; set format x '2^{%L}'; set logscale x 2; set xlabel 'photons'",
            "set ylabel 'million a second'; set key outside right top; set grid",
            f"set title '{algorithm}' noenhanced",
            "plot " + ", ".join(f"${b} using 1:2 with linespoints title '{b}'" for b in of if of[b])],
             {b: points for b, points in of.items() if points})
    print(f"\nAll of it: {out}/algorithms.json; plots: {out}/*.svg, {out}/*.png")


def clusters(arguments, quick):
    global failed
    out = "out/clusters"
    os.makedirs(out, exist_ok=True)
    if quick:
        arguments = ["--photons", "2000", "--k", "10", "--seconds", "0.01"]
    done = subprocess.run([f"{BENCH}_native", "clusters", *arguments, "--data", f"{out}/clusters.tsv"], check=False)
    if done.returncode > 1:
        sys.exit(done.returncode)
    failed |= done.returncode
    with open(f"{out}/clusters.tsv", encoding="utf-8") as f:
        rows = list(csv.DictReader(f, delimiter="\t"))
    # A group of boxes for each set, a box for each kind of map, from 1 (as fast as the fastest peer) up or down.
    for k in sorted({int(r["k"]) for r in rows}):
        of = [r for r in rows if int(r["k"]) == k]
        sets, maps = (list(dict.fromkeys(r[key] for r in of)) for key in ("set", "map"))
        blocks = {m: [] for m in maps}
        for r in of:
            left = sets.index(r["set"]) + 0.8 * (maps.index(r["map"]) / len(maps) - 0.5)
            right, ratio = left + 0.8 / len(maps), float(r["ratio"])
            blocks[r["map"]].append(((left + right) / 2, ratio, left, right, min(ratio, 1), max(ratio, 1)))
        colours = ("#888888", "#2a7fff", "#d08020", "#309030")
        plot(f"{out}/speed_k{k}", 800, 440, [
            f"set title 'exact {k} nearest photons: times the speed of the fastest peer'",
            "set logscale y; set format y '%g'; set grid ytics; set style fill solid; set ylabel 'times as fast'",
            "set key outside top center horizontal samplen 2; set bmargin 5; set rmargin 3",
            f"set xrange [-0.6:{len(sets) - 0.4}]",
            "set xtics scale 0 rotate by 35 right noenhanced ("
            + ", ".join(f"'{name}' {i}" for i, name in enumerate(sets)) + ")",
            "plot " + ", ".join(f"${m} using 1:2:3:4:5:6 with boxxyerror lc rgb '{colours[i % 4]}' title '{m}'"
                                for i, m in enumerate(maps)) + ", 1 with lines lc rgb '#000000' notitle"], blocks)
    print(f"\nAll of it: {out}/clusters.tsv; plots: {out}/speed_k*.svg, {out}/speed_k*.png")


def convergence(backends, quick):
    heading(["scene", "backend", "search", "pictures", "relMSE < 0.001, s", "SSIM > 0.98, s", "final, s",
             "share by SSIM"])
    for scene in ("glass_ball", "ring", "cornell_box"):
        for backend in backends or ("cpu", "vulkan"):
            for search, options in (("at_least_k", ["--as-paper"]), ("exact_k", ["--passes", "1"])):
                for _ in ("compiling", "measured"):
                    shutil.rmtree(f"{WORK}/steps", ignore_errors=True)
                    stats = render(scene, *options, *(["--size", "64x48"] if quick else []), "--backend", backend,
                                   "--progressive", f"{WORK}/steps", picture="picture.pfm")
                table = next(name for name in os.listdir(f"{WORK}/steps") if name.endswith(".csv"))
                with open(f"{WORK}/steps/{table}", encoding="utf-8") as f:
                    steps = [[float(cell) for cell in line.split(",")[1:]] for line in f.readlines()[1:]]

                def since(is_good):
                    at = len(steps) - 1
                    while at > 0 and is_good(steps[at - 1]):
                        at -= 1
                    return (steps[at][0] - stats["compile_ms"]) / 1000

                near, alike = since(lambda step: step[1] < 1e-3), since(lambda step: step[2] > 0.98)
                whole = (steps[-1][0] - stats["compile_ms"]) / 1000
                row(scene, backend, f"`{search}`", len(steps), f"{near:.2f}", f"{alike:.2f}", f"{whole:.2f}",
                    f"{100 * alike / whole:.0f} %")


def defaults(_, quick):
    pictures = WORK if quick else "docs/defaults"
    os.makedirs(pictures, exist_ok=True)
    ways = {"paper": ["--as-paper"], "pass": ["--passes=1"], "default": []}
    heading(["scene", "the paper's method", "default", "reference", "SSIM of its first pass", "seconds, paper",
             "first pass", "ratio", "wanted", "default", "wanted", ""])
    for scene in ("ring", "glass_ball", "cornell_box", "cornell_blocks"):
        small = ["--size", ("48x48" if quick else "256x256") if scene.startswith("cornell") else
                 ("64x48" if quick else "256x192")]
        with open(scene_file(scene), encoding="utf-8") as f:
            exposure = json.load(f)["render"].get("exposure", 0)
        draw_reference(scene, "--caustics", "bins", *small, "--spp", 4 if quick else 1024, "--paths",
                       100000 if quick else 60000000, "--exposure", exposure, "-o", f"{pictures}/{scene}-reference.png")
        cells = []
        for way in ("paper", "default"):
            render(scene, "--backend", "cpu", *ways[way], *small, "-o", f"{pictures}/{scene}-{way}.png")
            cells.append(f"![{scene}, {way}](../defaults/{scene}-{way}.png) SSIM {compared('SSIM')}")
        render(scene, "--backend", "cpu", *ways["pass"], *small)
        of_pass = compared("SSIM")
        runs = {way: [] for way in ways}
        for _ in range(1 if quick else 5):
            for way, options in ways.items():
                runs[way].append(seconds_of(render(scene, "--backend", "cpu", *options,
                                                   *(["--size", "64x48"] if quick else []))))
        paper, first, whole = (statistics.median(runs[way]) for way in ways)
        row(scene, *cells, f"![{scene}, reference](../defaults/{scene}-reference.png)", of_pass, f"{paper:.3f}",
            f"{first:.3f}", f"{first / paper:.2f}", "1.50", f"{whole:.2f}", "5",
            verdict(first <= 1.5 * paper and whole <= 5))


def cpu_seconds(scene, spp, options, quick):
    """Draws a picture at Table 1's k and shadow rays on serial."""
    plain = [] if "--as-paper" in options else PLAIN_ESTIMATE[:]
    for given in ("--leaks", "--edge-correction"):
        if plain and given in options:
            at = plain.index(given)
            del plain[at:at + 2]
    before = os.times().children_user
    render(scene, "--backend", "serial", "--size", "32x24" if quick else "128x96", *ONE_MAP, *paper_counts(scene),
           "--spp", spp, *plain, *options)
    return os.times().children_user - before


def estimates(_, quick):
    heading(["scene", "estimate", "relMSE", "CPU s", "over the paper's"])
    for scene, paths in (("cornell_blocks", ["--spp", "1024"]), ("cornell_box", ["--spp", "1024"]),
                         ("ring", ["--spp", "256", "--paths", "10000000"]))[:1 if quick else 3]:
        draw_reference(scene, "--size", "32x24" if quick else "128x96",
                       *(["--spp", "4", "--paths", "20000"] if quick else paths))
        for options in ("--as-paper", "--as-paper --search exact_k", "--filter constant --leaks none",
                        "--filter constant", "--filter cone", "--filter epanechnikov", "--filter silverman",
                        "--filter silverman --leaks side,min_cosine", "--filter silverman --leaks side,flattening"):
            # In turn with the paper's, since machines get slower and faster by the minute.
            pairs = [(cpu_seconds(scene, 4, ["--as-paper"], quick), cpu_seconds(scene, 4, options.split(), quick))
                     for _ in range(1 if quick else 3)]
            row(scene, f"`{options}`", compared(), f"{statistics.median(b for _, b in pairs):.2f}",
                f"{statistics.median(b / a if a > 0 else 1 for a, b in pairs):.2f}")


def edges(_, quick):
    heading(["scene", "estimate", "relMSE, 4 eye rays", "relMSE, 32 eye rays", "CPU s, 4 eye rays"])
    for scene in ("cornell_blocks", "cornell_box", "bench/scenes/door.json")[:1 if quick else 3]:
        draw_reference(scene, "--size", "32x24" if quick else "128x96",
                       *(["--spp", "4", "--paths", "20000"] if quick else ["--spp", "1024"]))
        for kind in ("constant", "silverman"):
            for leaks in ("--leaks side --edge-correction none", "--leaks side,min_cosine --edge-correction none",
                          "--leaks side,min_cosine --edge-correction polygons",
                          "--leaks side,min_cosine --edge-correction probes"):
                options = f"--filter {kind} {leaks}"
                runs = [cpu_seconds(scene, 4, options.split(), quick) for _ in range(1 if quick else 3)]
                of_four = compared()
                cpu_seconds(scene, 32, options.split(), quick)
                row(scene, f"`{options}`", of_four, compared(), f"{statistics.median(runs):.2f}")


def error(backends, quick):
    backends = backends or ["serial", "gl", "vulkan"]
    out, size = "out/error", "128x96"
    os.makedirs(out, exist_ok=True)
    columns = ["scene", "backend", "map", "search", "filter", "k", "photons", "seconds", "relmse", "front"]

    def write(path, first, rows):
        """Adds whether no other row of a scene is as fast and as exact, and better in one of both."""
        for r in rows:
            beats = [o for o in rows if o[0] == r[0] and o[7] <= r[7] and o[8] <= r[8] and o[7:9] != r[7:9]]
            r.append(0 if beats else 1)
        with open(path, "w", encoding="utf-8") as f:
            csv.writer(f, lineterminator="\n").writerows([[first] + columns[1:]] + rows)
        return rows

    def measured(scene, backend, builder, search, kind, k, photons, *more):
        stats = render(scene, "--backend", backend, "--size", size, "--map", builder, "--search", search, "--filter",
                       kind, "--k", k, "--photons", photons, "--grid", "auto", "--spp", "1", *ONE_MAP,
                       *paper_counts(scene, "light_samples"), *PLAIN_ESTIMATE, *more)
        seconds = sum(stage["ms"] for stage in stats["stages"].values()) / 1000
        scenes.append([scene, backend, builder, search, kind, k, photons, round(seconds, 5), float(compared())])
        return stats["estimate"]["mean_radius"]

    scenes = []
    for scene in ("cornell_box", "ring", "glass_ball"):
        draw_reference(scene, "--size", size, "--spp", 16 if quick else 512, "--paths", 100000 if quick else 10000000)
        paper = dict(zip(("photons", "k"), paper_counts(scene, "photons", "k")[1::2]))
        for factor in (1, 4, 16):
            for divisor in (16, 4, 1):
                n, m = paper["photons"] * factor // 4, paper["k"] // divisor
                if m < 2 or (quick and (factor, divisor) != (1, 16)):
                    continue
                radius = measured(scene, "cpu", "sort", "exact_k", "silverman", m, n)
                for search in ("exact_k", "at_least_k", "fixed_radius"):
                    for kind in ("constant", "cone", "epanechnikov", "silverman"):
                        if (search, kind) != ("exact_k", "silverman"):
                            measured(scene, "cpu", "sort", search, kind, m, n,
                                     *(["--max-radius", radius] if search == "fixed_radius" else []))
                measured(scene, "cpu", "route", "exact_k", "silverman", m, n)
                for backend in backends if factor < 16 else ():  # software GPUs take their time
                    measured(scene, backend, "sort", "exact_k", "silverman", m, n)
    scenes = write(f"{out}/scenes.csv", "scene", scenes)
    text = said(BENCH, "fields", *(["--quick"] if quick else []), *backends)
    fields = [r[:5] + [int(r[5]), int(r[6]), round(float(r[7]) + float(r[8]), 6), float(r[9])]
              for r in list(csv.reader(text.splitlines()))[1:]]
    fields = write(f"{out}/fields.csv", "field", fields)
    kinds = {"serial": ("4", "#888888", lambda r: r[1] == "serial"), "gl": ("6", "#2a7fff", lambda r: r[1] == "gl"),
             "vulkan": ("8", "#c03030", lambda r: r[1] == "vulkan"),
             "cpu, at_least_k": ("1", "#d08020", lambda r: r[1:4] == ["cpu", "sort", "at_least_k"]),
             "cpu, fixed_radius": ("2", "#309030", lambda r: r[1:4] == ["cpu", "sort", "fixed_radius"]),
             "cpu, exact_k": ("7 ps 0.8", "#000000", lambda r: r[1] == "cpu" and r[3] == "exact_k")}
    for rows, title in ((scenes, f"{{}}, {size}, the whole picture"), (fields, "{}: 4,096 points, map and search")):
        for place in dict.fromkeys(r[0] for r in rows):
            here = [r for r in rows if r[0] == place]
            blocks = {f"kind{i}": [r[7:9] for r in here if of(r)] for i, (_, _, of) in enumerate(kinds.values())}
            lines = [f"${block} with points pt {point} lc rgb '{colour}' title '{name}' noenhanced"
                     for (name, (point, colour, _)), block in zip(kinds.items(), blocks) if blocks[block]]
            blocks["front"] = sorted(r[7:9] for r in here if r[9])
            plot(f"{out}/{place}", 720, 480, [
                "set logscale xy; set format x '%g'; set format y '10^{%T}'; set xlabel 'seconds'",
                f"set ylabel 'relMSE'; set title '{title.format(place.replace('_', ' '))}'",
                "set key outside right top; set grid",
                "plot " + ", ".join(lines + ["$front with lines lw 1.5 lc rgb '#000000' title 'Pareto front'"])],
                 {name: points for name, points in blocks.items() if points})

    def front(rows):
        names = [f"{r[1]} `{r[3]}`" for r in rows if r[9]]
        return ", ".join(f"{names.count(name)} of {name}" for name in sorted(set(names), key=names.count, reverse=True))

    print(f"On the Pareto fronts of the scenes: {front(scenes)}. Of the fields: {front(fields)}.\n")
    print(f"Rows: {len(scenes)} in {out}/scenes.csv, {len(fields)} in {out}/fields.csv; plots: {out}/*.svg, "
          f"{out}/*.png")


def figure7(_, quick):
    folder = WORK if quick else "docs/figure7"
    os.makedirs(folder, exist_ok=True)
    heading(["scene", "sort", "route", "reference"])
    # As many eye rays as the paper's size; eye paths and light paths of the reference.
    for scene, size, spp, paths in (("glass_ball", "256x192", 128, 30000000), ("ring", "256x192", 64, 60000000),
                                    ("cornell_box", "256x256", 128, 20000000)):
        how = ["--caustics", "bins", "--size", "32x24" if quick else size, "--spp", 4 if quick else spp, "--paths",
               100000 if quick else paths]
        draw_reference(scene, *how, "-o", f"{folder}/{scene}-reference.png")
        draw_reference(scene, *how, "--seed", "2", picture="again.exr")
        cells = []
        for builder in ("sort", "route"):
            render(scene, "--backend", "serial", "--map", builder, *how[2:4], *ONE_MAP, *paper_counts(scene), "--spp",
                   "4", "-o", f"{folder}/{scene}-{builder}.png")
            cells.append(f"![{scene}, {builder}](../figure7/{scene}-{builder}.png) relMSE {compared()}")
        row(scene, *cells, f"![{scene}, reference](../figure7/{scene}-reference.png) another seed: relMSE "
            + compared("relMSE", "again.exr"))


def gather(_, quick):
    one, many = "--passes 1 --spp 16", "--spp 1 --passes 16"
    ring = [f"{one} --caustic-photons 0 --emission power", f"{one} --caustic-photons 0", one,
            f"{many} --k 30 --caustic-photons 0 --emission power --radii per_pass",
            f"{many} --k 30 --caustic-photons 0 --radii per_pass", f"{many} --radii shrinking"]
    shrinking = [f"{many} --k 50 --radii shrinking", f"{many} --k 50 --radii shrinking --indirect gather"]
    ways = {"cornell_blocks": [one, f"{one} --k 200", f"{one} --indirect gather --k 50",
                               f"{many} --k 50 --radii per_pass", *shrinking],
            "cornell_box": [f"{one} --caustic-photons 0", f"{one} --caustic-photons 0 --k 200", one,
                            f"{one} --indirect gather --k 50 --caustic-photons 0", f"{one} --indirect gather --k 50",
                            f"{many} --k 50 --caustic-photons 0 --radii per_pass", f"{many} --k 50 --radii per_pass",
                            *shrinking],
            "ring": ring, "glass_ball": ring}
    paths = 4 if quick else 2048
    heading(["scene", "options", "photon paths", "seconds", "relMSE", "relMSE of 4 x 4", "bias of the mean"])
    for scene, of in ways.items():
        draw_reference(scene, "--size", "128x128", "--spp", paths, "--caustics", "bins", "--paths", paths * 30000)
        for way in of:
            stats = render(scene, "--size", "128x128", *way.split(), "--backend", "cpu")
            said(PROGRAM, "error", f"{WORK}/picture.exr", f"{WORK}/reference.exr", "--stats", f"{WORK}/error.json",
                 "-o", f"{WORK}/error.png")
            with open(f"{WORK}/error.json", encoding="utf-8") as f:
                bias = json.load(f)["regions"][0]["bias"]
            smooth = compared("relMSE", "picture.exr", "reference.exr", "--average", "4")
            row(scene, f"`{way}`", stats["photons"]["emitted"], f"{seconds_of(stats):.2f}", f"{float(compared()):.5f}",
                f"{float(smooth):.5f}", f"{bias:+.4f}")


def inclusion(_, quick):
    said("cmake", "--install", BUILD, "--component", "dev", "--prefix", f"{WORK}/prefix")
    environment = {**os.environ, "PKG_CONFIG_PATH": f"{WORK}/prefix/share/pkgconfig", "CCACHE_DISABLE": "1"}
    estimate, maps, own = "estimate/knn_grid_estimate.hpp", "map/map_builders.hpp", "map/own_photons.hpp"

    def includes(*headers):
        return "".join(f"#include <{h if '/' in h and h.startswith('glm') else 'photongrid/' + h}>\n" for h in headers)

    def smallest(header, device):
        return includes(f"backends/{header}", maps, estimate, own) + f"""
struct photon {{ glm::vec3 position, power; }};
int main()
{{
    photongrid::{device} device;
    const glm::vec3 o(0), x(1, 0, 0), y(0, 1, 0), power(1);
    const std::vector<photon> photons{{{{o, power}}, {{x, power}}, {{y, power}}}};
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, photons), 2);
    const auto points = photongrid::upload_points(device, std::vector<glm::vec3>{{{{0.2f, 0.3f, 0}}}});
    return device.download(photongrid::knn_grid_estimate(device, map, points, {{.k = 2}}).irradiance)[0].x > 0 ? 0 : 1;
}}
"""

    empty = "int main() {}\n"
    files = [("GLM alone", "glm", includes("glm/glm.hpp") + empty),
             ("core: one algorithm", "photongrid", includes(estimate) + empty),
             ("core: maps, estimates, lists", "photongrid",
              includes(maps, estimate, "estimate/knn_neighbours.hpp", own) + empty),
             ("core: everything", "photongrid", includes("render/render.hpp", "map/map_file.hpp", own) + empty)]
    backends = ["serial"] if quick else ["serial", "cpu", "gl", "vulkan"]
    files += [(b, f"photongrid-{b}", smallest(f"{b}/{b}.hpp", f"{b}_backend")) for b in backends]
    if not quick:
        files.append(("cpu, by kernels", "photongrid-cpu", smallest("cpu/cpu_by_kernels.hpp", "cpu_by_kernels")))
        files.append(("cpu, compiled library", "photongrid-cpu_compiled", includes("backends/cpu/compiled.hpp", own) + """
struct photon { glm::vec3 position, power; };
int main()
{
    photongrid::cpu_backend device;
    const glm::vec3 o(0), x(1, 0, 0), power(1);
    const photongrid::photon_map map(device, std::vector<photon>{{o, power}, {x, power}}, {.k = 2});
    return map.irradiance(std::vector<glm::vec4>{{0.2f, 0.3f, 0, 1}})[0].value > 0 ? 0 : 1;
}
"""))
    took = [[] for _ in files]
    for _ in range(1 if quick else 3):  # in turn
        for i, (_, package, text) in enumerate(files):
            with open(f"{WORK}/{i}.cpp", "w", encoding="utf-8") as f:
                f.write(text)
            flags = said("pkg-config", "--cflags", package, env=environment).split()
            begin = time.monotonic()
            said("g++", "-std=c++20", "-O2", *flags, "-c", f"{WORK}/{i}.cpp", "-o", f"{WORK}/{i}.o", env=environment)
            took[i].append(time.monotonic() - begin)
    heading(["included", "compiled, s", "over GLM, s", "stripped program, kB"])
    seconds = [statistics.median(t) for t in took]
    for i, (name, package, text) in enumerate(files):
        size = ""
        if not text.endswith(empty):
            said("g++", f"{WORK}/{i}.o", "-s", "-o", f"{WORK}/{i}",
                 *said("pkg-config", "--libs", package, env=environment).split())
            size = os.path.getsize(f"{WORK}/{i}") // 1000
        row(name, f"{seconds[i]:.2f}", f"{seconds[i] - seconds[0]:.2f}", size)
    print(f"\nThe core's maps, estimates and lists in less than 1.5 s: {verdict(max(seconds[1:3]) < 1.5)}")


def lamps(_, quick):
    samples, size = 4, [32, 24] if quick else [160, 120]

    def lit_by(kind, side):
        lights = []
        for i in range(side * side):
            x, z = (-2.8 + 5.6 * (j + 0.5) / side for j in (i % side, i // side))
            place = {"position": [x, 2.5, z]} if kind == "point" else \
                {"corner": [x, 2.5, z], "edge_u": [0.1, 0, 0], "edge_v": [0, 0, 0.1]}
            lights.append({"type": kind, **place, "power": 100 / side / side})
        floor = [[-3, 0, -3], [-3, 0, 3], [3, 0, 3], [3, 0, -3]]
        with open(f"{WORK}/{side}.json", "w", encoding="utf-8") as f:
            json.dump({"photongrid": 1, "name": "lamps", "units": {"length": "m", "power": "W"},
                       "camera": {"position": [0, 1.6, -4], "look_at": [0, 0.4, 0], "vertical_fov": 45},
                       "materials": {"white": {"type": "lambertian", "reflectance": 0.7}},
                       "shapes": [{"type": "polygon", "vertices": floor, "material": "white"},
                                  {"type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "white"},
                                  {"type": "box", "corner": [1, 0, 0.3], "edge_u": [0.6, 0, 0], "edge_v": [0, 0.8, 0],
                                   "edge_w": [0, 0, 0.6], "material": "white"}],
                       "lights": lights, "render": {"size": size, "photons": 1000, "k": 20, "max_radius": 1}}, f)

    def drawn(side, spp, picture):
        return seconds_of(render(f"{WORK}/{side}.json", "--backend", "cpu", "--spp", spp, picture=picture))

    print(f"cpu, {samples} samples a pixel, {size[0]} x {size[1]}.\n")
    heading(["lamps", "one, s", "a hundred, s", "ratio", "at most", "relMSE of one", "of a hundred", ""])
    for kind in ("rectangle", "point"):
        for side in (1, 10):
            lit_by(kind, side)
            drawn(side, 16 * samples, f"{side}-many.pfm")
        runs = [[drawn(side, samples, f"{side}.pfm") for side in (1, 10)] for _ in range(2 if quick else 6)][1:]
        one, many = (statistics.median(times) for times in zip(*runs))
        row(kind, f"{one:.3f}", f"{many:.3f}", f"{many / one:.2f}", 3,
            *(compared("relMSE", f"{side}.pfm", f"{side}-many.pfm") for side in (1, 10)), verdict(many <= 3 * one))


def panes(backends, quick):
    index, thick, lamp, edge = 1.5, 0.02, 1.6, 0.4  # m; the lamps are as high over the floor
    across, down = 0.6, 0.8  # sine and cosine of the light's angle to the pane's normal
    refracted = math.sqrt(1 - (across / index) ** 2)
    s, p = (down - index * refracted) / (down + index * refracted), (index * down - refracted) / (index * down + refracted)
    passed = statistics.mean((1 - r * r) / (1 + r * r) for r in (s, p))  # with all reflections between both faces
    nearer = thick * (1 - down / (index * refracted))  # what lies behind the pane seems so much nearer

    surfaces = {"matte": {"type": "lambertian"}, "plastic": {"type": "plastic"}}
    for roughness in (0.3, 0.6):
        surfaces[f"plastic {roughness}"] = {"type": "plastic", "roughness": roughness}
    for roughness in (0.2, 0.35, 0.5, 0.75, 1):
        surfaces[f"metal {roughness}"] = {"type": "metal", "roughness": roughness}

    def light(kind, height):
        at = [0, height, -lamp * across / down]
        return {"sun": {"type": "directional", "direction": [0, -down, across], "irradiance": 3},
                "bulb": {"type": "point", "position": at, "power": 30},
                "spot": {"type": "spot", "position": at, "direction": [0, -down, across], "inner_angle": 20,
                         "outer_angle": 30, "power": 30},
                "rectangle": {"type": "rectangle", "corner": [-edge / 2, height, at[2] - edge / 2],
                              "edge_u": [edge, 0, 0], "edge_v": [0, 0, edge], "power": 30},
                "ball": {"type": "sphere_light", "center": at, "radius": edge / 2, "power": 30}}[kind]

    def mean(surface, kind, behind_pane, *command):
        box = {"type": "box", "corner": [-0.6, 0.9, -1.3], "edge_u": [1.2, 0, 0], "edge_v": [0, 0, 1.2],
               "edge_w": [0, thick, 0], "material": "pane"}
        has_size = kind in ("rectangle", "ball")  # rays meet it by chance behind the pane
        floor = [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]
        with open(f"{WORK}/pane.json", "w", encoding="utf-8") as f:
            json.dump({"photongrid": 1, "name": "pane", "units": {"length": "m", "power": "W"},
                       "camera": {"position": [0, 0.8, 0.6], "look_at": [0, 0, 0], "vertical_fov": 16},
                       "materials": {"pane": {"type": "glass", "index_of_refraction": index},
                                     # dark: what it sends back to the pane counts next to nothing
                                     "floor": {"reflectance": 0.02, **surfaces[surface]}},
                       "shapes": [{"type": "polygon", "vertices": floor, "material": "floor"}] + [box] * behind_pane,
                       "lights": [light(kind, lamp if behind_pane else lamp - nearer)],
                       "render": {"size": [8, 8], "photons": 20000 if quick else 200000, "k": 200, "max_radius": 0.05,
                                  "spp": 512 if has_size and not quick else 4, "light_samples": 1, "passes": 16}}, f)
        said(PROGRAM, *command, f"{WORK}/pane.json", "--quiet", "-o", f"{WORK}/pane.pfm")
        with open(f"{WORK}/pane.pfm", "rb") as f:
            return statistics.mean(struct.unpack("<192f", f.read()[-768:]))

    by = [("render", "--backend", b, "--shader-cache", f"{WORK}/cache") for b in backends or
          (["cpu"] if quick else ["cpu", "serial", "gl", "vulkan"])]
    by.append(("reference", "--spp", "64" if quick else "8192", "--paths", "1e5" if quick else "1e7"))
    heading(["surface", "light", *(c[2] if c[0] == "render" else c[0] for c in by), ""])
    for surface in list(surfaces)[:2] if quick else surfaces:
        for kind in ("sun", "bulb", "spot", "rectangle", "ball"):
            right = passed * mean(surface, kind, False, "render", "--backend", "cpu")
            shares = [mean(surface, kind, True, *command) / right for command in by]
            row(surface, kind, *(f"{share:.3f}" for share in shares),
                verdict(quick or all(abs(share - 1) <= 0.03 for share in shares)))


def water(backends, quick):
    size, pbrt = 32 if quick else 128, os.path.join(os.environ.get("PHOTONGRID_PEERS", ""), "pbrt")
    scene = write_scene("glass_of_water", WORK)
    picture = f"{WORK}/water.pfm"

    def blocks(*command):
        said(*command)
        return block_means(*read_picture(picture), size // 16)

    def by(command, *options):
        return lambda seed: blocks(PROGRAM, command, scene, "--size", f"{size}x{size}", "--quiet", "-o", picture,
                                   "--seed", seed, *options)

    def by_pbrt(seed):
        with open(f"{WORK}/water.pbrt", "w", encoding="utf-8") as f:
            f.write(f'{pbrt_film(size, picture)}Integrator "path" "integer maxdepth" [ 64 ]\n'
                    f'Sampler "{("halton", "random")[seed - 1]}" "integer pixelsamples" [ {16 if quick else 1024} ]\n'
                    f'Include "{scene.replace(".json", ".pbrt")}"\n')
        return blocks(pbrt, "--quiet", f"{WORK}/water.pbrt")

    def drawn_twice(draw):
        """The mean of two pictures, and its noise."""
        one, other = draw(1), draw(2)
        return [(a + b) / 2 for a, b in zip(one, other)], statistics.mean(pixel_errors(one, other)) / 4

    judge = by("reference", "--spp", 16 if quick else 512)
    if os.access(pbrt, os.X_OK):
        judge = by_pbrt
    else:
        print("sections.py: water: SKIPPED pbrt-v3: PHOTONGRID_PEERS names no folder that has it", file=sys.stderr)
    right, noise = drawn_twice(judge)
    heading(["program", "relMSE of blocks", "noise of both", ""])
    passes = 2 if quick else 64
    ways = [(b, by("render", "--backend", b, "--spp", 4, "--passes", passes)) for b in backends or ["cpu"]]
    if judge is by_pbrt:
        ways.append(("reference", by("reference", "--spp", 16 if quick else 512)))
    for name, draw in ways:
        ours, own = drawn_twice(draw)
        error = statistics.mean(pixel_errors(ours, right))
        row(name, f"{error:.2g}", f"{own + noise:.2g}", verdict(quick or error <= 2 * (own + noise)))


def povray(scene, photons, picture, *options):
    """POV-Ray's picture of a scene; returns its seconds."""
    need("povray", "povray")
    with open(f"{WORK}/scene.pov", "w", encoding="utf-8") as f:
        f.write(said(BENCH, "povray", scene_file(scene), "--photons", photons))
    begin = time.monotonic()
    said("povray", f"+I{WORK}/scene.pov", f"+O{WORK}/{picture}", "+FE", "+W512", "+H384", "-D", "-GA", *options)
    return time.monotonic() - begin


def pictures(_, quick):
    photons = {} if quick else {"ring": 16000, "glass_ball": 5000}
    wanted = {"cornell_box": (2.5, 8), "ring": (0.4, 1.5), "glass_ball": (0.4, 1.5)}
    heading(["scene", "cpu, s", "wanted", "", "vulkan, s", "wanted", "", "POV-Ray, s", "over cpu", ""])
    for scene, limits in wanted.items():
        def ours(backend):
            return seconds_of(render(scene, *(["--size", "64x48"] if quick else []), "--spp", "1", *ONE_MAP,
                                     *paper_counts(scene), *PLAIN_ESTIMATE, "--backend", backend,
                                     picture="picture.pfm"))

        ours("vulkan")  # compiles
        runs = [[ours("cpu"), ours("vulkan"), povray(scene, photons[scene], "povray.exr", "-A", "+WT2")
                 if scene in photons else 0] for _ in range(1 if quick else 5)]
        cpu, vulkan, theirs = (statistics.median(times) for times in zip(*runs))
        cells = []
        for seconds, most in zip((cpu, vulkan), limits):
            cells += [f"{seconds:.2f}", most, verdict(seconds <= most)]
        if theirs:
            cells += [f"{theirs:.2f}", f"{theirs / cpu:.1f}", verdict(theirs >= cpu)]
        row(scene, *cells, *[""] * (9 - len(cells)))


def ring(_, quick):
    for photons, picture in ((20000 if quick else 2000000, "on.exr"), (0, "off.exr")):
        povray("ring", photons, picture, *(["-A"] if quick else ["+A0.1"]))
    render("ring", "--backend", "serial", *ONE_MAP, "--photons", "20000" if quick else "500000", "--k", "100", "--spp",
           "1" if quick else "4", picture="ours.exr")
    text = said(BENCH, "povray", scene_file("ring"), "--compare", f"{WORK}/ours.exr", f"{WORK}/on.exr",
                f"{WORK}/off.exr", allowed=(0, 1))
    print(text, end="")
    verdict(float(re.search(r"\| 10 % \| ([0-9.]+)", text)[1]) >= 0.7)


def stages(backends, quick):
    names = ("trace_photons", "build_map", "trace_rays", "radiance_estimate")
    print("ms\n")
    heading(["scene", "backend", "run", "trace photons", "build map", "trace rays", "radiance estimate"])
    for backend in backends:
        for scene in ("cornell_box", "ring", "glass_ball", "terrace"):
            for run in ("first", "second", "third"):
                stats = render(scene, "--backend", backend, "--passes", "1", "--time-passes",
                               *(["--size", "64x48"] if quick else []), picture="picture.pfm")
                row(scene, backend, run, *(f"{stats['stages'][name]['ms']:.2f}" for name in names))


def strips(_, quick):
    width, height, samples = (16, 16, 16) if quick else (64, 32, 4096)

    def box(half, low, high):
        return {"type": "box", "corner": [-half, low, -half], "edge_u": [2 * half, 0, 0], "edge_v": [0, 0, 2 * half],
                "edge_w": [0, high - low, 0]}

    def faces(half, low, high):
        return box_mesh([-half, low, -half], [half, high, half])

    def mesh(half, low, high):
        whole = faces(half, low, high)
        return {"type": "mesh", "positions": whole.positions, "triangles": whole.triangles}

    def polygons(half, low, high):
        whole = faces(half, low, high)  # two triangles a face: abc, acd
        return [{"type": "polygon", "vertices": [whole.positions[i] for i in (*one, other[2])]}
                for one, other in zip(whole.triangles[::2], whole.triangles[1::2])]

    top = {"type": "disk", "center": [0, 0.4, -0.6], "normal": [0, 1, 0], "radius": 0.3}
    wall = {"position": [0, 0.5, 0.2], "look_at": [0, 0.02, -1], "vertical_fov": 20}
    foot = {"position": [0, 0.4, 0.9], "look_at": [0, 0.03, 0.3], "vertical_fov": 20}
    edge = {"position": [0, 1, 0.6], "look_at": [0, 0.4, 0.3], "vertical_fov": 14}
    heading(["edge", "worst row over the reference's", "its noise", ""])
    for name, shapes, camera in (
            ("wall and floor, polygons", polygons(1, 0, 2), wall), ("wall and floor, mesh", [mesh(1, 0, 2)], wall),
            ("wall and floor, box", [box(1, 0, 2)], wall),
            ("foot of a box", [box(1, 0, 2), box(0.3, 0, 0.4)], foot),
            ("foot of a mesh", [mesh(1, 0, 2), mesh(0.3, 0, 0.4)], foot),
            ("foot of a mesh 1 mm above", [mesh(1, 0, 2), mesh(0.3, 0.001, 0.4)], foot),
            ("upper edge of a box", [box(1, 0, 2), box(0.3, 0, 0.4)], edge),
            ("upper edge of a mesh", [mesh(1, 0, 2), mesh(0.3, 0, 0.4)], edge),
            ("rim of a disk", [mesh(1, 0, 2), top], {"position": [0, 1, -0.3], "look_at": [0, 0.4, -0.3],
                                                     "up": [0, 0, -1], "vertical_fov": 10})):
        with open(f"{WORK}/edge.json", "w", encoding="utf-8") as f:
            json.dump({"photongrid": 1, "name": name, "units": {"length": "m", "power": "W"}, "camera": camera,
                       "materials": {"grey": {"type": "lambertian", "reflectance": 0.7}},
                       "shapes": [{**s, "material": "grey"} for s in shapes],
                       "lights": [{"type": "rectangle", "corner": [-0.2, 1.98, 0.3], "edge_u": [0.4, 0, 0],
                                   "edge_v": [0, 0, 0.4], "power": 20}],
                       "render": {"size": [width, height], "photons": 200000, "k": 500, "max_radius": 0.3}}, f)

        def rows(*command):
            said(PROGRAM, *command, f"{WORK}/edge.json", "--quiet", "-o", f"{WORK}/edge.pfm")
            values = read_picture(f"{WORK}/edge.pfm")[1]
            return [statistics.mean(values[3 * width * y:3 * width * (y + 1)]) for y in range(height)]

        def of_seeds(count, *command):
            """Per row, the mean over seeds and its standard error."""
            by_seed = zip(*(rows(*command, "--seed", seed) for seed in range(1, count + 1)))
            return [(statistics.mean(r), statistics.stdev(r) / math.sqrt(count)) for r in by_seed]

        right = of_seeds(2, "reference", "--spp", samples)
        ours = of_seeds(2 if quick else 8, "render", "--backend", "cpu", "--passes", 2 if quick else 16)
        shares = [o[0] / r[0] for o, r in zip(ours, right)]
        noise = math.sqrt(statistics.mean((o[1] ** 2 + r[1] ** 2) / r[0] ** 2 for o, r in zip(ours, right)))
        worst = max(shares, key=lambda share: abs(share - 1))
        row(name, f"{worst:.3f}", f"{noise:.3f}", verdict(quick or abs(worst - 1) <= 0.01 + 2 * noise))


def table1(backends, quick):
    print("Seconds; stages without compiling kernels, totals with it.\n")
    heading(["scene", "map", "backend", "trace photons", "build map", "trace rays", "radiance estimate", "total",
             "mean photons used", "peak MB"])
    for scene in ("glass_ball", "ring", "cornell_box"):
        for builder in ("sort", "route"):
            for backend in backends or ("serial", "vulkan", "gl"):
                stats = render(scene, "--backend", backend, "--map", builder, "--as-paper",
                               *(["--size", "64x48"] if quick else []), picture="picture.pfm")
                row(scene, builder, backend,
                    *(f"{stats['stages'][name]['ms'] / 1000:.2f}"
                      for name in ("trace_photons", "build_map", "trace_rays", "radiance_estimate")),
                    f"{stats['total_ms'] / 1000:.2f}", f"{stats['estimate']['mean_count']:.0f}",
                    f"{stats['peak_memory_bytes'] / 1e6:.0f}")


def window(backends, quick):
    need("Xvfb", "xvfb")
    need("xdotool", "xdotool")
    heading(["backend", "looked at events", "longer than 33 ms", "wanted at most", "longest, ms", "requests begun",
             "pictures", ""])
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x900x24", "-nolisten", "tcp",
                               "-noreset"], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        os.environ["DISPLAY"] = ":" + os.read(read, 16).decode().strip()
        for backend in ["cpu"] if quick else backends or ("cpu", "vulkan"):
            journal = f"{WORK}/journal-{backend}"
            shown = subprocess.Popen([PROGRAM, "view", scene_file("cornell_box"), "--size", "512x512", "--backend",
                                      backend, "--shader-cache", f"{WORK}/cache", "--quiet", "--journal", journal],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

            def entries():
                if not os.path.exists(journal):
                    return ""
                with open(journal, encoding="utf-8") as f:
                    return f.read()

            for _ in range(600):
                if '"whole"' in entries() or shown.poll() is not None:
                    break
                time.sleep(0.1)
            said("xdotool", "mousemove", "30", "400", "mousedown", "1")
            for x in range(31, 181):
                said("xdotool", "mousemove", x, "400")
                time.sleep(0.015)
            said("xdotool", "mouseup", "1")
            time.sleep(1)
            shown.send_signal(2)
            shown.wait()
            text = entries()
            if '"closed"' not in text:
                raise Broken(f"the window on {backend} wrote no journal")
            turns, slow, slowest = (float(re.search(rf'"{key}": *([0-9.]+)', text)[1])
                                    for key in ("turns", "turns_above_33_ms", "slowest_turn_ms"))
            row(backend, int(turns), int(slow), int(turns / 100), f"{slowest:.0f}", text.count('"start"'),
                text.count('"picture"'), verdict(slow <= int(turns / 100)))
    finally:
        server.terminate()


SECTIONS = {f.__name__: f for f in (algorithms, clusters, convergence, defaults, edges, error, estimates, figure7,
                                    gather, inclusion, lamps, panes, pictures, ring, stages, strips, table1, water,
                                    window)}

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in SECTIONS:
        print(__doc__.strip(), file=sys.stderr)
        sys.exit(2)
    try:
        SECTIONS[sys.argv[1]]([word for word in sys.argv[2:] if word != "--quick"], "--quick" in sys.argv)
    except (Broken, OSError) as e:
        print(f"bench/sections.py {sys.argv[1]}: {e}", file=sys.stderr)
        sys.exit(2)
    except Exception:  # 1 is what is too slow
        traceback.print_exc()
        sys.exit(2)
    sys.exit(failed)
