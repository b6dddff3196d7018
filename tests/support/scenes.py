# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for tests."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import basicrt


def quad(size: float = 2.0) -> basicrt.Mesh:
    """A square in the plane z = 0 around the origin, facing +z, with uv from 0 to 1."""
    h = size / 2
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    corners = [[-h, -h, 0], [h, -h, 0], [h, h, 0], [-h, h, 0]]
    return basicrt.Mesh(np.array(corners, dtype=np.float32), triangles, uvs=uv[triangles])


def bumpy(count: int, seed: int = 1) -> basicrt.Mesh:
    """A height field over [-1, 1]^2 with 2 count^2 triangles."""
    axis = np.linspace(-1, 1, count + 1)
    x, y = np.meshgrid(axis, axis)
    z = 0.1 * np.random.default_rng(seed).random(x.shape)
    positions = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32)
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).reshape(-1, 1)
    right, up = 1, count + 1
    offsets = np.array([[0, right, right + up], [0, right + up, up]])
    triangles = (corner[:, :, None] + offsets).reshape(-1, 3)
    return basicrt.Mesh(positions, triangles.astype(np.uint32))


def add(scene: basicrt.Scene, shape: Any, node: Any, transform: Any = None) -> int:
    """Places a shape with a material of one node; the instance's index."""
    material = basicrt.Material()
    material.surface = material.add(node)
    index = scene.materials.append(material)
    return scene.instances.append(
        basicrt.Instance(
            shape=scene.shapes.append(shape),
            transform=np.eye(4) if transform is None else transform,
            materials=[index],
        )
    )


def aim(
    scene: basicrt.Scene,
    position: Any,
    target: Any,
    fov: float = math.radians(40),
    size: tuple[int, int] = (48, 32),
    samples: int = 8,
) -> None:
    """Gives the scene a camera and the size and samples of its picture."""
    up = (0, 0, 1) if abs(position[0] - target[0]) + abs(position[1] - target[1]) > 0 else (0, 1, 0)
    scene.camera = basicrt.look_at_camera(position, target, up, fov, size[0] / size[1])
    scene.settings.width, scene.settings.height = size
    scene.settings.samples = samples


def still_life(size: tuple[int, int] = (48, 32), samples: int = 8) -> basicrt.Scene:
    """A floor, a glass and a matte sphere under a lamp and a grey sky: a little of everything."""
    scene = basicrt.Scene()
    checker = scene.textures.append(
        basicrt.CheckerboardTexture((0.2, 0.2, 0.2), (0.7, 0.6, 0.5), (8, 8))
    )
    add(scene, quad(8), basicrt.DiffuseShader(color=basicrt.TextureRef(checker)))
    add(scene, basicrt.Sphere((-0.8, 0, 0.7), 0.7), basicrt.GlassShader(eta=1.5))
    add(scene, basicrt.Sphere((0.8, 0, 0.6), 0.6), basicrt.DiffuseShader((0.8, 0.3, 0.2)))
    scene.lights.append(basicrt.PointLight((2, -2, 4), (30, 30, 30), radius=0.3))
    scene.environment.radiance = (0.2, 0.25, 0.3)
    scene.settings.passes = ["Combined", "Depth", "Normal"]
    aim(scene, (0, -5, 2.5), (0, 0, 0.5), size=size, samples=samples)
    return scene


def endless(size: tuple[int, int] = (256, 256)) -> basicrt.Scene:
    """A scene that takes hours to render."""
    scene = still_life(size, samples=1 << 20)
    scene.settings.passes = ["Combined"]
    return scene
