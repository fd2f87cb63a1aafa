"""Measures relMSE at equal processor time beside LuxCore, on one scene for both. Prints a table of docs/measurements.md.

    python3 -m venv /tmp/lux && /tmp/lux/bin/pip install pyluxcore
    /tmp/lux/bin/python tools/against_luxcore.py target/release/lucerna

The scene is a Cornell box in linear RGB: matte walls, a lamp in the ceiling, a matte block, a sphere of glass or a matte one. Both
render it with the same camera and a box filter on one thread. Each is compared with its own reference, so that what one cuts off
and the other does not is not held against either. Error times time is what a Monte Carlo estimator keeps; it is scaled to
the time of the first row. Time is processor time less that of a render with a sample or two.
"""

import json
import math
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

SIZE = 64
SEEDS = range(1, 6)
SAMPLES = 16
REFERENCE_SAMPLES = 512
WHITE, RED, GREEN = (0.73, 0.73, 0.73), (0.65, 0.05, 0.05), (0.12, 0.45, 0.15)
LAMP = (0.9, 0.7, 0.4)
LAMP_SCALE = 20
EYE, TARGET, FOV = (278, 273, -800), (278, 273, 0), 39.30765
BALL_CENTER, BALL_RADIUS, BALL_RINGS = (185, 86, 170), 85, 32
# By the right-hand rule the lamp's normal points down.
LAMP_QUAD = [(343, 548.7, 227), (343, 548.7, 332), (213, 548.7, 332), (213, 548.7, 227)]
QUADS = [
    (WHITE, [(556, 0, 0), (0, 0, 0), (0, 0, 559.2), (556, 0, 559.2)]),
    (WHITE, [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]),
    (WHITE, [(556, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    (GREEN, [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    (RED, [(556, 0, 0), (556, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
    (WHITE, [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)]),
    (WHITE, [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)]),
    (WHITE, [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)]),
    (WHITE, [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)]),
    (WHITE, [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)]),
]


def ball():
    """Vertices, normals and triangles of the sphere, the same for both."""
    normals = []
    for ring in range(BALL_RINGS + 1):
        theta = math.pi * ring / BALL_RINGS
        for i in range(2 * BALL_RINGS + 1):
            phi = math.pi * i / BALL_RINGS
            normals.append((math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi)))
    vertices = [tuple(c + BALL_RADIUS * n for c, n in zip(BALL_CENTER, normal)) for normal in normals]
    faces = []
    for ring in range(BALL_RINGS):
        for i in range(2 * BALL_RINGS):
            a = ring * (2 * BALL_RINGS + 1) + i
            b, c, d = a + 1, a + 2 * BALL_RINGS + 1, a + 2 * BALL_RINGS + 2
            faces += [(a, b, d)] if ring else []
            faces += [(a, d, c)] if ring < BALL_RINGS - 1 else []
    return vertices, normals, faces


def words(values):
    return " ".join(f"{value:.7g}" for value in values)


def processor_time(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


class Lucerna:
    """Our program."""

    name = "lucerna"

    def __init__(self, program, directory):
        self.program, self.directory = program, pathlib.Path(directory)

    def scene(self, glass):
        quad = '    Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ {} ]\n'
        text = f"""Scale -1 1 1
LookAt {words(EYE)}  {words(TARGET)}  0 1 0
Camera "perspective" "float fov" {FOV}
Film "rgb" "integer xresolution" {SIZE} "integer yresolution" {SIZE}
PixelFilter "box"
Integrator "bdpt" "integer maxdepth" 32
WorldBegin
AttributeBegin
    Material "diffuse" "rgb reflectance" [ {words(WHITE)} ]
    AreaLightSource "diffuse" "rgb L" [ {words(LAMP)} ] "float scale" {LAMP_SCALE}
"""
        text += quad.format("  ".join(map(words, LAMP_QUAD))) + "AttributeEnd\n"
        for colour, corners in QUADS:
            text += f'Material "diffuse" "rgb reflectance" [ {words(colour)} ]\n'
            text += quad.format("  ".join(map(words, corners)))
        material = '"dielectric" "float eta" 1.5' if glass else f'"diffuse" "rgb reflectance" [ {words(WHITE)} ]'
        vertices, normals, faces = (" ".join(map(words, part)) for part in ball())
        text += f'Material {material}\nShape "trianglemesh" "integer indices" [ {faces} ]\n'
        text += f'"point3 P" [ {vertices} ]\n"normal N" [ {normals} ]\n'
        path = self.directory / f"lucerna-{glass}.pbrt"
        path.write_text(text)
        return path

    def render(self, scene, output, integrator, samples, seed):
        arguments = [self.program, "render", scene, "-o", output, "--spp", samples, "--seed", seed, "--color", "rgb"]
        arguments += ["--integrator", integrator, "--threads", 1, "--quiet"]
        before = processor_time(resource.RUSAGE_CHILDREN)
        subprocess.run([*map(str, arguments)], check=True, capture_output=True)
        return processor_time(resource.RUSAGE_CHILDREN) - before


class LuxCore:
    """The peer, in a process of its own for each render, as ours is."""

    name = "luxcore"
    engines = {"path": "PATHCPU", "bdpt": "BIDIRCPU"}

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)

    def scene(self, glass):
        lines = [
            "scene.camera.type = perspective",
            f"scene.camera.lookat.orig = {words(EYE)}",
            f"scene.camera.lookat.target = {words(TARGET)}",
            "scene.camera.up = 0 1 0",
            f"scene.camera.fieldofview = {FOV}",
        ]
        lines += [
            "scene.materials.lamp.type = matte",
            f"scene.materials.lamp.kd = {words(WHITE)}",
            f"scene.materials.lamp.emission = {words(LAMP_SCALE * value for value in LAMP)}",
        ]
        names = {WHITE: "white", RED: "red", GREEN: "green"}
        for colour, name in names.items():
            lines += [f"scene.materials.{name}.type = matte", f"scene.materials.{name}.kd = {words(colour)}"]
        if glass:
            lines += ["scene.materials.ball.type = glass", "scene.materials.ball.kr = 1 1 1", "scene.materials.ball.kt = 1 1 1"]
            lines += ["scene.materials.ball.interiorior = 1.5"]
        else:
            lines += ["scene.materials.ball.type = matte", f"scene.materials.ball.kd = {words(WHITE)}"]

        def shape(name, material, vertices, faces):
            lines.extend(
                [
                    f"scene.objects.{name}.material = {material}",
                    f"scene.objects.{name}.vertices = {' '.join(map(words, vertices))}",
                    f"scene.objects.{name}.faces = {' '.join(map(words, faces))}",
                ]
            )

        quad = [(0, 1, 2), (0, 2, 3)]
        shape("lamp", "lamp", LAMP_QUAD, quad)
        for i, (colour, corners) in enumerate(QUADS):
            shape(f"quad{i}", names[colour], corners, quad)
        vertices, normals, faces = ball()
        shape("ball", "ball", vertices, faces)
        lines.append(f"scene.objects.ball.normals = {' '.join(map(words, normals))}")
        path = self.directory / f"luxcore-{glass}.txt"
        path.write_text("\n".join(lines) + "\n")
        return path

    def render(self, scene, output, integrator, samples, seed):
        done = subprocess.run(
            [sys.executable, __file__, "--luxcore", scene, output, self.engines[integrator], str(samples), str(seed)],
            check=True,
            capture_output=True,
            text=True,
        )
        return float(re.search(r"processor time: (\S+)", done.stdout)[1])


def luxcore_process(scene_path, output, engine, samples, seed):
    """What [`LuxCore.render`] starts: prints the processor time of the render proper."""
    import pyluxcore

    pyluxcore.Init(lambda message: None)
    scene = pyluxcore.Scene()
    scene.Parse(pyluxcore.Properties(scene_path))
    config = pyluxcore.Properties()
    for line in [
        f"renderengine.type = {engine}",
        "native.threads.count = 1",
        f"renderengine.seed = {seed}",
        "sampler.type = SOBOL",
        "film.filter.type = NONE",
        f"film.width = {SIZE}",
        f"film.height = {SIZE}",
        "film.outputs.0.type = RGB",
        "film.outputs.0.filename = unused.exr",
        "film.imagepipelines.0.0.type = NOP",
        "path.pathdepth.total = 33",
        "path.pathdepth.diffuse = 33",
        "path.pathdepth.glossy = 33",
        "path.pathdepth.specular = 33",
        "path.maxdepth = 16",
        "light.maxdepth = 16",
        f"batch.haltspp = {samples}",
    ]:
        config.SetFromString(line)
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(config, scene))
    before = processor_time(resource.RUSAGE_SELF)
    session.Start()
    while not session.HasDone():
        session.WaitNewFrame()
        session.UpdateStats()
    session.UpdateStats()
    time = processor_time(resource.RUSAGE_SELF) - before
    done = session.GetStats().Get("stats.renderengine.pass").GetInt()
    session.Stop()
    session.GetFilm().SaveOutput(output, pyluxcore.FilmOutputType.RGB, pyluxcore.Properties())
    print(f"processor time: {time}\npasses: {done}", flush=True)
    # Its threads do not survive Python's own end.
    os._exit(0)


def relmse(program, picture, reference):
    done = subprocess.run([program, "compare", picture, reference], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["relmse"]


def table(program, renderers, glass, directory):
    """A row for each renderer and integrator."""
    print(f"\n{'A sphere of glass' if glass else 'A matte sphere'}\n")
    print("| | processor time a sample of each pixel, ms | relMSE at equal time | relative |\n|---|---|---|---|")
    base = None
    for renderer in renderers:
        scene = renderer.scene(glass)
        reference, picture = (directory / f"{name}.exr" for name in ["reference", "picture"])
        renderer.render(scene, reference, "bdpt", REFERENCE_SAMPLES, 999)
        for integrator in ["path", "bdpt"]:
            few, many = (
                statistics.median(renderer.render(scene, picture, integrator, samples, 1) for _ in range(3))
                for samples in [2, SAMPLES]
            )
            time = (many - few) / (SAMPLES - 2)
            errors = []
            for seed in SEEDS:
                renderer.render(scene, picture, integrator, SAMPLES, seed)
                errors.append(relmse(program, picture, reference))
            error = statistics.mean(errors) * time
            base = base or (time, error)
            print(
                f"| {renderer.name} {integrator} | {1000 * time:.1f} | {error / base[0]:.3g} | {error / base[1]:.2f} |",
                flush=True,
            )


def main():
    if sys.argv[1:2] == ["--luxcore"]:
        scene, output, engine, samples, seed = sys.argv[2:]
        luxcore_process(scene, output, engine, int(samples), int(seed))
        return
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        renderers = [Lucerna(program, directory), LuxCore(directory)]
        for glass in [False, True]:
            table(program, renderers, glass, directory)


main()
