#!/usr/bin/env python3
"""Lucerna against Mitsuba 3, feature by feature.

Renders a grid of small scenes (scenes.py), each several times with both programs, in rgb and in spectral mode, and compares them by
a z-test: blocks of 4 x 4 pixels, the variances of both means from the renders themselves, 0.3 % of the value allowed for what the
two calculate differently (tables of spectra). A scene agrees if |z| of the picture's mean is below 4 or the means differ by less than
0.5 %, and at most 1 % of the blocks have |z| > 4.

    tools/peers/compare.py [--only SUBSTRING] [--mode rgb|spectral] [--seeds 6] [--spp 64] [--table FILE]

Mitsuba 3.9.1 is installed into tools/peers/venv unless LUCERNA_PEER_PYTHON names a Python that has it. LUCERNA is the program
(default target/release/lucerna)."""

import argparse
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def python_with_mitsuba():
    given = os.environ.get("LUCERNA_PEER_PYTHON")
    if given:
        return given
    venv = HERE / "venv"
    python = venv / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "mitsuba==3.9.1", "numpy"], check=True)
    return str(python)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="scenes whose name holds this")
    parser.add_argument("--mode", choices=["rgb", "spectral"], action="append")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--resolution", type=int, default=32)
    parser.add_argument("--work", default="/tmp/lucerna-peers", help="where scenes and pictures go")
    parser.add_argument("--table", help="write the table to this file, too")
    args = parser.parse_args()
    try:
        import mitsuba  # noqa: F401
    except ImportError:
        python = python_with_mitsuba()
        os.execv(python, [python, *sys.argv])
    from grid import run

    sys.exit(run(args, ROOT))


if __name__ == "__main__":
    main()
