"""Measures how the error of each estimator falls with the number of samples, and plots it: docs/images/oracle.svg.

    python3 tools/oracle.py target/release/lucerna

Nothing but the program and Python's standard library is needed. It takes some minutes. Numbers go to standard output.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes" / "oracle.pbrt"
PLOT = ROOT / "docs" / "images" / "oracle.svg"
COUNTS = [1, 4, 16, 64, 256]
REFERENCE_SAMPLES = 8192

# Name, colour, dash, integrator as in a scene file, further options.
CURVES = [
    ("kajiya, uniform", "#b2182b", "6 3", '"kajiya" "string distribution" "uniform"', []),
    ("kajiya, cosine", "#ef8a62", "6 3", '"kajiya" "string distribution" "cosine"', []),
    ("kajiya, bsdf", "#a67c00", "6 3", '"kajiya" "string distribution" "bsdf"', []),
    ("path, bsdf", "#7b3294", "", '"path" "string strategy" "bsdf"', []),
    ("path, light", "#1b7837", "", '"path" "string strategy" "light"', []),
    ("path, mis", "#2166ac", "", '"path" "string strategy" "mis"', []),
    ("path, mis, zsobol", "#000000", "2 2", '"path" "string strategy" "mis"', ["--sampler", "zsobol"]),
]


def scene_with(integrator, directory):
    """The scene with another integrator."""
    text = SCENE.read_text()
    text, count = re.subn(r'Integrator "path"', f"Integrator {integrator}", text)
    assert count == 1
    path = pathlib.Path(directory) / "scene.pbrt"
    path.write_text(text)
    return path


def measure(program, directory):
    """The relative mean squared error of each curve at each count, over five seeds."""

    def run(*arguments):
        return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    def render(scene, output, samples, seed, options=()):
        run("render", scene, "-o", output, "--spp", samples, "--seed", seed, "--quiet", *options)

    reference = pathlib.Path(directory) / "reference.exr"
    render(SCENE, reference, REFERENCE_SAMPLES, 999, ["--sampler", "sobol"])
    picture = pathlib.Path(directory) / "picture.exr"
    results = {}
    for name, _, _, integrator, options in CURVES:
        scene = scene_with(integrator, directory)
        errors = []
        for samples in COUNTS:
            seeds = range(1, 6)
            total = 0.0
            for seed in seeds:
                render(scene, picture, samples, seed, options)
                total += json.loads(run("compare", picture, reference))["relmse"]
            errors.append(total / len(seeds))
        results[name] = errors
        slope = math.log(errors[-1] / errors[0]) / math.log(COUNTS[-1] / COUNTS[0])
        print(name, " ".join(f"{e:.3g}" for e in errors), f"slope {slope:.2f}", flush=True)
    return results


def plot(results):
    """An SVG file, logarithmic in both directions, with a line of slope -1 for comparison."""
    width, height, left, right, top, bottom = 640, 420, 62, 150, 16, 44
    values = [v for errors in results.values() for v in errors]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))

    def x(samples):
        return left + (width - left - right) * math.log(samples / COUNTS[0]) / math.log(COUNTS[-1] / COUNTS[0])

    def y(error):
        return top + (height - top - bottom) * (high - math.log10(error)) / (high - low)

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
        ' font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    for power in range(low, high + 1):
        at = y(10.0**power)
        out.append(f'<line x1="{left}" y1="{at:.1f}" x2="{width - right}" y2="{at:.1f}" stroke="#dddddd"/>')
        out.append(f'<text x="{left - 6}" y="{at + 4:.1f}" text-anchor="end">{10.0**power:g}</text>')
    for samples in COUNTS:
        at = x(samples)
        out.append(f'<line x1="{at:.1f}" y1="{top}" x2="{at:.1f}" y2="{height - bottom}" stroke="#dddddd"/>')
        out.append(f'<text x="{at:.1f}" y="{height - bottom + 16}" text-anchor="middle">{samples}</text>')
    middle = (left + width - right) / 2
    out.append(f'<text x="{middle:.0f}" y="{height - 8}" text-anchor="middle">samples a pixel</text>')
    out.append(f'<text transform="translate(14 {height / 2:.0f}) rotate(-90)" text-anchor="middle">relMSE</text>')
    # Labels keep apart by 14 units, from the top down.
    last = -math.inf
    for name, colour, dash, _, _ in sorted(CURVES, key=lambda curve: -results[curve[0]][-1]):
        errors = results[name]
        points = " ".join(f"{x(n):.1f},{y(e):.1f}" for n, e in zip(COUNTS, errors))
        style = f' stroke-dasharray="{dash}"' if dash else ""
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"{style}/>')
        last = max(y(errors[-1]) + 4, last + 14)
        out.append(f'<text x="{width - right + 8}" y="{last:.1f}" fill="{colour}">{name}</text>')
    out.append("</svg>\n")
    PLOT.write_text("\n".join(out))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as directory:
        plot(measure(str(pathlib.Path(sys.argv[1]).resolve()), directory))


main()
