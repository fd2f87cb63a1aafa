#!/usr/bin/env python3
"""Measures this machine by `lucerna bench` and writes docs/rates.md and docs/rates.html.

    tools/bench_table.py [-o DIR] [--from REPORT.json] [ARGUMENTS OF lucerna bench]

Without arguments: the worlds below, one thread. Takes some ten minutes of a machine without other work. With --from, the tables are made from a
report that `lucerna bench --json` wrote.
"""

import argparse
import json
import math
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORLDS = "terrain:50k spheres:50k soup:50k hair:50k slivers:100k soup:500k terrain:1M spheres:1M terrain:10M instances:10M".split()
SCENES = "cornell-box glass-and-mirror instances materials".split()
# Rates over those of Embree's fast mode by its call for single rays, builds of high quality, one thread: what its best calls have on a machine
# with AVX2.
GOALS = {"camera": 2.0, "shadow": 1.4, "bounce": 1.1}


def mean(values):
    values = [value for value in values if value]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def best(stream, family, quality="high", way=None):
    """The fastest of a family, or one way of it, on the fewest threads."""
    threads = min(result["threads"] for result in stream["results"])
    rates = [
        result["mrays"]
        for result in stream["results"]
        if result["family"] == family
        and result["quality"] == quality
        and result["threads"] == threads
        and (way is None or result["way"] == way)
    ]
    return max(rates, default=None)


def kinds(report):
    order = ["camera", "bounce 1", "bounce 2", "bounce 3+", "shadow", "photon"]
    there = {stream["kind"] for case in report["cases"] for stream in case["streams"]}
    return [kind for kind in order if kind in there]


def ratio(case, kind, family, way=None):
    """Our rate, as renders have it, over that of a family by its best way or by one."""
    for stream in case["streams"]:
        if stream["kind"] == kind:
            ours, theirs = best(stream, "bvh", way="as renders do"), best(stream, family, way=way)
            return ours / theirs if ours and theirs else None
    return None


def table(head, rows):
    yield "| " + " | ".join(head) + " |"
    yield "|" + "---|" * len(head)
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def number(value, digits=2):
    return "" if value is None else f"{value:.{digits}f}"


def is_goal(case):
    """The goals are about scenes of 50 thousand to 10 million triangles."""
    return 5e4 <= case["instanced_primitives"] * 1.01 <= 1.1e7


def ratios(report):
    all_kinds = kinds(report)
    rows = []
    for case in report["cases"]:
        cells = [(ratio(case, kind, "embree-fast"), ratio(case, kind, "embree-robust")) for kind in all_kinds]
        rows.append([case["name"]] + [f"{number(fast)} ({number(robust)})" if fast else "" for fast, robust in cells])
    large = [case for case in report["cases"] if is_goal(case)]
    for name, cases in [("geometric mean", report["cases"]), ("of 50 thousand to 10 million", large)]:
        if not cases:
            continue
        means = [[mean(ratio(case, kind, f) for case in cases) for f in ("embree-fast", "embree-robust")] for kind in all_kinds]
        rows.append([f"**{name}**"] + [f"**{number(fast)}** ({number(robust)})" for fast, robust in means])
    yield from table(["World"] + all_kinds, rows)
    yield ""
    for goal, least in GOALS.items():
        of_goal = [kind for kind in all_kinds if kind.startswith(goal)]
        got = mean(ratio(case, kind, "embree-fast", "single") for case in large for kind in of_goal)
        if got:
            best_call = got / mean(ratio(case, kind, "embree-fast") for case in large for kind in of_goal)
            yield (
                f"- {goal} rays: {got:.2f} of Embree's fast mode by its call for single rays, where its best call has {best_call:.2f}; "
                f"the goal is {least}: {'met' if got >= least else 'not met'}."
            )


def builds(report):
    rows = []
    for case in report["cases"]:
        row = [case["name"]]
        for quality in ("low", "medium", "high"):
            by_family = {b["family"]: b for b in case["builds"] if b["quality"] == quality}
            ours, theirs = by_family.get("bvh"), by_family.get("embree-fast")
            speeds = [mean(best(stream, family, quality, "as renders do") for stream in case["streams"]) for family in ("bvh", "embree-fast")]
            row.append(
                f"{ours['seconds']:.3f} s, {ours['bytes_per_primitive']:.0f} B, {number(speeds[0])}; "
                f"{theirs['seconds']:.3f} s, {theirs['bytes_per_primitive']:.0f} B, {number(speeds[1])}"
                if ours and theirs
                else ""
            )
        rows.append(row)
    yield from table(["World", "low", "medium", "high"], rows)


def ways(report):
    """What packets gain over single rays, for each kind of ray: the mean over the worlds of the best of each sort."""
    sorts = [
        ("embree-fast", "single", lambda way: way == "single"),
        ("embree-fast", "packets of 4, 8, 16", lambda way: " wide" in way),
        ("embree-fast", "streams", lambda way: way.startswith("stream")),
        ("bvh", "single", lambda way: way.endswith("single") and not way.startswith("portable")),
        ("bvh", "packets", lambda way: way.endswith("packets")),
        ("bvh", "interleaved", lambda way: way.endswith("interleaved")),
        ("bvh", "as renders do", lambda way: way == "as renders do"),
    ]
    rows = []
    for family, name, wanted in sorts:
        row = [f"{family}, {name}"]
        for kind in kinds(report):
            gains = []
            for case in report["cases"]:
                for stream in case["streams"]:
                    if stream["kind"] != kind:
                        continue
                    mine = [r for r in stream["results"] if r["family"] == family and r["quality"] == "high"]
                    single = max((r["mrays"] for r in mine if sorts[0][2](r["way"]) or sorts[3][2](r["way"])), default=None)
                    this = max((r["mrays"] for r in mine if wanted(r["way"])), default=None)
                    gains.append(this / single if this and single else None)
            row.append(number(mean(gains)))
        rows.append(row)
    yield from table(["Over single rays of the same"] + kinds(report), rows)


def page(report):
    m = report["machine"]
    yield "# Rates of this machine"
    yield ""
    yield f"Written by `tools/bench_table.py`; plots are in [rates.html](rates.html). {m['processor']}, {m['processors']} processors, Linux {m['system']}; "
    yield f"lucerna {m['version']} ({m['compiler']}), Embree {m['embree']}; {report['turns']} turns, seed {report['seed']}, load {m['load']} at the start; one thread."
    yield ""
    yield "What a render gets from Lucerna's BVH over the fastest of Embree's calls in its fast mode (in its robust mode), builds of high quality:"
    yield ""
    yield from ratios(report)
    yield ""
    yield "Time, bytes a primitive (those of a group once), millions of rays a second (the mean over the kinds of ray), of Lucerna's BVH; of Embree, fast:"
    yield ""
    yield from builds(report)
    yield ""
    yield "What packets, streams and several rays at a time gain over single rays, builds of high quality:"
    yield ""
    yield from ways(report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "docs")
    parser.add_argument("--from", dest="report", type=pathlib.Path)
    args, rest = parser.parse_known_args()
    if args.report is None:
        args.report = args.output / "rates.json"
        if not rest:
            rest = [str(ROOT / "scenes" / f"{name}.pbrt") for name in SCENES]
            rest += [word for world in WORLDS for word in ("--synthetic", world)]
            rest += ["--count", "30000", "--turns", "5"]
        command = [ROOT / "target/release/lucerna", "bench", *rest, "--json", args.report, "--html", args.output / "rates.html"]
        subprocess.run(command, check=True)
    report = json.loads(args.report.read_text())
    (args.output / "rates.md").write_text("\n".join(page(report)) + "\n")


if __name__ == "__main__":
    main()
