# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise and CPU time of scenes with one light, a few and many, by the Python module.

benchmarks/many_lights.py --references FOLDER [--samples 64] [--runs 3] [SCENE ...]

References (many samples, another seed) are rendered once into the folder. To compare two commits, build both modules
and run this once with each on PYTHONPATH and the same folder. relMSE is the mean of the squared error over the
squared reference plus 0.01; the cost is its product with the CPU time, which is the same for any number of samples.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import time
from pathlib import Path

import numpy as np

import basicrt

SIZE = 64
REFERENCE_SAMPLES = 1024
WHITE = (0.7, 0.7, 0.7)


def add_box(scene: basicrt.Scene, lower: tuple[float, ...], upper: tuple[float, ...]) -> None:
    """A diffuse box, all six sides."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
    positions = np.array(lower) + corners * (np.array(upper) - np.array(lower))
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [part for a, b, c, d in sides for part in ((a, b, c), (a, c, d))]
    shape = scene.shapes.append(basicrt.Mesh(positions, triangles))
    scene.instances.append(basicrt.Instance(shape, materials=[0]))


def new_room(width: float, depth: float, height: float) -> basicrt.Scene:
    """A diffuse room, seen from near one wall."""
    scene = basicrt.Scene()
    grey = basicrt.Material()
    grey.surface = grey.add(basicrt.DiffuseShader(color=WHITE, twosided=True))
    scene.materials.append(grey)
    add_box(scene, (-width / 2, 0, 0), (width / 2, depth, height))
    for x in (-0.3, 0.25):
        add_box(
            scene, (x * width, 0.6 * depth, 0), ((x + 0.08) * width, 0.66 * depth, 0.6 * height)
        )
    eye = np.eye(4)
    # Looks along y: the camera's -z.
    eye[:3, :3] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    eye[:3, 3] = (0, 0.05 * depth, 0.5 * height)
    scene.camera = basicrt.PerspectiveCamera(eye)
    return scene


def add_lamps(scene: basicrt.Scene, count: int, room: tuple[float, float, float]) -> None:
    """Small bulbs of random strength and colour under the ceiling and along the walls."""
    rng = np.random.default_rng(1)
    width, depth, height = room
    for _ in range(count):
        position = rng.uniform(
            (-0.48 * width, 0.02 * depth, 0.3), (0.48 * width, 0.98 * depth, height - 0.1)
        )
        intensity = rng.uniform(0.2, 1, 3) * rng.uniform(0.2, 3) * 30 / count
        scene.lights.append(basicrt.PointLight(tuple(position), tuple(intensity), 0.03))


def emissive(radiance: tuple[float, float, float]) -> basicrt.Material:
    """Shines on both sides."""
    material = basicrt.Material()
    material.surface = material.add(basicrt.EmissionShader(radiance))
    return material


def one_lamp() -> basicrt.Scene:
    scene = new_room(4, 5, 3)
    scene.lights.append(basicrt.PointLight((0.5, 2.5, 2.5), (3, 3, 3), 0.1))
    return scene


def ten_lamps() -> basicrt.Scene:
    room = (8, 10, 3)
    scene = new_room(*room)
    add_lamps(scene, 10, room)
    return scene


def thousand_lamps() -> basicrt.Scene:
    room = (30, 40, 4)
    scene = new_room(*room)
    add_lamps(scene, 1000, room)
    return scene


def emissive_mesh() -> basicrt.Scene:
    """A torus of twenty thousand triangles under the ceiling."""
    scene = new_room(4, 5, 3)
    around, across = 200, 50
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    radius = 0.8 + 0.12 * np.cos(b)
    positions = np.stack([radius * np.cos(a), 2.5 + radius * np.sin(a), 2.2 + 0.12 * np.sin(b)], -1)
    at = lambda i, j: (i % around) * across + j % across  # noqa: E731
    corners = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)]
    triangles = np.concatenate(
        [
            np.stack([corners[0], corners[1], corners[2]], -1),
            np.stack([corners[0], corners[2], corners[3]], -1),
        ]
    ).reshape(-1, 3)
    shape = scene.shapes.append(basicrt.Mesh(positions.reshape(-1, 3), triangles))
    material = scene.materials.append(emissive((2, 1.8, 1.5)))
    scene.instances.append(basicrt.Instance(shape, materials=[material]))
    return scene


def two_panels() -> basicrt.Scene:
    """Two emissive quads, one by the ceiling, one at a wall."""
    scene = new_room(4, 5, 3)
    material = scene.materials.append(emissive((8, 7, 5)))
    panels = [
        [(-1, 2, 2.98), (0, 2, 2.98), (0, 3, 2.98), (-1, 3, 2.98)],
        [(1.98, 3, 0.5), (1.98, 3.5, 0.5), (1.98, 3.5, 1.5), (1.98, 3, 1.5)],
    ]
    for corners in panels:
        shape = scene.shapes.append(basicrt.Mesh(corners, [(0, 1, 2), (0, 2, 3)]))
        scene.instances.append(basicrt.Instance(shape, materials=[material]))
    return scene


SCENES = {
    "one_lamp": one_lamp,
    "ten_lamps": ten_lamps,
    "thousand_lamps": thousand_lamps,
    "emissive_mesh": emissive_mesh,
    "two_panels": two_panels,
}


def render(scene: basicrt.Scene, samples: int, seed: int) -> tuple[np.ndarray, float]:
    """The picture, and CPU seconds of all threads."""
    settings = scene.settings
    settings.width = settings.height = SIZE
    settings.samples, settings.seed = samples, seed
    scene.settings = settings
    before = time.process_time()
    picture = basicrt.render(scene)["combined"][..., :3]
    return np.asarray(picture, np.float64), time.process_time() - before


def main() -> int:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", nargs="*", default=list(SCENES), help=", ".join(SCENES))
    parser.add_argument("--references", type=Path, required=True)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--runs", type=int, default=3)
    arguments = parser.parse_args()
    arguments.references.mkdir(parents=True, exist_ok=True)

    print(f"{platform.machine()}, basicrt of {basicrt.__file__}, {arguments.samples} samples")
    for name in arguments.scene:
        scene = SCENES[name]()
        path = arguments.references / f"{name}.npy"
        if not path.exists():
            np.save(path, render(scene, REFERENCE_SAMPLES, 12345)[0])
        reference = np.load(path)
        errors, times = [], []
        for seed in range(arguments.runs):
            picture, seconds = render(scene, arguments.samples, seed)
            error = (picture - reference) ** 2 / (reference**2 + 0.01)
            errors.append(float(error.mean()))
            times.append(seconds)
        error, seconds = statistics.mean(errors), min(times)
        bias = picture.mean() / reference.mean() - 1
        print(
            f"{name:16s} relMSE {error:.5f}  {seconds:.3f} s  cost {error * seconds:.6f}"
            f"  mean {bias:+.2%}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
