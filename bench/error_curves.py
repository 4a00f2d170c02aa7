# Runs, their seconds and their pictures' errors, for time_to_error.py.
import array
import hashlib
import json
import math
import os
import subprocess
import sys
import time

FLOOR = 0.01  # what relMSE adds to the radiance that it divides by (examples/photongrid/compare/image_difference.hpp)


class Crashed(RuntimeError):
    """A program that a signal ended."""


class Runner:
    """Runs programs on two processors, and measures what that takes."""

    def __init__(self, limit, clock):
        self.limit, self.clock = limit, clock
        self.processors = sorted(os.sched_getaffinity(0))[:2]

    def run(self, command, environment=None, folder=None, quiet=True):
        """Wall seconds, and CPU seconds of all its threads over two."""
        begin = time.perf_counter()
        process = subprocess.Popen(command, env={**os.environ, **(environment or {})}, cwd=folder,
                                   stdout=subprocess.DEVNULL if quiet else None, stderr=subprocess.PIPE,
                                   preexec_fn=lambda: os.sched_setaffinity(0, self.processors))
        said = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - begin
        if process.returncode != 0:
            kind = Crashed if process.returncode < 0 else RuntimeError
            raise kind(f"{' '.join(command)}: exit status {process.returncode}\n"
                       + said.decode(errors="replace")[-2000:])
        return wall, (used.ru_utime + used.ru_stime) / 2

    def run_again_if_it_crashes(self, command, environment=None):
        """The same, up to three times: some programs crash now and then."""
        for attempt in range(3):
            try:
                return self.run(command, environment)
            except Crashed as e:
                if attempt == 2:
                    raise
                print(f"error_curves.py: again: {e}", file=sys.stderr, flush=True)

    def seconds(self, point):
        return point.wall if self.clock == "wall" else point.cpu


def read_pfm(data):
    header, at = [], 0
    while len(header) < 3:
        end = data.index(b"\n", at)
        header += [data[at:end].split()] if header else [[data[at:end].strip()]]
        at = end + 1
    width, height = (int(x) for x in header[1])
    values = array.array("f", data[at:at + 12 * width * height])
    if float(header[2][0]) > 0:
        values.byteswap()
    rows = [values[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    return width, [v for row in reversed(rows) for v in row]


def read_hdr(data):
    """A Radiance picture without run lengths, as SmallVCM writes it."""
    at = data.index(b"+X")
    end = data.index(b"\n", at)
    width = int(data[at + 2:end])
    values = []
    for i in range(end + 1, len(data), 4):
        scale = math.ldexp(1, data[i + 3] - 136) if data[i + 3] else 0
        values += [(data[i + j] + 0.5) * scale if scale else 0 for j in range(3)]
    return width, values


def read_picture(path):
    with open(path, "rb") as f:
        data = f.read()
    return read_hdr(data) if path.endswith(".hdr") else read_pfm(data)


def write_pfm(path, width, values):
    height = len(values) // (3 * width)
    with open(path, "wb") as f:
        f.write(f"PF\n{width} {height}\n-1\n".encode())
        for y in reversed(range(height)):
            array.array("f", values[3 * width * y:3 * width * (y + 1)]).tofile(f)


def block_means(width, values, n):
    height, means = len(values) // (3 * width), []
    for y in range(0, height - n + 1, n):
        for x in range(0, width - n + 1, n):
            for c in range(3):
                means.append(sum(values[3 * (width * (y + j) + x + i) + c] for j in range(n) for i in range(n)) / n**2)
    return means


def pixel_errors(values, truth):
    """The mean of (a - b)^2 / (b + FLOOR)^2 over the channels, of each pixel; very large where it is not finite."""
    of_channels = [((a - b) / (b + FLOOR))**2 for a, b in zip(values, truth)]
    errors = [(of_channels[i] + of_channels[i + 1] + of_channels[i + 2]) / 3 for i in range(0, len(truth), 3)]
    return [e if math.isfinite(e) else 1e30 for e in errors]


class Reference:
    """A converged picture of a scene by `photongrid reference`, kept in a folder."""

    def __init__(self, runner, program, scene, path, size, folder, draft, quick):
        arguments = ["--spp", "4", "--paths", "10000"] if quick else scene.reference.split()
        if draft:
            arguments = [str(int(word) // 16) if word.isdigit() else word for word in arguments]
        with open(path) as f:
            described = json.load(f)
        settings, _ = described.pop("render"), described.pop("as_paper", None)
        described["depths"] = [settings.get("depth"), settings.get("photon_depth")]
        key = hashlib.sha256(json.dumps([described, arguments]).encode()).hexdigest()[:12]
        folder = os.path.join(folder, "references")
        os.makedirs(folder, exist_ok=True)
        self.path = os.path.join(folder, f"{scene.name}-{size}-{key}.pfm")
        error = self.path.replace(".pfm", "-error.pfm")
        if not os.path.exists(self.path):
            runner.run([program, "reference", path, "--size", f"{size}x{size}", *arguments, "--quiet",
                        "-o", self.path + ".part.pfm", "--error", error])
            os.replace(self.path + ".part.pfm", self.path)
        self.read(size)
        _, errors = read_picture(error)
        self.noise = sum((e / (b + FLOOR))**2 for e, b in zip(errors, self.values)) / len(errors)

    def read(self, size):
        self.width, self.values = read_picture(self.path)
        self.blocks = max(size // 16, 1)
        self.coarse = block_means(self.width, self.values, self.blocks)
        self.mean = sum(self.values) / len(self.values)


class PeerReference(Reference):
    """A converged picture by another program; its noise is not known."""
    noise = 0

    def __init__(self, runner, peer, size, folder):
        self.path = os.path.join(folder, "references", f"{peer.scene.name}-{size}-{peer.executable}.pfm")
        if not os.path.exists(self.path):
            part = self.path + ".part.pfm"
            runner.run(*peer.reference(size, part))
            os.replace(part, self.path)
        self.read(size)


class Point:
    def __init__(self, cost, wall, cpu, relmse, trimmed, bias, coarse):
        self.cost, self.wall, self.cpu, self.relmse, self.trimmed = cost, wall, cpu, relmse, trimmed
        self.bias, self.coarse = bias, coarse


class Curve:
    def __init__(self, program, settings, points):
        self.program, self.settings, self.points = program, settings, points

    def summary(self):
        return ", ".join(f"{p.cost}: {p.wall:.2f}/{p.cpu:.2f} s {p.relmse:.2g}/{p.trimmed:.2g}" for p in self.points)


def point_of(cost, seconds, picture, reference):
    width, values = read_picture(picture)
    if width != reference.width or len(values) != len(reference.values):
        raise RuntimeError(f"{picture}: not of the reference's size")
    errors = sorted(pixel_errors(values, reference.values))
    kept = errors[:-max(len(errors) // 1000, 1)]
    # A lamp that is mirrored in a few pixels is noise for long, in blocks too: the worst twentieth of them is left out.
    coarse = sorted(pixel_errors(block_means(width, values, reference.blocks), reference.coarse))
    coarse = coarse[:max(len(coarse) * 19 // 20, 1)]
    bias = sum(values) / len(values) / reference.mean - 1
    least = 1e-9
    return Point(cost, *seconds, max(sum(errors) / len(errors) - reference.noise, least),
                 max(sum(kept) / len(kept) - reference.noise, least), bias, sum(coarse) / len(coarse))


def curve_of(runner, program, reference, scene, size, folder, use):
    """The errors of a program's pictures with 1, 2, 4, ... times its least work, until the limit or the last target.
    use: None: not kept between calls; cached: taken from the folder, where it was measured with these settings, and
    gone on with if the limit was shorter then; kept: taken from there, and nothing is measured."""
    os.makedirs(folder, exist_ok=True)
    file = os.path.join(folder, f"{scene.name}-{size}-{program.file_name()}.json")
    picture = file.replace(".json", program.ending)
    about = {"settings": program.settings, "size": size, "limit": runner.limit,
             "reference": os.path.basename(reference.path)}
    points = []
    if use in ("cached", "kept") and os.path.exists(file):
        with open(file) as f:
            kept = json.load(f)
        if all(kept[key] == about[key] for key in about if key != "limit"):
            points = [Point(**p) for p in kept["points"]]
    lowest = min(t.relmse for t in scene.targets)

    def is_whole():
        return points and (runner.seconds(points[-1]) * 2 > runner.limit * 1.05 or points[-1].relmse < 0.7 * lowest)

    if is_whole() or (points and use == "kept"):
        return Curve(program.name, program.settings, points)
    if use == "kept":
        raise RuntimeError("not measured")
    for attempt in range(2):  # the first compiles kernels and fills the file system's cache
        reading = runner.run_again_if_it_crashes(*program.command(program.first, 8, picture))
    while not is_whole():
        cost = points[-1].cost * 2 if points else program.first
        wall, cpu = runner.run_again_if_it_crashes(*program.command(cost, size, picture))
        seconds = max(wall - reading[0], 1e-4), max(cpu - reading[1], 1e-4)
        points.append(point_of(cost, seconds, picture, reference))
    curve = Curve(program.name, program.settings, points)
    with open(file + ".part", "w") as f:
        json.dump({**about, "points": [vars(p) for p in points]}, f, indent=1)
    os.replace(file + ".part", file)
    return curve


def seconds_to(curve, target, runner, trimmed):
    """('', seconds) by interpolation on logarithms; ('>', the last point's) if the error stays above the target; ('<',
    the first's) if it never is."""
    points = curve.points
    errors = [p.trimmed if trimmed else p.relmse for p in points]
    seconds = [runner.seconds(p) for p in points]
    if errors[-1] > target:
        return ">", seconds[-1]
    i = len(points) - 1
    while i > 0 and errors[i - 1] <= target:
        i -= 1
    if i == 0:
        return "<", seconds[0]
    share = math.log(errors[i - 1] / target) / math.log(errors[i - 1] / errors[i])
    return "", math.exp(math.log(seconds[i - 1]) * (1 - share) + math.log(seconds[i]) * share)


def write_curves(folder, curves, size, runner):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "curves.csv"), "w") as f:
        f.write("scene,size,program,settings,cost,wall_seconds,cpu_seconds,relmse,trimmed,bias,coarse\n")
        for scene, c in curves:
            for p in c.points:
                f.write(f'{scene},{size},{c.program},"{c.settings}",{p.cost},{p.wall:.4f},{p.cpu:.4f},{p.relmse:.4g},'
                        f"{p.trimmed:.4g},{p.bias:.4g},{p.coarse:.4g}\n")
    colours = ("#000000", "#2a7fff", "#c03030", "#309030", "#d08020", "#8040a0", "#208080", "#808080")
    for scene in dict.fromkeys(name for name, _ in curves):
        script = [f'set terminal svg size 720,480 font "sans,13" background "white"',
                  f'set output "{folder}/{scene}.svg"', "set logscale xy", 'set format x "%g"',
                  'set format y "10^{%T}"',
                  f'set xlabel "seconds ({runner.clock})"', 'set ylabel "relMSE"', "set grid",
                  f'set title "{scene.replace("_", " ")}, {size} x {size}, two threads"', "set key outside right top"]
        plots, data, colour_of = [], [], {}
        for name, c in curves:
            if name != scene:
                continue
            colour = colour_of.setdefault(c.program, colours[len(colour_of) % len(colours)])
            for column, dash in ((1, 1), (2, 3)):
                title = c.program if column == 1 and c.program not in [p[1] for p in plots] else ""
                plots.append((f"'-' using 1:2 with linespoints pt 7 ps 0.4 lw 1.5 dt {dash} lc rgb '{colour}' "
                              + (f'title "{title}"' if title else "notitle"), title))
                data += [f"{runner.seconds(p):g} {p.relmse if column == 1 else p.trimmed:g}" for p in c.points] + ["e"]
        script.append("plot " + ", ".join(p[0] for p in plots))
        try:
            subprocess.run(["gnuplot"], input="\n".join(script + data) + "\n", text=True, check=True)
        except (OSError, subprocess.CalledProcessError) as e:
            print(f"time_to_error.py: no plot of {scene}: {e}", file=sys.stderr)
