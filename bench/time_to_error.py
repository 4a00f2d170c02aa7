# Time to error against other programs: the same scenes, the same size, two threads, one converged reference a scene.
# Prints Markdown; curves (CSV, plots) go to out/time_to_error/. Exit status 1: a floor is missed.
#
#   python3 bench/time_to_error.py [--quick] [--size N] [--limit SECONDS] [--clock wall|cpu] [--ways automatic|best|all]
#                                  [--peers cached|kept|measured|none] [--backends cpu,vulkan,gl] [--draft] [SCENE...]
#
#   --quick     tiny pictures, no other programs: to see that it runs
#   --limit     no run is longer than this, about (60)
#   --clock     which seconds the table has: wall (what one waits; a quiet machine), or CPU seconds over two threads
#   --peers     cached (default): other programs' curves are measured once and kept; kept: those that are not are
#               skipped, which is said; measured: all again; none: left out
#   --draft     references with a sixteenth of the paths
#   --ways      photongrid with the numbers that it chooses (default), with the best of
#               bench/time_to_error_settings.py too, or with all of them
#
# The other programs are executables in the folder that PHOTONGRID_PEERS names: tungsten, pbrt (pbrt-v3) and smallvcm, a
# SmallVCM that takes its scene from a file (to_smallvcm in bench/peer_scenes.py). One that is missing is skipped, which
# is said. What is measured once is kept in that folder, too, in kept/. PHOTONGRID_SCENES has scenes of others
# (water-caustic).
#
# A program's seconds are those of a whole run, less those of a run of 8 x 8 pixels with the least work, which reads the
# same scene, builds what finds ray hits, and compiles kernels. Each point of a curve is a run of its own: a
# progressive program's picture after so many passes.
import argparse
import os
import sys

from error_curves import PeerReference, Reference, Runner, curve_of, seconds_to, write_curves
from time_to_error_settings import PROGRAMS, Photongrid, SCENES, is_program, peers_of, photongrid_ways

parser = argparse.ArgumentParser()
parser.add_argument("scenes", nargs="*")
parser.add_argument("--quick", action="store_true")
parser.add_argument("--size", type=int, default=512)
parser.add_argument("--limit", type=float, default=60)
parser.add_argument("--clock", choices=("wall", "cpu"), default="wall")
parser.add_argument("--peers", choices=("cached", "kept", "measured", "none"), default="cached")
parser.add_argument("--backends", default="cpu,vulkan,gl")
parser.add_argument("--ways", choices=("automatic", "best", "all"), default="automatic")
parser.add_argument("--draft", action="store_true")
options = parser.parse_args()
if options.quick:
    options.size, options.limit, options.peers, options.backends, options.ways = 24, 0.5, "none", "cpu", "automatic"
names = options.scenes or (["cornell_blocks"] if options.quick else list(SCENES))
out = "out/time_to_error"
peers_folder = os.environ.get("PHOTONGRID_PEERS", "")
if options.peers != "none" and not os.path.isdir(peers_folder):
    print("time_to_error.py: SKIPPED other programs: PHOTONGRID_PEERS names no folder that has them: "
          + ", ".join(PROGRAMS), file=sys.stderr)
    options.peers = "none"
elif options.peers != "none":
    for missing in (name for name in PROGRAMS if not is_program(peers_folder, name)):
        print(f"time_to_error.py: SKIPPED {PROGRAMS[missing]}: there is no program {missing} in {peers_folder}",
              file=sys.stderr)
cache = os.path.join(peers_folder, "kept") if options.peers != "none" else out
program = os.environ.get("PHOTONGRID", "build/photongrid")
if not os.access(program, os.X_OK):
    print(f"time_to_error.py: {program} is not there; bench/run.sh builds it (PHOTONGRID names another)",
          file=sys.stderr)
    sys.exit(2)
runner = Runner(options.limit, options.clock)


def say(text):
    print(text, file=sys.stderr, flush=True)


def agreement(curve, reference):
    """What makes a program's longest picture another than the reference, or nothing. Noise is small in means over
    blocks; what is large there, beside the error of pixels, is another light."""
    end = curve.points[-1]
    if end.coarse > max(2e-3, end.relmse / 4):
        blocks = f"{reference.blocks} x {reference.blocks} blocks"
        return f"another picture: relMSE of {blocks} is {end.coarse:.2g}, its mean is off by {100 * end.bias:+.1f} %"
    return ""


def text_of(seconds):
    if seconds is None:
        return "-"
    bound, value = seconds
    digits = f"{value:.2f}" if value < 9.95 else f"{value:.0f}"
    return f"{bound}{digits}"


def judged(target, ours, rivals):
    """The verdict on a floor, by the smallest of the ratios: of each other program, plain and trimmed."""
    best, verdict = None, []
    for name, plain, trimmed in rivals:
        if target.rival and name != target.rival:
            continue
        for kind, theirs, own in (("plain", plain, ours[0]), ("trimmed", trimmed, ours[1])):
            if own[0] == ">" and theirs[0] == ">":
                continue  # neither has this error
            if own[0] == ">":
                return f"{name} has this error, photongrid not within {own[1]:.3g} s: FAIL"
            ratio = theirs[1] / max(own[1], 1e-9)
            if best is None or ratio < best[0]:
                best = (ratio, theirs[0], name, kind)
    if best:
        ratio, bound, name, kind = best
        word = "PASS" if ratio >= target.times else ("FAIL" if bound != ">" else "open, the limit is too short")
        verdict.append(f"{bound}{ratio:.1f} times as soon as {name}, {kind}; wanted {target.times}: {word}")
    elif ours[0][0] == ">":
        verdict.append("nobody has this error within the limit")
    elif options.peers != "none":
        verdict.append("no other program is there that agrees")
    if target.within and options.size == 512:
        word = "PASS" if ours[0][0] != ">" and ours[0][1] <= target.within else "FAIL"
        verdict.append(f"wanted within {target.within} s: {word}")
    return "; ".join(verdict)


def measure(name):
    scene = SCENES[name]
    path = scene.path(program, cache)
    if not path:
        say(f"time_to_error.py: SKIPPED {name}: PHOTONGRID_SCENES names no folder with it")
        return [], []
    reference = Reference(runner, program, scene, path, options.size, cache, options.draft, options.quick)
    note = f"the reference of {name} has a relMSE of its own, {reference.noise:.2g}, which is taken off"
    say(f"{name}: {note}")
    curves = []
    for way in photongrid_ways(name, options.ways):
        backends = options.backends.split(",") if way == photongrid_ways(name, "automatic")[0] else ["cpu"]
        for backend in backends:
            ours = Photongrid(program, path, way, backend)
            try:
                curve = curve_of(runner, ours, reference, scene, options.size, out, None)
            except RuntimeError as e:
                if backend == "cpu":
                    raise
                say(f"time_to_error.py: SKIPPED {ours.name}, {name}: {e}")
                continue
            say(f"  {ours.name} {way}: {curve.summary()}")
            curves.append(curve)
    if options.peers != "none":
        for peer in peers_of(peers_folder, scene, path, options.size, cache):
            if peer.missing:
                say(f"time_to_error.py: SKIPPED {peer.name}, {name}: {peer.missing}")
                continue
            kept = os.path.join(cache, "curves")
            try:
                own = PeerReference(runner, peer, options.size, cache) if scene.own_references else reference
                curve = curve_of(runner, peer, own, scene, options.size, kept, options.peers)
            except (RuntimeError, OSError) as e:
                say(f"time_to_error.py: SKIPPED {peer.name}, {name}: {e}")
                continue
            say(f"  {peer.name} {peer.settings}: {curve.summary()}")
            curves.append(curve)
    return curves, [note, reference]


rows, notes, missed = [], [], False
all_curves = []
for name in names:
    curves, about = measure(name)
    if not curves:
        continue
    all_curves += [(name, c) for c in curves]
    reference = about[1]
    notes.append(about[0])
    own = [c for c in curves if c.program.startswith("photongrid")]
    others = [c for c in curves if not c.program.startswith("photongrid")]
    for target in SCENES[name].targets:
        def of(curve):
            return seconds_to(curve, target.relmse, runner, False), seconds_to(curve, target.relmse, runner, True)

        def rank(curve):  # the soonest that has the error; if none has, the one that is nearest to it
            plain, trimmed = of(curve)
            missing = (plain[0] == ">") + (trimmed[0] == ">")
            return missing, (curve.points[-1].relmse if missing else max(plain[1], trimmed[1]))

        best = min((c for c in own if c.program == "photongrid cpu"), key=rank)
        shown = [best] + [c for c in own if c.program != "photongrid cpu" and c.settings == best.settings]
        agreeing = [c for c in others if not agreement(c, reference)]
        verdict = judged(target, of(best), [(c.program, *of(c)) for c in agreeing])
        missed = missed or "FAIL" in verdict
        for c in shown + others:
            plain, trimmed = of(c)
            reason = agreement(c, reference)
            ratio = f"{plain[0]}{plain[1] / of(best)[0][1]:.1f}" if not reason and of(best)[0][0] != ">" else ""
            last = verdict if c is best else (f"left out: {reason}" if reason else "")
            rows.append(f"| {name} | {target.relmse:g} | {c.program} | `{c.settings}` | {text_of(plain)} "
                        f"| {text_of(trimmed)} | {ratio} | {last} |")
print(f"Pictures of {options.size} x {options.size} pixels, two threads; "
      + ("seconds that one waits" if options.clock == "wall" else "CPU seconds of all threads over two")
      + f"; runs of at most about {options.limit:g} s; `trimmed`: without the worst 0.1 % of the pixels. "
      + "; ".join(notes) + ".\n")
print("| scene | relMSE | program | settings | s | trimmed, s | times photongrid's | |")
print("|---|---|---|---|---|---|---|---|")
print("\n".join(rows))
write_curves(out, all_curves, options.size, runner)
sys.exit(1 if missed and not options.quick else 0)
