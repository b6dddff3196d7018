# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings and objects that change the picture, against Cycles with the same of them.

Both engines read the same `scene.cycles.*`: ours were never changed.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    add_plane,
    empty_material,
    new_material,
    set_world,
)
from support.cycles import both, expect_alike, neutral_scene, pictures_of

pytestmark = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"
)


# Other versions of Cycles are compared by the demo scenes (test_cycles.py).
pytestmark = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)


def add_smooth_ball(segments: int, rings: int, material: Any) -> Any:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings, radius=1)
    ball = bpy.context.object
    ball.data.materials.append(material)
    ball.data.shade_smooth()
    return ball


@pytest.mark.parametrize("angle", [0.0, 0.2])
def test_a_smooth_shaded_ball_under_grazing_sun(angle: float, tmp_path: Path) -> None:
    scene = neutral_scene(24, samples=64)
    scene.cycles.max_bounces = 0
    add_smooth_ball(16, 8, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    add_lamp("SUN", rotation=(math.radians(80), 0, math.radians(20)), energy=3, angle=angle)
    add_camera(ortho_scale=2.2)
    ours, theirs = both(scene, tmp_path)
    assert abs(ours[..., :3].mean() / theirs[..., :3].mean() - 1) < 2e-3
    expect_alike(ours, theirs, relative=0.004, cells=8)


def test_a_shading_offset_dims_grazing_light(tmp_path: Path) -> None:
    scene = neutral_scene(24, samples=64)
    set_world((0.5, 0.6, 0.7), 0.3)
    ball = add_smooth_ball(16, 8, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    ball.shadow_terminator_shading_offset = 0.6
    glossy = new_material("ShaderNodeBsdfAnisotropic", Color=(0.8, 0.8, 0.8), Roughness=0.5)
    other = add_smooth_ball(16, 8, glossy)
    other.location.x, other.shadow_terminator_shading_offset = 2.1, 1.0
    add_lamp("SUN", rotation=(math.radians(60), 0, math.radians(20)), energy=3)
    add_camera((1, 0, 5), ortho_scale=4.4)
    ours, theirs = both(scene, tmp_path)
    expect_alike(ours, theirs, relative=0.004, cells=8)


def glass_over_floor() -> None:
    add_plane(6, 0, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    ball = add_smooth_ball(
        32, 16, new_material("ShaderNodeBsdfGlass", Color=(1, 1, 1), Roughness=0.3, IOR=1.4)
    )
    ball.location.z = 1.2
    mirror = add_plane(
        2, 1, new_material("ShaderNodeBsdfAnisotropic", Color=(0.9, 0.9, 0.9), Roughness=0.2)
    )
    mirror.location, mirror.rotation_euler = (-1.8, 0, 1), (0, math.radians(75), 0)
    add_lamp("AREA", (0, 0, 4), energy=200, size=2)
    add_camera((0, -6, 5), (math.radians(52), 0, 0), kind="PERSP")


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("no caustics", {"caustics_reflective": False, "caustics_refractive": False}),
        ("no refractive caustics", {"caustics_refractive": False}),
        ("filter glossy", {"blur_glossy": 1.0}),
        ("light threshold", {"light_sampling_threshold": 0.5}),
        ("clamped direct light", {"sample_clamp_direct": 0.3, "light_sampling_threshold": 0.0}),
    ],
)
def test_light_paths_change_the_picture_as_in_cycles(
    name: str, change: dict[str, Any], tmp_path: Path
) -> None:
    scene = neutral_scene(16, samples=256)
    for key, value in change.items():
        setattr(scene.cycles, key, value)
    glass_over_floor()
    expect_alike(*both(scene, tmp_path), relative=0.02)


def half_holdout() -> Any:
    material, tree, output = empty_material("Half")
    mix = add_node(tree, "ShaderNodeMixShader", Fac=0.25)
    tree.links.new(add_node(tree, "ShaderNodeHoldout").outputs[0], mix.inputs[1])
    shine = add_node(tree, "ShaderNodeEmission", Color=(1, 0.5, 0.2), Strength=2.0)
    tree.links.new(shine.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def holdout_node() -> None:
    add_plane(1, 0, half_holdout())


def holdout_object() -> None:
    add_plane(6, -1, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.2, 0.2)))
    add_plane(1, 0, new_material("ShaderNodeBsdfDiffuse")).is_holdout = True


def glass_pane(roughness: float) -> Callable[[], None]:
    def build() -> None:
        pane = new_material(
            "ShaderNodeBsdfRefraction", Color=(0.6, 0.6, 0.6), IOR=1.1, Roughness=roughness
        )
        # A triangle: where two meet, Cycles' rays may pass through both.
        add_mesh([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0, 0.5, 0)], [(0, 1, 2)], pane)

    return build


@pytest.mark.parametrize("is_transparent", [True, False])
@pytest.mark.parametrize(
    "build",
    [holdout_node, holdout_object, glass_pane(0.0), glass_pane(0.09), glass_pane(0.3)],
    ids=["holdout node", "holdout object", "clear glass", "glass", "rough glass"],
)
def test_holes_in_the_film(
    build: Callable[[], None],
    is_transparent: bool,
    tmp_path: Path,
) -> None:
    scene = neutral_scene(16, samples=64)
    scene.render.film_transparent = is_transparent
    scene.cycles.film_transparent_glass = True
    set_world((0.3, 0.5, 0.7))
    build()
    add_camera(ortho_scale=2)
    expect_alike(*both(scene, tmp_path), relative=0.004)


def test_a_shadow_catcher(tmp_path: Path) -> None:
    """A transparent film, and one that shows the world.

    That is compared with Cycles' transparent film over the world: Cycles' own leaves out the world
    twice where objects cover a part of a pixel in front of a catcher.
    """
    scene = neutral_scene(16, samples=256)
    world = np.array((0.3, 0.5, 0.7, 2)) / 2
    set_world((0.3, 0.5, 0.7), 0.5)
    floor = add_plane(20, 0, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    floor.is_shadow_catcher = True
    shade = add_plane(1, 1, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.1)))
    shade.location.x = 0.8
    add_lamp("SUN", rotation=(0, math.radians(45), 0), energy=2)
    add_camera(ortho_scale=4)
    scene.render.film_transparent = True
    ours, theirs = both(scene, tmp_path)
    expect_alike(ours, theirs, relative=0.01)
    scene.render.engine, scene.render.film_transparent = "BASICRT", False
    opaque = pictures_of(scene, tmp_path)
    expect_alike(opaque, theirs + (1 - theirs[..., 3:]) * world, relative=0.01)


@pytest.mark.parametrize(
    ("kind", "width"),
    [("BLACKMAN_HARRIS", 1.5), ("BLACKMAN_HARRIS", 4.0), ("GAUSSIAN", 1.5), ("BOX", 3.0)],
)
def test_pixel_filters(kind: str, width: float, tmp_path: Path) -> None:
    scene = neutral_scene(16, samples=512)
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = kind, width
    shine = new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0)
    add_mesh([(0.03, -5, 0), (5, -5, 0), (5, 5, 0), (0.03, 5, 0)], [(0, 1, 2, 3)], shine)
    add_camera(ortho_scale=2)
    ours, theirs = (picture.mean(axis=(0, 1))[:, 0] for picture in both(scene, tmp_path))
    assert np.abs(ours - theirs).max() < 0.006
