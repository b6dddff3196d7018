# SPDX-License-Identifier: GPL-3.0-or-later
"""Displaced meshes whose places are known."""

from typing import Any

import numpy as np
import pytest

import basicrt
from basicrt import DisplacementShader, SurfaceOperation

SQUARE = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32)


def scene_of(*displacements: Any, transform: Any = None, mesh: Any = None) -> basicrt.Scene:
    """A square that fills the view of a camera at z = 5, with the sum of these offsets."""
    scene = basicrt.Scene()
    material = basicrt.Material()
    material.surface = material.add(basicrt.DiffuseShader())
    for add in displacements:
        material.add(DisplacementShader(offset=add(material)))
    mesh = mesh or basicrt.Mesh(positions=SQUARE, triangles=[(0, 1, 2), (0, 2, 3)])
    shape, index = scene.shapes.append(mesh), scene.materials.append(material)
    placed = np.eye(4) if transform is None else transform
    scene.instances.append(basicrt.Instance(shape=shape, transform=placed, materials=[index]))
    view = np.eye(4)
    view[2, 3] = 5
    scene.camera = basicrt.PerspectiveCamera(
        transform=view, window_min=(-0.1, -0.1), window_max=(0.1, 0.1)
    )
    scene.settings.width = scene.settings.height = 4
    scene.settings.samples = 1
    scene.settings.passes = ["Combined", "Depth", "Normal"]
    return scene


def along_the_normal(material: basicrt.Material) -> Any:
    return material.add_operation(SurfaceOperation(value="normal"))


def upwards(_material: basicrt.Material) -> Any:
    return (0.0, 0.0, 0.5)


def depth(scene: basicrt.Scene) -> np.ndarray:
    return basicrt.render(scene)["Depth"]


def test_offsets_are_in_world_space() -> None:
    scene = scene_of(upwards, transform=np.diag([2.0, 2.0, 4.0, 1.0]))
    assert depth(scene) == pytest.approx(4.5, abs=1e-5)


def test_offsets_add_up() -> None:
    assert depth(scene_of(upwards, along_the_normal)) == pytest.approx(3.5, abs=1e-5)


def test_the_normal_of_a_mirrored_object_points_away_from_its_front() -> None:
    scene = scene_of(along_the_normal, transform=np.diag([2.0, 2.0, -3.0, 1.0]))
    assert depth(scene) == pytest.approx(6, abs=1e-5)


def test_smooth_normals_follow_the_surface() -> None:
    """A plane that becomes a slope, of 45 degrees."""
    mesh = basicrt.Mesh(
        positions=SQUARE,
        triangles=[(0, 1, 2), (0, 2, 3)],
        corner_normals=np.tile(np.float32([0, 0, 1]), (6, 1)),
    )

    def by_x(material: basicrt.Material) -> Any:
        place = material.add_operation(SurfaceOperation(value="position"))
        x = material.add_operation(basicrt.ComponentOperation(value=place, component="x"))
        return material.add_operation(basicrt.CombineOperation(x=0.0, y=0.0, z=x))

    normals = basicrt.render(scene_of(by_x, mesh=mesh))["Normal"]
    half = np.sqrt(0.5)
    np.testing.assert_allclose(normals[..., :3], np.tile([-half, 0, half], (4, 4, 1)), atol=1e-5)


def test_offsets_that_are_no_numbers_move_nothing() -> None:
    def broken(material: basicrt.Material) -> Any:
        return material.add_operation(
            basicrt.VectorMathOperation(operation="multiply", a=(1e30, 1e30, 1e30), b=(1e30, 0, 0))
        )

    assert depth(scene_of(broken)) == pytest.approx(5, abs=1e-5)


def test_a_moved_object_is_displaced_anew() -> None:
    """In a session that has seen it elsewhere."""
    scene = scene_of(upwards)
    session = basicrt.ViewSession(1)
    for height in (0.0, 1.0):
        instance = scene.instances[0]
        transform = np.eye(4)
        transform[2, 3] = height
        instance.transform = transform
        scene.instances[0] = instance
        session.set_scene(scene)
        session.set_view(scene.camera, scene.settings)
        while not session.status.is_done:
            pass
    session.close()
    assert depth(scene) == pytest.approx(3.5, abs=1e-5)
