"""Measures relMSE at equal processor time: ways of choosing lights, samplers, colour modes, integrators, also on caustics. Prints the
tables of docs/measurements.md, or those named.

    python3 tools/equal_time.py target/release/lucerna [lights] [samplers] [colours] [integrators] [caustics]

Each configuration is rendered with the same number of samples on one thread, by five seeds; its error is scaled to the time of
the first one (error times time is what a Monte Carlo estimator keeps). Time is the median of three runs' processor time, less
that of a run with a single sample.
"""

import json
import math
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "scenes"
SEEDS = range(1, 6)


class Bench:
    """Runs the program on one scene at one resolution."""

    def __init__(self, program, scene, resolution, directory):
        self.program, self.scene, self.resolution, self.directory = program, scene, resolution, pathlib.Path(directory)

    def run(self, *arguments):
        """Standard output and the processor time that it took."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([self.program, *map(str, arguments)], check=True, capture_output=True, text=True)
        return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def render(self, output, samples, seed, options, scene=None):
        arguments = ["render", scene or self.scene, "-o", output, "--resolution", self.resolution, "--spp", samples]
        return self.run(*arguments, "--seed", seed, "--threads", 1, "--quiet", *options)[1]

    def table(self, title, samples, reference_samples, cases, reference_integrator=None):
        """`cases`: name, options, scene or None, whether it has a reference of its own (or the first one's)."""
        print(f"\n{title}\n\n| | samples in that time | relMSE at equal time | relative |\n|---|---|---|---|")
        reference = self.directory / "reference.exr"
        picture = self.directory / "picture.exr"
        base_time = base_error = None
        for i, (name, options, scene, own_reference) in enumerate(cases):
            if i == 0 or own_reference:
                others = options[: options.index("--sampler")]
                if reference_integrator:
                    others = ["--integrator", reference_integrator]
                self.render(reference, reference_samples, 999, [*others, "--sampler", "sobol"], scene)
            start = self.render(picture, 1, 0, options, scene)
            times = [self.render(picture, samples, 0, options, scene) - start for _ in range(3)]
            time = statistics.median(times)
            base_time = base_time or time
            errors = []
            for seed in SEEDS:
                self.render(picture, samples, seed, options, scene)
                errors.append(json.loads(self.run("compare", picture, reference)[0])["relmse"])
            error = statistics.mean(errors) * time / base_time
            base_error = base_error or error
            print(f"| {name} | {samples * base_time / time:.1f} | {error:.3g} | {error / base_error:.2f} |", flush=True)


    def compare(self, picture, reference):
        return json.loads(self.run("compare", picture, reference)[0])["relmse"]

    def caustics(self, title, references, cases):
        """`references`: integrator and samples, of two whose difference tells their noise. `cases`: integrator and samples."""
        print(f"\n{title}\n\n| | samples | seconds | relMSE | error times time |\n|---|---|---|---|---|")
        pair = [self.directory / f"reference-{seed}.exr" for seed in (998, 999)]
        for path, seed in zip(pair, (998, 999)):
            self.render(path, references[1], seed, ["--integrator", references[0], *DEPTH])
        noise = 0.5 * self.compare(*pair)
        picture = self.directory / "picture.exr"
        # What it takes to read the scene. Learning where caustics are counts.
        start = self.render(picture, 1, 0, ["--integrator", "path", "--max-depth", "1"])
        base = None
        for integrator, samples in cases:
            options = ["--integrator", integrator, *DEPTH]
            times, errors = [], []
            for seed in list(SEEDS)[:3]:
                times.append(self.render(picture, samples, seed, options) - start)
                errors.append(statistics.mean(self.compare(picture, path) for path in pair) - noise)
            time, error = statistics.median(times), statistics.mean(errors)
            base = base or time * error
            print(f"| {integrator} | {samples} | {time:.2f} | {error:.3g} | {time * error / base:.2g} |", flush=True)
        print(f"\nThe references' own relMSE, {noise:.2g}, is taken off.", flush=True)


DEPTH = ["--max-depth", "8"]


def pool_under_a_lamp(directory):
    """The pool with a lamp 12 degrees wide for the sun, which paths from the eye can meet: as much light from the same direction."""
    text = (SCENES / "pool.pbrt").read_text()
    sun = re.search(r'LightSource "distant" "point3 from" \[ (.*?) \] .*? "blackbody L" (\d+) "float scale" (\S+)\n', text)
    towards, temperature, irradiance = sun[1].split(), sun[2], float(sun[3])
    sine = math.sin(math.radians(6))
    center = [10 * float(x) / math.hypot(*map(float, towards)) for x in towards]
    lamp = f"""AttributeBegin
    AreaLightSource "diffuse" "blackbody L" {temperature} "float scale" {irradiance / (math.pi * sine * sine)}
    Translate {center[0]} {center[1]} {center[2]}
    Shape "sphere" "float radius" {10 * sine}
AttributeEnd
"""
    text = text.replace(sun[0], lamp).replace('"parts/', f'"{SCENES}/parts/')
    path = pathlib.Path(directory) / "pool-under-a-lamp.pbrt"
    path.write_text(text)
    return path


def with_light_sampler(name, directory):
    """The scene of many lights, choosing them by `name`; next to the original, whose parts it includes."""
    text = (SCENES / "many-lights.pbrt").read_text()
    text, count = re.subn(r'"string lightsampler" "bvh"', f'"string lightsampler" "{name}"', text)
    assert count == 1
    text = text.replace('"parts/', f'"{SCENES}/parts/')
    path = pathlib.Path(directory) / f"many-lights-{name}.pbrt"
    path.write_text(text)
    return path


def cornell_box_with_glass(directory):
    """The Cornell box with a sphere of glass for the short block."""
    text = (SCENES / "cornell-box.pbrt").read_text()
    before, rest = text.split("# Short block.")
    sphere = """AttributeBegin
    Material "dielectric" "float eta" 1.5
    Translate 185 85 169
    Shape "sphere" "float radius" 85
AttributeEnd
"""
    path = pathlib.Path(directory) / "cornell-box-glass.pbrt"
    path.write_text(before + sphere + "# Tall block." + rest.split("# Tall block.")[1])
    return path


def lights(program, directory):
    bench = Bench(program, None, "96x54", directory)
    cases = [(name, ["--sampler", "sobol"], with_light_sampler(name, directory), False) for name in ["bvh", "power", "uniform"]]
    bench.table("Choice of lights, `many-lights`, 96 x 54 pixels", 16, 1024, cases)


def samplers(program, directory):
    box = Bench(program, SCENES / "cornell-box.pbrt", "64x64", directory)
    cases = [(name, ["--sampler", name], None, False) for name in ["sobol", "zsobol", "halton", "stratified", "independent"]]
    box.table("Samplers, `cornell-box`, 64 x 64 pixels", 64, 2048, cases)


def colours(program, directory):
    box = Bench(program, SCENES / "cornell-box.pbrt", "64x64", directory)
    cases = [(name, ["--color", name, "--sampler", "sobol"], None, True) for name in ["spectral", "rgb"]]
    box.table("Colour modes, `cornell-box`, 64 x 64 pixels, each against a reference of its own", 64, 2048, cases)


def integrators(program, directory):
    """Some light only `bdpt` finds: it has rendered all references."""
    glass = cornell_box_with_glass(directory)
    scenes = [SCENES / "cornell-box.pbrt", glass, SCENES / "glass-and-mirror.pbrt", SCENES / "indirect.pbrt", SCENES / "sky.pbrt"]
    for scene, reference_samples in zip(scenes, [1024, 1024, 1024, 1024, 512]):
        bench = Bench(program, scene, "64x64", directory)
        cases = [(name, ["--integrator", name, "--sampler", "zsobol"], None, False) for name in ["path", "lightpath", "bdpt"]]
        bench.table(f"Integrators, `{scene.stem}`, 64 x 64 pixels", 32, reference_samples, cases, "bdpt")


def caustics(program, directory):
    """Where light comes by way of mirrors and glass. What bdpt does not find in the pool path finds now and then."""
    small = [("path", 64), ("bdpt", 32), ("sppm", 64)]
    box = Bench(program, SCENES / "jensen-box.pbrt", "64x64", directory)
    box.caustics("`jensen-box`, 64 x 64 pixels", ("bdpt", 1024), [*small, ("photon", 16)])
    ring = Bench(program, SCENES / "ring.pbrt", "64x48", directory)
    ring.caustics("`ring`, 64 x 48 pixels", ("bdpt", 2048), small)
    pool = Bench(program, pool_under_a_lamp(directory), "64x48", directory)
    pool.caustics("`pool` under a lamp, 64 x 48 pixels", ("path", 4096), small)
    box = Bench(program, SCENES / "jensen-box.pbrt", "256x256", directory)
    box.caustics("`jensen-box`, 256 x 256 pixels", ("bdpt", 192), [("path", 32), ("sppm", 32), ("photon", 16)])


TABLES = {"lights": lights, "samplers": samplers, "colours": colours, "integrators": integrators, "caustics": caustics}


def main():
    names = sys.argv[2:] or list(TABLES)
    if len(sys.argv) < 2 or not set(names) <= set(TABLES):
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as directory:
        for name in names:
            TABLES[name](program, directory)


main()
