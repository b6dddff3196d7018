# SPDX-License-Identifier: GPL-3.0-or-later
"""What materials cost, by the Python module: leaves cut out by alpha, graphs of many nodes, single operations.

benchmarks/materials.py [--runs 5]

Each pair of scenes is rendered in turns; medians of CPU seconds of all threads, and of their ratios.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import basicrt

LEAVES = 20_000
OPERATIONS = 200
SIZE, SAMPLES = 128, 64  # of walls


def look_along_y(height: float) -> np.ndarray:
    """A camera at y = -6."""
    pose = np.eye(4)
    pose[:3, :3] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    pose[:3, 3] = (0, -6, height)
    return pose


def leaf_mask() -> basicrt.Image:
    """An ellipse with veins, cut out of a green square."""
    y, x = np.mgrid[-1:1:64j, -1:1:64j]
    inside = (x * 1.6) ** 2 + y**2 < 1
    pixels = np.zeros((64, 64, 4), np.uint8)
    pixels[..., 1] = 120 + (40 * np.cos(20 * (y + abs(x)))).astype(int)
    pixels[..., 3] = 255 * inside
    return basicrt.Image(pixels, "srgb")


def tree(has_alpha: bool) -> basicrt.Scene:
    """A crown of leaves over a floor, under a sun and a sky."""
    scene = basicrt.Scene()
    random = np.random.default_rng(2)
    middles = random.normal(size=(LEAVES, 3))
    middles *= (random.random((LEAVES, 1)) ** (1 / 3)) / np.linalg.norm(middles, axis=1)[:, None]
    middles = middles * 1.8 + (0, 0, 2.2)
    sides = [random.normal(size=(LEAVES, 3)) for _ in range(2)]
    right, up = (0.06 * side / np.linalg.norm(side, axis=1)[:, None] for side in sides)
    corners = [middles + a * right + b * up for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    positions = np.stack(corners, axis=1).reshape(-1, 3)
    halves = np.array([0, 1, 2, 0, 2, 3])
    triangles = (4 * np.arange(LEAVES)[:, None] + halves).reshape(-1, 3)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]], np.float32)
    uvs = np.tile(square, (LEAVES, 1)).reshape(-1, 3, 2)
    crown = scene.shapes.append(basicrt.Mesh(positions, triangles, uvs=uvs))

    texture = scene.textures.append(basicrt.ImageTexture(leaf_mask()))
    leaf = basicrt.Material("Leaf")
    alpha: Any = basicrt.TextureRef(texture, alpha=True) if has_alpha else 1.0
    leaf.surface = leaf.add(
        basicrt.PrincipledShader(base_color=basicrt.TextureRef(texture), roughness=0.6, alpha=alpha)
    )
    floor = basicrt.Material("Floor")
    floor.surface = floor.add(basicrt.DiffuseShader(color=(0.5, 0.4, 0.3), twosided=True))
    materials = [scene.materials.append(material) for material in (leaf, floor)]
    ground = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], np.float32)
    plane = scene.shapes.append(basicrt.Mesh(ground, [(0, 1, 2), (0, 2, 3)]))
    scene.instances.append(basicrt.Instance(crown, materials=[materials[0]]))
    scene.instances.append(basicrt.Instance(plane, materials=[materials[1]]))
    scene.lights.append(basicrt.SunLight(direction=(0.3, 0.4, -0.9), irradiance=(3, 3, 2.7)))
    scene.environment = basicrt.Environment(radiance=(0.3, 0.4, 0.6))
    scene.camera = basicrt.PerspectiveCamera(look_along_y(2))
    scene.settings = basicrt.RenderSettings(width=160, height=160, samples=16)
    return scene


def wall(fill: Callable[[basicrt.Material, Any], Any] | None, size: int = SIZE) -> basicrt.Scene:
    """A wall that fills the picture and shines as a graph says: `fill` is given the place."""
    scene = basicrt.Scene()
    corners = np.array([[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], np.float32)
    plane = scene.shapes.append(basicrt.Mesh(corners, [(0, 1, 2), (0, 2, 3)]))
    material = basicrt.Material("Wall")
    place = material.add_operation(basicrt.SurfaceOperation(value="position"))
    shown = place if fill is None else fill(material, place)
    material.surface = material.add(basicrt.EmissionShader(radiance=shown))
    scene.instances.append(basicrt.Instance(plane, materials=[scene.materials.append(material)]))
    scene.camera = basicrt.PerspectiveCamera(look_along_y(0))
    scene.settings = basicrt.RenderSettings(width=size, height=size, samples=SAMPLES)
    return scene


def long_graph(material: basicrt.Material, place: Any) -> Any:
    """Two hundred operations, each of the one before."""
    kinds = ("multiply_add", "sine", "absolute", "power", "minimum")
    value = place
    for index in range(OPERATIONS - 2):
        kind = kinds[index % len(kinds)]
        value = material.add_operation(basicrt.MathOperation(kind, value, 0.7 + index * 1e-3, 0.1))
    return value


def repeated(made: Callable[[Any], Any], count: int) -> Callable[[basicrt.Material, Any], Any]:
    """Operations of one kind, the place of each moved by the one before."""

    def fill(material: basicrt.Material, place: Any) -> Any:
        value = place
        for _ in range(count):
            value = material.add_operation(made(value))
        return value

    return fill


SINGLE = {
    "math": lambda v: basicrt.MathOperation("sine", v),
    "mix": lambda v: basicrt.MixOperation("overlay", v, v, (0.2, 0.3, 0.4)),
    "noise": lambda v: basicrt.NoiseOperation(vector=v, detail=2.0),
    "voronoi": lambda v: basicrt.VoronoiOperation(vector=v),
    "brick": lambda v: basicrt.BrickOperation(vector=v),
}


def seconds(scene: basicrt.Scene) -> float:
    """CPU time of a render, all threads."""
    before = time.process_time()
    basicrt.render(scene)
    return time.process_time() - before


def in_turns(a: basicrt.Scene, b: basicrt.Scene, runs: int) -> tuple[float, float, float]:
    """Medians of both and of their ratio."""
    pairs = [(seconds(a), seconds(b)) for _ in range(runs)]
    first, second = (statistics.median(column) for column in zip(*pairs, strict=True))
    return first, second, statistics.median(one / other for one, other in pairs)


def main() -> int:
    """Print a line for each comparison."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    print(f"{platform.machine()}, basicrt of {basicrt.__file__}")
    cut, opaque, ratio = in_turns(tree(True), tree(False), runs)
    print(f"{LEAVES} leaves: {cut:.2f} s cut out, {opaque:.2f} s opaque, ratio {ratio:.2f}")
    compiled, empty, _ = in_turns(wall(long_graph, 1), wall(None, 1), 20 * runs)
    print(
        f"{OPERATIONS} operations, one pixel: {(compiled - empty) * 1e3:.2f} ms more than without"
    )
    shaded = SIZE * SIZE * SAMPLES * 1e-9
    compiled, empty, _ = in_turns(wall(long_graph), wall(None), runs)
    print(f"{OPERATIONS} operations: {(compiled - empty) / (shaded * OPERATIONS):.1f} ns each")
    for name, made in SINGLE.items():
        many, empty, _ = in_turns(wall(repeated(made, 8)), wall(None), runs)
        print(f"{name}: {(many - empty) / (shaded * 8):.0f} ns", flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
