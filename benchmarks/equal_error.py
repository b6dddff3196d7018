# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU time that BasicRT and Cycles take to the same error, over .blend scenes.

benchmarks/equal_error.py [--samples 16,64,256] [--reference 2048] [--seeds 3] [--size 512] [--threads 2] [SCENE ...]

Runs in a Python that has bpy and basicrt. Every render is a process of its own, the engines in turn; its time is the
CPU time of all threads during the whole render call, so that export and building count too. Without denoising, clamping
or adaptive sampling. Errors are relMSE against the engine's own reference, which is checked against the other engine's.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
ENGINES = ("BASICRT", "CYCLES")

# Seeds of references: no measured render has them.
REFERENCE_SEEDS = (90001, 90002)

# What would change Cycles' expectation or spend its samples unevenly.
CYCLES_SETTINGS = {
    "device": "CPU",
    "use_animated_seed": False,
    "use_adaptive_sampling": False,
    "use_denoising": False,
    "time_limit": 0.0,
    "sample_clamp_direct": 0.0,
    "sample_clamp_indirect": 0.0,
    "blur_glossy": 0.0,
}

Picture = np.ndarray[Any, np.dtype[np.float64]]  # (height, width, 3)


@dataclass(frozen=True)
class Job:
    """One render."""

    blend: str
    engine: str
    samples: int
    seed: int
    size: int
    threads: int


@dataclass(frozen=True)
class Point:
    """The cost and the error of an engine at a number of samples."""

    samples: int
    seconds: float
    error: float


def work(job: Job, output: Path) -> None:
    """In a process of its own: render, and write the picture and the seconds."""
    import bpy  # type: ignore[import-not-found, unused-ignore]

    from basicrt import blender_addon  # type: ignore[attr-defined, unused-ignore]

    if job.engine == "BASICRT":
        blender_addon.register()
    bpy.ops.wm.open_mainfile(filepath=job.blend, load_ui=False)
    scene = bpy.context.scene
    render = scene.render
    render.engine = job.engine
    settings = scene.basicrt if job.engine == "BASICRT" else scene.cycles
    settings.samples, settings.seed = job.samples, job.seed
    if job.engine == "CYCLES":
        for name, value in CYCLES_SETTINGS.items():
            setattr(settings, name, value)
    render.threads_mode, render.threads = "FIXED", job.threads
    render.resolution_percentage = 100
    scale = job.size / max(render.resolution_x, render.resolution_y)
    render.resolution_x = max(1, round(render.resolution_x * scale))
    render.resolution_y = max(1, round(render.resolution_y * scale))
    image = render.image_settings
    if bpy.app.version >= (5, 0):
        image.media_type = "IMAGE"
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGBA", "32"
    render.use_file_extension = False
    render.filepath = str(output.with_suffix(".exr"))

    before = os.times()
    bpy.ops.render.render(write_still=True)
    after = os.times()
    loaded = bpy.data.images.load(render.filepath)
    loaded.colorspace_settings.name = "Non-Color"
    pixels = np.empty(loaded.size[0] * loaded.size[1] * loaded.channels, np.float32)
    loaded.pixels.foreach_get(pixels)
    shape = (loaded.size[1], loaded.size[0], loaded.channels)
    seconds = after.user - before.user + after.system - before.system
    np.savez(output, picture=pixels.reshape(shape)[..., :3], seconds=seconds)
    if job.engine == "BASICRT":
        blender_addon.unregister()  # Blender 4.2 crashes and 4.5 hangs at exit otherwise


def run(job: Job) -> tuple[Picture, float]:
    """The picture and its seconds."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "render.npz"
        command = [sys.executable, __file__, "--worker", json.dumps(vars(job)), str(output)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if not output.exists():
            raise SystemExit(f"{job}: no picture\n{done.stdout}{done.stderr}")
        with np.load(output) as result:
            return result["picture"].astype(np.float64), float(result["seconds"])


def relmse(picture: Picture, references: list[Picture]) -> float:
    """The mean squared error over squared reference values, with 0.01 added to these for the dark ones.

    The product of the differences from two references has the square of the true error as its expectation: their own
    noise, being independent, drops out.
    """
    first, second = references
    mean = (first + second) / 2
    return float(np.mean((picture - first) * (picture - second) / (mean**2 + 1e-2)))


def bias(references: dict[str, list[Picture]]) -> tuple[float, float]:
    """How the engines' mean brightness differs, in per cent, and the rms z score of 8 x 8 blocks' differences."""

    def blocks(picture: Picture) -> Picture:
        height, width = (n // 8 * 8 for n in picture.shape[:2])
        cut = picture[:height, :width].mean(axis=2)
        return cut.reshape(height // 8, 8, width // 8, 8).mean(axis=(1, 3))

    means, variances = [], []
    for engine in ENGINES:
        first, second = (blocks(picture) for picture in references[engine])
        means.append((first + second) / 2)
        variances.append(float(np.mean((first - second) ** 2)) / 4)
    ours, theirs = (float(mean.mean()) for mean in means)
    z = float(np.sqrt(np.mean((means[0] - means[1]) ** 2) / sum(variances)))
    return 100 * (ours / theirs - 1), z


def seconds_to(error: float, points: list[Point]) -> float:
    """By the curve through the points, straight in logarithms and beyond its ends too."""
    x = [math.log(point.error) for point in reversed(points)]
    y = [math.log(point.seconds) for point in reversed(points)]
    wanted = math.log(error)
    i = min(max(int(np.searchsorted(x, wanted)), 1), len(x) - 1)
    slope = (y[i] - y[i - 1]) / (x[i] - x[i - 1])
    return math.exp(y[i] + slope * (wanted - x[i]))


def measure(blend: Path, arguments: argparse.Namespace) -> float:
    """Prints what was found of one scene. Our time over Cycles', to the error of its most samples."""

    def job(engine: str, samples: int, seed: int) -> Job:
        return Job(str(blend), engine, samples, seed, arguments.size, arguments.threads)

    references = {
        engine: [run(job(engine, arguments.reference, seed))[0] for seed in REFERENCE_SEEDS]
        for engine in ENGINES
    }
    runs: dict[tuple[str, int], list[tuple[float, float]]] = {}
    for seed in range(1, arguments.seeds + 1):
        for samples in arguments.samples:
            for engine in ENGINES:
                picture, seconds = run(job(engine, samples, seed))
                found = (seconds, relmse(picture, references[engine]))
                runs.setdefault((engine, samples), []).append(found)
    points: dict[str, list[Point]] = {engine: [] for engine in ENGINES}
    for (engine, samples), found in sorted(runs.items()):
        seconds = float(np.median([s for s, _ in found]))
        points[engine].append(Point(samples, seconds, float(np.mean([e for _, e in found]))))

    last = points["CYCLES"][-1]
    ratio = seconds_to(last.error, points["BASICRT"]) / last.seconds
    brightness, z = bias(references)
    cells = [blend.stem]
    for engine in ENGINES:
        cells += [f"{p.seconds:.2f} s, {p.error:.2e}" for p in points[engine]]
    cells += [f"{ratio:.2f}", f"{brightness:+.2f} %", f"{z:.1f}"]
    print("| " + " | ".join(cells) + " |", flush=True)
    return ratio


def main() -> int:
    """Print a table of all scenes."""
    if sys.argv[1:2] == ["--worker"]:
        work(Job(**json.loads(sys.argv[2])), Path(sys.argv[3]))
        return 0
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", nargs="*", type=Path)
    parser.add_argument("--samples", type=lambda text: sorted(map(int, text.split(","))))
    parser.add_argument("--reference", type=int, default=2048, help="samples of each of two")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--size", type=int, default=512, help="of the longer side, pixels")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    arguments.samples = arguments.samples or [16, 64, 256]
    scenes = arguments.scene or sorted((ROOT / "scenes/blender").glob("*.blend"))
    if len(arguments.samples) < 2:
        parser.error("--samples: needs two numbers at least, for a curve")

    print(f"{platform.processor() or platform.machine()}, {arguments.threads} thread(s)")
    columns = [f"{engine} at {n}" for engine in ENGINES for n in arguments.samples]
    columns = ["scene", *columns, "ratio", "brighter", "z"]
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
    ratios = [measure(scene.resolve(), arguments) for scene in scenes]
    print(f"\nratio, geometric mean: {math.exp(float(np.mean(np.log(ratios)))):.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
