# What time_to_error.py measures: scenes with their floors, photongrid's ways to draw them, and the other programs, each
# with the settings that were its best of those tried (docs/reference/validation.md).
import json
import os
import subprocess

from made_scenes import write_scene
from peer_scenes import Scene as ExportedScene, Unsupported, export, pbrt_film


class Target:
    """An error, and how many times as soon as the fastest other program (or one of them) photongrid should have it."""

    def __init__(self, relmse, times, rival=None, within=None):
        self.relmse, self.times, self.rival, self.within = relmse, times, rival, within


class Scene:
    """own_references: materials that programs model differently, so that each has its own converged picture."""

    def __init__(self, name, targets, reference, clear_glass=False, folder=None, made=False, own_references=False):
        self.name, self.targets, self.reference = name, targets, reference
        self.clear_glass, self.folder, self.made, self.own_references = clear_glass, folder, made, own_references

    def path(self, program, cache):
        """Its file, in photongrid's format; none if it is a scene of others that is not there."""
        if self.made:
            return write_scene(self.name, os.path.join(cache, "scenes"))
        here = f"examples/scenes/{self.name}.json"
        if not self.clear_glass and not self.folder:
            return here
        made = os.path.join(cache, "scenes", f"{self.name}.json")
        os.makedirs(os.path.dirname(made), exist_ok=True)
        if self.folder:
            theirs = os.path.join(os.environ.get("PHOTONGRID_SCENES", ""), self.folder)
            if not os.path.exists(theirs):
                return None
            subprocess.run([program, "convert", theirs, made], check=True, stdout=subprocess.DEVNULL)
            return made
        with open(here) as f:
            scene = json.load(f)
        for m in scene["materials"].values():
            if m["type"] == "glass":
                m["transmittance"] = [1, 1, 1]
        with open(made, "w") as f:
            json.dump(scene, f, indent=1)
        return made


SCENES = {s.name: s for s in (
    Scene("cornell_blocks", [Target(0.003, 10)], "--spp 2048"),
    Scene("cornell_box", [Target(0.005, 10), Target(0.001, 10, within=5)],
          "--spp 4096 --caustics bins --paths 100000000"),
    Scene("ring", [Target(0.01, 10)], "--spp 1024 --paths 100000000"),
    # SmallVCM's glass does not absorb, so nobody's does.
    Scene("glass_ball", [Target(0.01, 10)], "--spp 1024 --caustics bins --paths 100000000", clear_glass=True),
    Scene("water_caustic", [Target(0.02, 5, rival="Tungsten PPM")], "--spp 1024 --caustics bins --paths 100000000",
          folder="water-caustic/pbrt/scene-v4.pbrt"),
    Scene("satin_ring", [Target(0.03, 1), Target(0.01, 1)], "--spp 4096 --caustics bins --paths 100000000", made=True),
    Scene("coffee_maker", [Target(0.03, 1), Target(0.01, 1)], "--spp 1024 --caustics bins --paths 20000000", made=True,
          own_references=True),
)}

# Options of `photongrid render`: --passes is what grows. Beside them numbers that the renderer chooses.
NUMBERS = ("photons", "caustic-photons", "k", "caustic-k", "light-samples", "spp", "max-radius")
AUTOMATIC_OPTIONS = tuple("--" + name for name in (*NUMBERS, "map", "grid"))
AUTOMATIC = " ".join(f"{option} auto" for option in AUTOMATIC_OPTIONS)
WAYS = {
    "cornell_blocks": [
        "--spp 1 --k 200 --photons 65000 --light-samples 2",
        "--spp 2 --k 200 --photons 65000",
        "--spp 8 --k 50 --photons 250000 --radii per_pass",
        "--spp 4 --k 50 --radii shrinking",
        "--spp 16 --k 50 --radii shrinking --photons 250000",
        "--spp 16 --k 200 --photons 250000 --radii per_pass",
        "--spp 16 --k 50 --indirect gather --gather-rays 1 --light-samples 2 --radii per_pass",
        "--spp 4 --k 50 --indirect gather --gather-rays 4 --radii per_pass",
        "--spp 1 --k 50 --indirect gather --radii shrinking",
    ],
    "cornell_box": [
        "--spp 1 --k 400 --photons 130000 --caustic-photons 40000 --caustic-k 50 --light-samples 4",
        "--spp 1 --k 200 --photons 65000 --caustic-photons 32000 --caustic-k 40 --light-samples 2",
        "--spp 1 --k 200 --photons 65000 --caustic-photons 16000 --caustic-k 30 --light-samples 2",
        "--spp 1 --k 200 --photons 65000 --caustic-photons 32000 --caustic-k 30",
        "--spp 4 --k 50 --radii shrinking --photons 65000 --caustic-photons 65000 --caustic-k 30",
        "--spp 16 --k 50 --radii shrinking --photons 250000 --caustic-photons 100000 --caustic-k 30",
        "--spp 16 --k 50 --radii shrinking --photons 250000",
        "--spp 4 --k 50 --radii shrinking",
        "--spp 4 --k 50 --radii shrinking --photons 250000",
        "--spp 16 --k 20 --radii shrinking --photons 250000",
        "--spp 16 --k 50 --radii shrinking --photons 250000 --indirect gather --gather-rays 1",
        "--spp 1 --k 50 --radii shrinking",
    ],
    "ring": [
        "--spp 1 --k 30 --photons 2000 --caustic-photons 200000 --caustic-k 20",
        "--spp 4 --k 30 --radii shrinking --photons 2000 --caustic-photons 100000 --caustic-k 50",
        "--spp 4 --k 30 --radii shrinking --photons 2000 --caustic-photons 300000 --caustic-k 50",
        "--spp 4 --k 50 --radii shrinking --photons 100000",
        "--spp 16 --k 50 --radii shrinking --photons 100000",
        "--spp 4 --k 20 --radii shrinking --photons 100000",
        "--spp 1 --k 50 --radii shrinking",
    ],
    "glass_ball": [
        "--spp 1 --k 100 --photons 10000 --caustic-photons 60000 --caustic-k 30",
        "--spp 4 --k 30 --radii shrinking --photons 5000 --caustic-photons 60000 --caustic-k 30",
        "--spp 16 --k 30 --radii shrinking --photons 10000 --caustic-photons 200000 --caustic-k 30",
        "--spp 4 --k 50 --radii shrinking --photons 50000",
        "--spp 16 --k 50 --radii shrinking --photons 50000",
        "--spp 4 --k 20 --radii shrinking --photons 50000",
        "--spp 1 --k 50 --radii shrinking",
    ],
    "water_caustic": [
        "--spp 1 --k 50 --photons 10000 --caustic-photons 1000000 --caustic-k 30",
        "--spp 4 --k 50 --radii shrinking --photons 10000 --caustic-photons 1000000 --caustic-k 50",
        "--spp 4 --k 50 --radii shrinking --photons 1000000",
        "--spp 1 --k 50 --radii shrinking --photons 250000",
        "--spp 16 --k 20 --radii shrinking --photons 1000000",
    ],
    "satin_ring": ["--spp 1 --k 100 --photons 16000"],
    "coffee_maker": ["--spp 1 --k 100 --photons 16000"],
}


def photongrid_ways(scene, which):
    return [AUTOMATIC] + {"automatic": [], "best": WAYS[scene][:1]}.get(which, WAYS[scene])


class Photongrid:
    first, ending = 1, ".pfm"

    def __init__(self, program, path, way, backend):
        self.program, self.path, self.settings, self.backend = program, path, way, backend
        self.name = f"photongrid {backend}"

    def file_name(self):
        return "photongrid-" + self.backend

    def command(self, passes, size, picture):
        words = self.settings.split()
        if size <= 8:  # that what is subtracted has neither photons nor a pilot in it
            for name in NUMBERS:
                if "--" + name in words:
                    at = words.index("--" + name)
                    del words[at:at + 2]
            words += ["--photons", "100", "--caustic-photons", "0", "--k", "10", "--caustic-k", "10", "--spp", "1",
                      "--light-samples", "1", "--max-radius", "0.1", "--emission", "power"]
        return ([self.program, "render", self.path, "--backend", self.backend, "--size", f"{size}x{size}", "--quiet",
                 "--passes", str(passes), *words, "-o", picture], {"NODEVICE_SELECT": "1"})


# The executables of other programs, in the folder that the caller names.
PROGRAMS = {"tungsten": "Tungsten", "pbrt": "pbrt-v3", "smallvcm": "SmallVCM"}


def is_program(folder, name):
    path = os.path.join(folder, name)
    return os.path.isfile(path) and os.access(path, os.X_OK)


class Peer:
    """Another program with settings for a scene. `missing` says why it does not draw it, if it does not."""
    executable = ""
    first, ending = 1, ".pfm"

    def __init__(self, kind, folder, scene, path, cache, settings):
        self.kind, self.binary = kind, os.path.join(folder, self.executable)
        self.name, self.scene, self.path = f"{PROGRAMS[self.executable]} {kind.upper()}", scene, path
        self.settings, self.missing = " ".join(f"{k}={v}" for k, v in settings.items()), ""
        self.values = settings
        self.folder = os.path.join(cache, "scenes", f"{self.executable}-{scene.name}")
        self.exported = set()
        try:
            self.depth = ExportedScene(path).photon_depth
            self.export(8)
        except Unsupported as e:
            self.missing = f"it does not draw {e}"

    def file_name(self):
        return f"{self.name} {self.settings}".replace(" ", "-")

    def export(self, size):
        folder = f"{self.folder}-{size}"
        if size not in self.exported:
            export(self.executable, self.path, folder, size)
            self.exported.add(size)
        return folder


class Tungsten(Peer):
    executable = "tungsten"

    def command(self, cost, size, picture):
        folder = self.export(size)
        with open(os.path.join(folder, "scene.json")) as f:
            scene = json.load(f)
        v = self.values
        integrator = {"min_bounces": 0, "max_bounces": v.get("bounces", self.depth), "enable_two_sided_shading": True}
        if self.kind == "ppm":
            integrator.update(type="progressive_photon_map", photon_count=v["photons"] if size > 8 else 1000,
                              gather_photon_count=v["nearest"], gather_radius=v["radius"], alpha=v["alpha"])
        else:
            integrator.update(type="bidirectional_path_tracer")
        scene["integrator"] = integrator
        # Its photon mapper makes a pass of each step.
        scene["renderer"] = {"spp": cost, "spp_step": 1 if self.kind == "ppm" else cost, "adaptive_sampling": False,
                             "stratified_sampler": True, "scene_bvh": True, "overwrite_output_files": True,
                             "hdr_output_file": os.path.abspath(picture)}
        run = os.path.join(folder, f"run-{self.kind}.json")
        with open(run, "w") as f:
            json.dump(scene, f)
        # Its photon mapper crashes (signal 11) now and then, most often at addresses that the system draws at random.
        return ["setarch", "-R", self.binary, "-t", "2", run], None


class Pbrt(Peer):
    executable = "pbrt"

    def command(self, cost, size, picture):
        folder, v = self.export(size), self.values
        depth = v.get("depth", self.depth)
        if self.kind == "sppm":
            drawn = f'Integrator "sppm" "integer numiterations" [ {cost} ] "integer maxdepth" [ {depth} ] '
            photons = v["photons"] if size > 8 else 64
            drawn += f'"float radius" [ {v["radius"]} ] "integer photonsperiteration" [ {photons} ]\nSampler "halton"'
        else:
            drawn = f'Integrator "bdpt" "integer maxdepth" [ {depth} ]\n'
            drawn += f'Sampler "halton" "integer pixelsamples" [ {cost} ]'
        run = os.path.join(folder, f"run-{self.kind}.pbrt")
        with open(run, "w") as f:
            f.write(f'{pbrt_film(size, picture)}{drawn}\nInclude "camera.pbrt"\nInclude "world.pbrt"\n')
        return [self.binary, "--nthreads=2", "--quiet", run], None

    def reference(self, size, picture):
        """The command of a converged picture."""
        kind, self.kind = self.kind, "bdpt"
        try:
            return self.command(1024, size, picture)
        finally:
            self.kind = kind


class SmallVcm(Peer):
    executable = "smallvcm"
    first, ending = 2, ".hdr"  # each thread makes passes of its own

    def command(self, cost, size, picture):
        v = self.values
        return ([self.binary, "-a", self.kind, "-i", str(cost), "-o", os.path.abspath(picture)],
                {"PHOTONGRID_SCENE": os.path.join(self.export(size), "scene.txt"), "PHOTONGRID_SIZE": str(size),
                 "PHOTONGRID_DEPTH": str(v.get("depth", self.depth + 1)), "PHOTONGRID_RADIUS": str(v["radius"]),
                 "PHOTONGRID_ALPHA": str(v["alpha"])})


# Radii of Tungsten and pbrt are in metres; SmallVCM's are parts of the scene's radius.
PEERS = {
    "cornell_blocks": [(Tungsten, "ppm", dict(photons=250000, nearest=1000, radius=0.01, alpha=0.7)),
                       (Tungsten, "bdpt", dict(bounces=16)),
                       (Pbrt, "sppm", dict(photons=250000, radius=0.01)), (Pbrt, "bdpt", dict(depth=12))],
    "cornell_box": [(Tungsten, "ppm", dict(photons=250000, nearest=1000, radius=0.01, alpha=0.7)),
                    (Tungsten, "bdpt", dict(bounces=16)),
                    (Pbrt, "sppm", dict(photons=250000, radius=0.01)), (Pbrt, "bdpt", dict(depth=12))],
    "ring": [(Tungsten, "ppm", dict(photons=250000, nearest=1000, radius=0.005, alpha=0.7)),
             (Tungsten, "bdpt", dict(bounces=16)),
             (Pbrt, "sppm", dict(photons=250000, radius=0.005)), (Pbrt, "bdpt", dict(depth=10))],
    "glass_ball": [(Tungsten, "ppm", dict(photons=250000, nearest=1000, radius=0.005, alpha=0.7)),
                   (Tungsten, "bdpt", dict(bounces=16)),
                   (Pbrt, "sppm", dict(photons=250000, radius=0.005)), (Pbrt, "bdpt", dict(depth=10))],
    "water_caustic": [(Tungsten, "ppm", dict(photons=5000000, nearest=20, radius=0.05, alpha=0.3)),  # its author's
                      (Tungsten, "bdpt", dict(bounces=16)),
                      (Pbrt, "sppm", dict(photons=1000000, radius=0.01))],
    "satin_ring": [(Pbrt, "sppm", dict(photons=16384, radius=0.03, depth=16)),
                   (Pbrt, "sppm", dict(photons=65536, radius=0.02, depth=16)), (Pbrt, "bdpt", dict(depth=16))],
    "coffee_maker": [(Pbrt, "sppm", dict(photons=16384, radius=0.03, depth=16)),
                     (Pbrt, "sppm", dict(photons=65536, radius=0.02, depth=16)), (Pbrt, "bdpt", dict(depth=16))],
}
for _scene in (name for name in PEERS if not SCENES[name].made):  # SmallVCM has no rough surfaces
    # Its author's radius, and one that suits fewer paths.
    PEERS[_scene] += [(SmallVcm, kind, dict(radius=radius, alpha=0.75))
                      for kind, radius in (("ppm", 0.003), ("ppm", 0.01), ("bpm", 0.003), ("bpm", 0.01),
                                           ("vcm", 0.003))]


def peers_of(folder, scene, path, size, cache):
    """The programs that the folder has, with their settings for a scene."""
    return [program(kind, folder, scene, path, cache, settings) for program, kind, settings in PEERS[scene.name]
            if is_program(folder, program.executable)]
