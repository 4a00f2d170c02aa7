#!/usr/bin/env python3
"""Compares this tree with another commit: whether pictures are still the same, and nothing has become slower. Prints
Markdown.

  bench/against.py REV [--pictures] [--speed] [--quick] [--built BASE_BUILD HEAD_BUILD]

  REV         the other commit, the base
  --pictures  scenes on every backend with every kind of estimate, small, bit for bit
  --speed     whole pictures by stage, sorts and searches, both trees in turn: medians, and what base takes over what
              head takes, 0.97 wanted, of the medians or of the least times: other work on the machine only adds. What
              misses it is measured twice more. Stages of less than 5 ms get no verdict
  --quick     fewer pictures, little to measure, to see that it runs
  --built     builds nothing and takes these build folders; sorts and searches where they have photongrid_bench

Both draw the scenes as they are in REV. Without --pictures and --speed: both. Unless --built is given, REV is checked
out in build-against/tree, and each tree is built in its build-against/bench. Exit status: 1 where a picture differs or
a row is too slow, 2 where something is broken.
"""
import argparse
import filecmp
import json
import os
import statistics
import subprocess
import sys
import time

from sections import WORK, Broken, heading, row, said

ALL_SCENES = ("cornell_box", "cornell_blocks", "ring", "glass_ball")
BACKENDS = ("serial", "cpu", "gl", "vulkan")
# Options of every scene on every backend, and of one scene on every backend.
EVERYWHERE = ("", "--as-paper", "--map route", "--as-paper --map route", "--spp 2", "--only caustic",
              "--depth 2", "--depth 2 --as-paper --map route")
ONCE = ("--seed 7", "--photons 100000", "--photons 100000 --map route", "--grid auto --k 8", "--map route --slots 2",
        "--exposure 1 --depth 2 --light-samples 1", "--search at_least_k", "--search fixed_radius --max-radius 0.2",
        "--as-paper --search exact_k", "--as-paper --search fixed_radius --max-radius 0.2 --map route",
        "--filter constant", "--filter cone", "--filter epanechnikov --bias paper",
        "--filter cone --search at_least_k", "--leaks none --edge-correction none", "--leaks side,min_cosine=0.7",
        "--leaks side,flattening=2 --map route --edge-correction none", "--leaks side,min_cosine --edge-correction polygons", "--only direct",
        "--only indirect")
RING = ("cpu --threads 1", "cpu --threads 3", "cpu --threads 3 --photons 100000", "reference",
        "reference --caustics bins", "reference --seed 7")
SIDES = ("base", "head")
failed = 0


def built_trees(rev, speed):
    """Build folders of both sides."""
    tree = "build-against/tree"
    if os.path.exists(f"{tree}/.git"):
        said("git", "-C", tree, "checkout", "--quiet", "--detach", rev)
    else:
        said("git", "worktree", "add", "--quiet", "--force", "--detach", tree, rev)
    for folder in (tree, "."):
        environment = {**os.environ, "CCACHE_BASEDIR": os.path.abspath(folder)}  # what is the same compiles once
        build = f"{folder}/build-against/bench"
        said("cmake", "-S", folder, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DPHOTONGRID_TESTS=OFF",
             f"-DPHOTONGRID_BENCH={'ON' if speed else 'OFF'}", env=environment)
        said("cmake", "--build", build, "--target", "photongrid_program", env=environment)
        if speed:  # an older base may have none
            subprocess.run(["cmake", "--build", build, "--target", "photongrid_bench", "photongrid_bench_native"],
                           env=environment, stdout=sys.stderr, check=False)
    return {"base": f"{tree}/build-against/bench", "head": "build-against/bench"}


def compare_pictures(builds, quick):
    global failed
    heading(["scene", "backend", "options", ""])
    counts = {"same": 0, "differs": 0}

    def picture(scene, words):
        backend, *options = words.split()
        how = ["reference", "--spp", "4", "--paths", "100000"] if backend == "reference" else \
            ["render", "--backend", backend] + ([] if "--photons" in options else ["--photons", "2000"]) \
            + ([] if "--as-paper" in options else ["--passes", "2", "--caustic-photons", "2000"])
        files = {side: f"{WORK}/{side}.pfm" for side in SIDES}
        running = {side: subprocess.Popen(
            [f"{builds[side]}/photongrid", how[0], f"{WORK}/{scene}.json", *how[1:], *options, "--size", "64x48",
             "--quiet", "-o", files[side]], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                   for side in SIDES}
        words_of = {side: process.communicate()[1].strip() for side, process in running.items()}
        status = [running[side].returncode for side in SIDES]
        if status[0] == status[1] != 0:  # neither has the backend, or takes the options
            what = "not drawn: " + words_of["head"]
        elif status != [0, 0]:
            what = f"**differs**: exit statuses {status[0]}, {status[1]}: " + "; ".join(filter(None, words_of.values()))
        elif filecmp.cmp(files["base"], files["head"], shallow=False):
            what = "same"
        else:
            relmse = said(f"{builds['head']}/photongrid", "compare", files["head"], files["base"]).split()[3]
            what = f"**differs**: relMSE {relmse}"
        for kind in counts:
            counts[kind] += kind in what[:10]
        row(scene, backend, f"`{' '.join(options)}`" if options else "", what.replace("\n", " "))

    for scene in ALL_SCENES:
        for backend in BACKENDS:
            few = quick and backend in ("gl", "vulkan")
            if not few or scene == "ring":
                for options in EVERYWHERE[::3] if few else EVERYWHERE:
                    picture(scene, f"{backend} {options}")
    for backend in BACKENDS[:2] if quick else BACKENDS:
        for options in ONCE:
            picture("cornell_blocks", f"{backend} {options}")
    for words in RING:
        picture("ring", words)
    print(f"\n{counts['same']} pictures the same, {counts['differs']} differ")
    if not any(counts.values()):
        raise Broken("no picture could be compared")
    failed |= counts["differs"] > 0


def whole_picture(build, side, scene, backend, size):
    """Each of these measures a side once: ms by name."""
    begin = time.monotonic()
    said(f"{build}/photongrid", "render", f"{WORK}/{scene}.json", "--backend", backend, "--size", size,
         "--passes", "1", "--shader-cache", f"{WORK}/cache-{side}", "--stats", f"{WORK}/stats.json", "--quiet", "-o", f"{WORK}/a.pfm")
    whole = 1000 * (time.monotonic() - begin)
    with open(f"{WORK}/stats.json", encoding="utf-8") as f:
        stats = json.load(f)
    name = f"{scene}, {backend}"
    return {**{f"{name}: {stage}": of["ms"] for stage, of in stats["stages"].items()},
            f"{name}: all but compiling": stats["total_ms"] - stats["compile_ms"], f"{name}: the whole program": whole}


def algorithms(build, photons, seconds):
    text = said(f"{build}/bench/photongrid_bench", "algorithms", "--benchmark_format=json",
                f"--benchmark_min_time={seconds}", "--benchmark_filter="
                f"^(bitonic_sort|sorted_map|stencil_route)/(serial|cpu|gl|vulkan)/photons:{photons}/ands:0/")
    return {", ".join(run["name"].split("/")[:3]): run["real_time"] for run in json.loads(text)["benchmarks"]
            if not run.get("error_occurred")}


def cells_of(*command):
    """Of the rows of tables that a program prints. Whether ratios are as it wants them does not matter here."""
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in said(*command, allowed=(0, 1)).splitlines()
            if line.startswith("| ")]


def grids(build, repetitions, points):
    rows = cells_of(f"{build}/bench/photongrid_bench", "grids", "--repetitions", repetitions, "--backends", "cpu",
                    "--points", points)
    return {f"S3, cpu, {r[1]}, {search}, a thousand points": 1000 / float(r[at]) for r in rows if r[0] == "cpu"
            for search, at in (("at_least_k", 2), ("exact_k", 3))}


def searches(build):
    rows = [r for r in cells_of(f"{build}/bench/photongrid_bench_native", "search", "--seconds", "0.05")
            if r[0][:1] == "S"]
    return {f"{r[0]}, cpu, one thread, {what}": ms for r in rows
            for what, ms in (("exact_k, a thousand points", 1000 / float(r[4])), ("map", float(r[9])))}


def measure(what, builds, quick, once):
    """Rows of what `once` measures of a side, both in turn."""
    global failed
    times = {}
    for _ in range(1 if quick else 3):
        for turn in range(1 if quick else 5):
            for side in SIDES[::-1] if turn % 2 else SIDES:
                try:
                    for name, ms in once(builds[side], side).items():
                        times.setdefault(name, {"base": [], "head": []})[side].append(ms)
                except (Broken, OSError) as e:
                    row(what, "", "", "", "", f"not measured: {e}".replace("\n", " "))
                    return
        rows, slow = [], False
        for name, of in times.items():
            if not of["base"] or not of["head"]:
                rows.append((name, "", "", "", "", f"only {'base' if of['base'] else 'head'} has it"))
                continue
            base, head = (statistics.median(of[side]) for side in SIDES)
            ratio, of_least = (a / b if b > 0 else 1 for a, b in ((base, head), (min(of["base"]), min(of["head"]))))
            short = ": " in name and base < 5 and head < 5  # a stage
            is_slow = not short and max(ratio, of_least) < 0.97
            slow |= is_slow
            rows.append((name, f"{base:.3f}", f"{head:.3f}", f"{ratio:.3f}", f"{of_least:.3f}",
                         "short" if short else "FAIL" if is_slow else "PASS"))
        if not slow:
            break
    for cells in rows:
        row(*cells)
    failed |= slow


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("rev")
    for name in ("--pictures", "--speed", "--quick"):
        parser.add_argument(name, action="store_true")
    parser.add_argument("--built", nargs=2)
    o = parser.parse_args()
    if not (o.pictures or o.speed):
        o.pictures = o.speed = True
    os.environ["NODEVICE_SELECT"] = "1"  # the implicit layer has crashed processes that start side by side
    rev = said("git", "rev-parse", "--verify", o.rev + "^{commit}").strip()
    for scene in ALL_SCENES:
        with open(f"{WORK}/{scene}.json", "w", encoding="utf-8") as f:
            f.write(said("git", "show", f"{rev}:examples/scenes/{scene}.json"))
    builds = dict(zip(SIDES, o.built)) if o.built else built_trees(rev, o.speed)
    for side, commit in (("base", rev), ("head", "HEAD")):
        print(f"{side}: {builds[side]}, {said('git', 'log', '-1', '--format=%h %s', commit).strip()}")
    print()
    if o.pictures:
        compare_pictures(builds, o.quick)
    if o.speed:
        load, cores = os.getloadavg()[0], os.cpu_count()
        if load > cores / 4:
            print(f"\nThe machine is busy, load {load:.2f} on {cores} cores: times are not to be relied on.")
        print()
        heading(["what", "base, ms", "head, ms", "base over head", "of the least", ""])
        size = "64x48" if o.quick else "160x120"
        for scene in ("cornell_box", "ring"):
            for backend in ("cpu", "vulkan", "gl", "serial"):
                for side in SIDES:  # compiles
                    whole_picture(builds[side], side, scene, backend, size)
                measure("whole picture", builds, o.quick,
                        lambda build, side: whole_picture(build, side, scene, backend, size))
        measure("algorithms", builds, o.quick,
                lambda build, _: algorithms(build, 4096 if o.quick else 262144, 0.001 if o.quick else 0.1))
        measure("grids", builds, o.quick, lambda build, _: grids(build, *((1, 200) if o.quick else (3, 20000))))
        if not o.quick:
            measure("search", builds, o.quick, lambda build, _: searches(build))
    return failed


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Broken, OSError) as e:
        print(f"bench/against.py: {e}", file=sys.stderr)
        sys.exit(2)
