# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals near edges that look rounded, against integrals over the surface nearby."""

from typing import Any

import numpy as np
import pytest

import basicrt

RADIUS = 0.4


def edge_scene(samples: int = 64, width: int = 8, **bevel: Any) -> basicrt.Scene:
    """A wall along x = 0 that goes down from a floor at z = 0, which a camera sees from above.

    The picture shows the floor from its edge to RADIUS away; it shines as bright as its normal.
    """
    floor = [(0, -9, 0), (9, -9, 0), (9, 9, 0), (0, 9, 0)]
    wall = [(0, -9, -9), (0, -9, 0), (0, 9, 0), (0, 9, -9)]
    mesh = basicrt.Mesh(
        positions=np.float32(floor + wall),
        triangles=[(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)],
    )
    scene = basicrt.Scene()
    material = basicrt.Material()
    normal = material.add_operation(
        basicrt.BevelOperation(**{"radius": RADIUS, "samples": 128, **bevel})
    )
    half = (0.5, 0.5, 0.5)
    seen = basicrt.VectorMathOperation(operation="multiply_add", a=normal, b=half, c=half)
    shader = basicrt.EmissionShader(radiance=material.add_operation(seen), twosided=True)
    material.surface = material.add(shader)
    shape, index = scene.shapes.append(mesh), scene.materials.append(material)
    scene.instances.append(basicrt.Instance(shape=shape, materials=[index]))
    view = np.eye(4)
    view[2, 3] = 5
    scene.camera = basicrt.OrthographicCamera(
        transform=view, window_min=(0, -0.01), window_max=(RADIUS, 0.01)
    )
    scene.settings.width, scene.settings.height = width, 1
    scene.settings.samples = samples
    return scene


def normals(scene: basicrt.Scene, **render: Any) -> np.ndarray:
    return basicrt.render(scene, **render)["Combined"][0, :, :3] * 2 - 1


def rounded(distance: np.ndarray) -> np.ndarray:
    """The mean normal so far from the edge: each place counts by the cube of what RADIUS leaves."""

    def amount(along: np.ndarray, across: np.ndarray, off: np.ndarray) -> np.ndarray:
        left = np.maximum(RADIUS - np.sqrt(along**2 + across**2 + off**2), 0)
        return (left**3).sum(axis=(0, 1))

    grid = (np.arange(400) + 0.5) / 400
    y, x = (2 * grid - 1)[:, None, None] * RADIUS, 2 * grid[None, :, None] * RADIUS
    of_floor = amount(y, x - distance, np.zeros(1))
    of_wall = amount(y, x, distance)  # as far down as the floor goes away
    total = np.stack([-of_wall, np.zeros_like(of_floor), of_floor], axis=1)
    return total / np.linalg.norm(total, axis=1, keepdims=True)


def test_normals_turn_as_the_surface_nearby_says() -> None:
    width = 8
    scene = edge_scene(width=width)
    scene.settings.filter_radius = 0.01
    middles = (np.arange(width) + 0.5) / width * RADIUS
    expected = rounded(middles)
    assert expected[0, 0] < -0.5
    assert expected[-1, 2] > 0.999
    np.testing.assert_allclose(normals(scene), expected, atol=0.01)


def test_far_from_edges_normals_are_the_surface_s_own() -> None:
    scene = edge_scene(samples=1, radius=1e-4)
    np.testing.assert_allclose(normals(scene)[1:], np.tile([0, 0, 1], (7, 1)), atol=1e-5)


def test_without_a_radius_nothing_turns() -> None:
    scene = edge_scene(samples=1, radius=0.0)
    np.testing.assert_allclose(normals(scene), np.tile([0, 0, 1], (8, 1)), atol=1e-6)


def test_another_normal_turns_by_as_much() -> None:
    """As far as the surface's own moves, before both get unit length."""
    start = np.array([0.6, 0.0, 0.8])
    scene = edge_scene(normal=tuple(start))
    scene.settings.filter_radius = 0.01
    turned = start + rounded((np.arange(8) + 0.5) / 8 * RADIUS) - [0, 0, 1]
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    np.testing.assert_allclose(normals(scene), turned, atol=0.015)


@pytest.mark.parametrize(("threads", "tile_size"), [(1, 3), (2, 1), (3, 64)])
def test_noise_depends_on_neither_threads_nor_tiles(threads: int, tile_size: int) -> None:
    scene = edge_scene(samples=2)
    picture = basicrt.render(scene, threads=threads, tile_size=tile_size)["Combined"]
    assert picture.tobytes() == basicrt.render(scene)["Combined"].tobytes()
