# SPDX-License-Identifier: GPL-3.0-or-later
"""Demo scenes and single properties of lamps against Cycles: the same picture in expectation, region by region.

Cycles is made neutral (no clamping, no glossy filter, no denoising, no adaptive sampling, no shifted
shadow rays). Both engines render several seeds; regions' means may differ by what the seeds' scatter
explains and a share for what else there is.
"""

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_plane,
    make_cycles_neutral,
    new_material,
    new_scene,
    render,
    set_linear_keys,
    set_world,
)

SCENES = Path(__file__).resolve().parents[2] / "scenes" / "blender"
SEEDS = 6
SAMPLES = (
    128  # Cycles' first sample is at the pixel's centre: with few of them it is biased at edges
)
REGIONS = 4  # along each side

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0"),
]


def region_means(picture: np.ndarray) -> np.ndarray:
    """(REGIONS * REGIONS, 3) means over equal rectangles."""
    rows = np.array_split(picture[..., :3].astype(float), REGIONS, axis=0)
    return np.array(
        [part.mean(axis=(0, 1)) for row in rows for part in np.array_split(row, REGIONS, axis=1)]
    )


def render_seeds(scene: Any, engine: str, folder: Path) -> np.ndarray:
    """(SEEDS, regions, 3)."""
    scene.render.engine = engine
    means = []
    for seed in range(SEEDS):
        scene.basicrt.seed = scene.cycles.seed = seed
        means.append(region_means(render(folder)))
    return np.array(means)


@pytest.mark.parametrize(
    ("name", "percentage"),
    [("cornell_glass", 12), ("materials", 12), ("lights", 10), ("instances", 12)],
)
def test_demo_scene_is_as_in_cycles(name: str, percentage: int, tmp_path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    scene = bpy.context.scene
    scene.render.resolution_percentage = percentage
    scene.basicrt.samples = SAMPLES
    make_cycles_neutral(scene)
    expect_same_regions(scene, name, tmp_path)


def expect_same_regions(scene: Any, name: str, folder: Path) -> None:
    """Render with both engines and compare."""
    ours = render_seeds(scene, "BASICRT", folder)
    theirs = render_seeds(scene, "CYCLES", folder)
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    variance = ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)
    # Caustics make seeds' scatter a poor estimate in single regions: not less than a quarter of the mean one.
    error = np.sqrt(np.maximum(variance, variance.mean() / 16) / SEEDS)
    tolerance = 5 * error + 0.01 * theirs.mean(axis=0)
    worst = np.unravel_index((np.abs(difference) / tolerance).argmax(), difference.shape)
    print(
        f"{name}: whole picture {ours.mean() / theirs.mean() - 1:+.3%} "
        f"± {math.sqrt(variance.mean() / SEEDS / variance.size) / theirs.mean():.3%}, "
        f"worst region {worst}: {difference[worst] / theirs.mean(axis=0)[worst]:+.2%}"
    )
    assert (np.abs(difference) <= tolerance).all(), f"region {worst} differs by {difference[worst]}"


def move(made: Any, path: str, begin: Any, end: Any) -> None:
    """Evenly, from one frame before the one that is rendered to one after it."""
    for frame, value in ((9, begin), (11, end)):
        setattr(made, path, value)
        made.keyframe_insert(path, frame=frame)


def add_moving_thing(kind: str) -> None:
    """Something that casts a shadow on a floor, and shines on it."""
    vertices = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1.5)]
    faces = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (3, 2, 1, 0)]
    material = new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.1))
    pyramid = add_mesh(vertices, faces, material, "Pyramid", (0, 0, 0.3))
    lamp = new_material("ShaderNodeEmission", "Lamp", Color=(0.2, 0.5, 1), Strength=3.0)
    glowing = add_plane(0.6, 1.5, lamp, "Glowing")
    glowing.location.x = -1.5
    if kind == "object":
        move(pyramid, "location", (-1.5, 0, 0.3), (1.5, 0.5, 0.6))
        move(pyramid, "rotation_euler", (0, 0, 0), (0.3, 0, 2.5))
        move(glowing, "location", (-2, -1, 1), (-1, 1.5, 2))
    elif kind == "deforming":
        for made, vertex, co in ((pyramid, 4, (2.5, 1, 2.5)), (glowing, 1, (2, -2, 1))):
            made.shape_key_add(name="Basis")
            block = made.shape_key_add(name="Moved")
            block.data[vertex].co = co
            move(block, "value", 0.0, 1.0)
            set_linear_keys(made.data.shape_keys)
    else:
        camera = bpy.context.scene.camera
        move(camera, "location", (0, -6, 5), (1.5, -5.5, 5.5))
        move(camera, "rotation_euler", (0.9, 0, -0.1), (0.8, 0.1, 0.3))
        set_linear_keys(camera)
    for made in (pyramid, glowing):
        set_linear_keys(made)


only_in_one_version = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)


@only_in_one_version
@pytest.mark.parametrize("kind", ["object", "deforming", "camera"])
@pytest.mark.parametrize(("position", "shutter"), [("CENTER", 1.0), ("START", 0.6)])
def test_motion_is_as_in_cycles(kind: str, position: str, shutter: float, tmp_path: Path) -> None:
    scene = new_scene(32, 32, SAMPLES)
    add_camera((0, -6, 5), (0.9, 0, 0), "PERSP", lens=35)
    add_plane(8, 0, new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.6, 0.6, 0.6)))
    add_lamp("AREA", (2, -1, 5), (0.2, 0.3, 0), energy=300, size=1)
    set_world((0.1, 0.15, 0.3))
    add_moving_thing(kind)
    scene.render.use_motion_blur = True
    scene.render.motion_blur_position, scene.render.motion_blur_shutter = position, shutter
    scene.frame_set(10)
    make_cycles_neutral(scene)
    expect_same_regions(scene, f"{kind} {position}", tmp_path)


def lamp_scene(
    kind: str, location: Any, rotation: Any = (0, 0, 0), **values: Any
) -> tuple[Any, Any]:
    """A glossy floor and a diffuse wall, a small shade over the floor, and one lamp."""
    scene = new_scene(16, 16, SAMPLES)
    add_camera((0, -3, 1.6), (1.2, 0, 0), "PERSP", lens=28)
    floor = new_material(
        "ShaderNodeBsdfPrincipled",
        Base_Color=(0.7, 0.6, 0.5),
        Roughness=0.4,
        Specular_IOR_Level=0.8,
    )
    add_plane(8, material=floor)
    wall = add_plane(8, material=new_material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.6, 0.7)))
    wall.location, wall.rotation_euler = (0, 2, 0), (math.pi / 2, 0, 0)
    add_plane(0.8, 0.7, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    return scene, add_lamp(kind, location, rotation, **values)


BALL = ("POINT", (0.5, 0, 1.6))
PANEL = ("AREA", (0.3, 0.2, 1.7), (0.3, 0.2, 0))
LAMPS: dict[str, tuple[Any, dict[str, Any], dict[str, Any], dict[str, Any]]] = {
    # lamp, the light's values, Cycles' values of the light, the object's values
    "hidden from diffuse": (PANEL, {"energy": 60, "size": 1}, {}, {"visible_diffuse": False}),
    "hidden from glossy": (PANEL, {"energy": 60, "size": 1}, {}, {"visible_glossy": False}),
    "seen by the camera": (PANEL, {"energy": 60, "size": 1}, {}, {"visible_camera": True}),
    "without shadows": (BALL, {"energy": 60, "shadow_soft_size": 0.3, "use_shadow": False}, {}, {}),
    "soft ball": (BALL, {"energy": 60, "shadow_soft_size": 0.3}, {}, {}),
    "hard ball": (BALL, {"energy": 60, "shadow_soft_size": 0.3, "use_soft_falloff": False}, {}, {}),
    "direct light alone": (BALL, {"energy": 60}, {"max_bounces": 0}, {}),
    "spread": (PANEL, {"energy": 60, "size": 1, "spread": 1.2}, {}, {}),
    "exposure and temperature": (
        BALL,
        {"energy": 20, "exposure": 1.5, "use_temperature": True, "temperature": 4000},
        {},
        {},
    ),
    "not normalized": (PANEL, {"energy": 30, "size": 0.7, "normalize": False}, {}, {}),
}


@only_in_one_version
@pytest.mark.parametrize("name", LAMPS)
def test_lamp_property_is_as_in_cycles(name: str, tmp_path: Path) -> None:
    place, values, cycles_values, object_values = LAMPS[name]
    scene, made = lamp_scene(*place, **values)
    for key, value in cycles_values.items():
        setattr(made.data.cycles, key, value)
    for key, value in object_values.items():
        setattr(made, key, value)
    make_cycles_neutral(scene)
    expect_same_regions(scene, name, tmp_path)


@only_in_one_version
def test_many_lamps_are_as_in_cycles(tmp_path: Path) -> None:
    scene, _sun = lamp_scene("SUN", (0, 0, 3), (0.8, 0.3, 0), energy=0.5, angle=0.1)
    for i in range(24):
        place = (-2 + i % 6 * 0.8, -1 + i // 6 * 0.7, 0.4 + 0.3 * (i % 3))
        if i % 3 == 0:
            add_lamp("AREA", place, (0.5 * i, 0.3 * i, 0), energy=1 + i % 4, size=0.2)
        elif i % 3 == 1:
            add_lamp("SPOT", place, (0.4 * i, 0.2 * i, 0), energy=4, shadow_soft_size=0.02)
        else:
            add_lamp("POINT", place, energy=2, shadow_soft_size=0.03)
    make_cycles_neutral(scene)
    expect_same_regions(scene, "many lamps", tmp_path)
