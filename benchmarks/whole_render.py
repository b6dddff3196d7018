# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU time of whole renders by the command line renderer: reading, building, tracing and writing together.

benchmarks/whole_render.py [--renderer build/renderer] [--other OTHER_RENDERER] [--runs 5] [SCENE ...]

With --other, a renderer of another commit takes turns with the first, and the ratio is of paired runs.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "scenes/cbox_no_light_refract/scene.json"


def cpu_seconds(renderer: Path, scene: Path, threads: int) -> float:
    """User and system time of one render, all threads together."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "out.exr"
        command = [renderer, scene, "-o", output, "--threads", str(threads), "-q"]
        before = os.times()
        subprocess.run(command, check=True)
        after = os.times()
    return (after.children_user - before.children_user) + (
        after.children_system - before.children_system
    )


def machine() -> str:
    """The processor, as far as the system tells."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def commit() -> str:
    """The checked-out commit."""
    command = ["git", "-C", ROOT, "describe", "--always", "--dirty"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def main() -> int:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", nargs="*", type=Path, default=[SCENE])
    parser.add_argument("--renderer", type=Path, default=ROOT / "build/renderer")
    parser.add_argument("--other", type=Path, help="a second renderer to compare with")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()

    print(f"{machine()}, {arguments.threads} thread(s), commit {commit()}")
    for scene in arguments.scene:
        cpu_seconds(arguments.renderer, scene, arguments.threads)  # warms the disk's cache
        times, ratios = [], []
        for _ in range(arguments.runs):
            times.append(cpu_seconds(arguments.renderer, scene, arguments.threads))
            if arguments.other:
                other = cpu_seconds(arguments.other, scene, arguments.threads)
                ratios.append(other / times[-1])
        line = f"{scene.parent.name}/{scene.name}: median {statistics.median(times):.3f} s of CPU"
        line += f" (minimum {min(times):.3f}, {arguments.runs} runs)"
        if ratios:
            line += f"; the other takes {statistics.median(ratios):.2f} times as long"
        print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
