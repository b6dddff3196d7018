# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures through Blender's render operator against closed forms, in Blender's units.

The camera looks straight down at a floor around the origin. A picture is judged by its mean and the
standard error of its pixels.
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
    add_node,
    add_plane,
    empty_material,
    new_material,
    new_scene,
    render,
    set_world,
)

ALBEDO = 0.8
COLOR = (1.0, 0.5, 0.25)


def floor_scene(samples: int = 32, max_bounces: int = 0) -> Any:
    """A diffuse floor of which the camera sees two centimetres around the origin."""
    scene = new_scene(16, 16, samples)
    scene.basicrt.max_bounces = max_bounces
    add_plane(material=new_material("ShaderNodeBsdfDiffuse", Color=(ALBEDO,) * 3))
    add_camera(ortho_scale=0.02)
    return scene


def assert_mean(picture: np.ndarray, expected: Any, rtol: float = 2e-3) -> None:
    """The picture's mean colour, within five standard errors and a share for what is not noise."""
    pixels = picture[..., :3].reshape(-1, 3).astype(float)
    error = pixels.std(axis=0) / math.sqrt(len(pixels))
    expected = np.broadcast_to(np.asarray(expected, float), 3)
    tolerance = 5 * error + rtol * np.abs(expected) + 1e-6
    assert (np.abs(pixels.mean(axis=0) - expected) <= tolerance).all(), (
        f"{pixels.mean(axis=0)} instead of {expected}, tolerance {tolerance}"
    )


# ---- lamps -------------------------------------------------------------------------------------


def test_point_over_a_floor(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("POINT", (1.5, 0, 2), energy=100, color=COLOR, shadow_soft_size=0)
    distance2 = 1.5**2 + 2**2
    cosine = 2 / math.sqrt(distance2)
    irradiance = 100 / (4 * math.pi) / distance2 * cosine
    assert_mean(render(tmp_path), ALBEDO / math.pi * irradiance * np.array(COLOR))


def test_ball_lights_like_a_point_in_its_middle(tmp_path: Path) -> None:
    floor_scene(samples=64)
    add_lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0.5, use_soft_falloff=False)
    assert_mean(render(tmp_path), ALBEDO / math.pi * 100 / (4 * math.pi) / 4)


def test_soft_falloff_is_a_disc(tmp_path: Path) -> None:
    floor_scene(samples=64)
    add_lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0.5)
    # On axis a disc of radius r at distance d gives the point's light times d^2 / (d^2 + r^2).
    expected = ALBEDO / math.pi * 100 / (4 * math.pi) / 4 * 4 / (4 + 0.25)
    assert_mean(render(tmp_path), expected)


@pytest.mark.parametrize(("degrees", "blend"), [(0, 0.15), (24, 0.5), (29, 0.15), (31, 0.5)])
def test_spot_fades_towards_its_rim(tmp_path: Path, degrees: float, blend: float) -> None:
    floor_scene()
    theta, half = math.radians(degrees), math.radians(30)
    made = add_lamp("SPOT", (2 * math.tan(theta), 0, 2), energy=100, shadow_soft_size=0)
    made.data.spot_size, made.data.spot_blend = 2 * half, blend
    cosine = math.cos(theta)
    t = min(1.0, max(0.0, (cosine - math.cos(half)) / ((1 - math.cos(half)) * blend)))
    intensity = 100 / (4 * math.pi) * t * t * (3 - 2 * t)
    expected = ALBEDO / math.pi * intensity * cosine**3 / 4
    assert_mean(render(tmp_path), expected, rtol=4e-3)


@pytest.mark.parametrize("angle", [0, 10, 90])
def test_sun_has_the_same_irradiance_whatever_its_angle(tmp_path: Path, angle: float) -> None:
    floor_scene(samples=64)
    add_lamp("SUN", energy=3, angle=math.radians(angle))
    assert_mean(render(tmp_path), ALBEDO / math.pi * 3)


def test_tilted_sun(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("SUN", rotation=(math.radians(60), 0, 0), energy=3, angle=0)
    assert_mean(render(tmp_path), ALBEDO / math.pi * 1.5)


def rectangle_irradiance(size_x: float, size_y: float, height: float, is_ellipse: bool) -> float:
    """Of radiance 1 from a rectangle or ellipse straight above, by the midpoint rule."""
    n = 1001
    x = ((np.arange(n) + 0.5) / n - 0.5) * size_x
    y = ((np.arange(n) + 0.5) / n - 0.5) * size_y
    grid_x, grid_y = np.meshgrid(x, y)
    distance2 = grid_x**2 + grid_y**2 + height**2
    weight = height**2 / distance2**2
    if is_ellipse:
        weight = weight * ((2 * grid_x / size_x) ** 2 + (2 * grid_y / size_y) ** 2 <= 1)
    return float(weight.sum()) * size_x / n * size_y / n


@pytest.mark.parametrize("shape", ["SQUARE", "RECTANGLE", "DISK", "ELLIPSE"])
def test_area_lamps(tmp_path: Path, shape: str) -> None:
    floor_scene(samples=64)
    made = add_lamp("AREA", (0, 0, 2), energy=100, shape=shape, size=0.5, size_y=0.25)
    made.scale = (2, 2, 2)
    size_y = 1.0 if shape in {"SQUARE", "DISK"} else 0.5
    is_ellipse = shape in {"DISK", "ELLIPSE"}
    area = size_y * (math.pi / 4 if is_ellipse else 1)
    irradiance = 100 / (math.pi * area) * rectangle_irradiance(1, size_y, 2, is_ellipse)
    assert_mean(render(tmp_path), ALBEDO / math.pi * irradiance)


def test_area_lamp_is_dark_from_behind(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("AREA", (0, 0, 2), (math.pi, 0, 0), energy=100)
    assert_mean(render(tmp_path), 0)


@pytest.mark.parametrize("is_visible", [True, False])
def test_camera_sees_area_lamps_only_where_it_may(tmp_path: Path, is_visible: bool) -> None:
    new_scene()
    made = add_lamp("AREA", (0, 0, 2), (math.pi, 0, 0), energy=100, shape="SQUARE", size=1)
    made.visible_camera = is_visible
    add_camera(ortho_scale=0.02)
    assert_mean(render(tmp_path), 100 / math.pi if is_visible else 0)


def test_lamps_do_not_block_rays(tmp_path: Path) -> None:
    scene = new_scene(samples=64)
    scene.basicrt.max_bounces = 0
    add_plane(4, 2, new_material("ShaderNodeBsdfDiffuse", Color=(ALBEDO,) * 3))
    made = add_lamp("AREA", (0, 0, 1.9), energy=10, shape="SQUARE", size=1)
    made.visible_camera = True
    set_world((1, 1, 1))
    add_camera((0, 0, 0), (math.pi, 0, 0), ortho_scale=0.02)
    assert_mean(render(tmp_path), 10 / math.pi + ALBEDO)


def test_opaque_sheet_throws_a_shadow(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0)
    add_plane(1, 1, new_material("ShaderNodeBsdfDiffuse"))
    bpy.context.scene.camera.location = (0, 0, 0.5)
    assert_mean(render(tmp_path), 0)


def test_transparent_sheet_tints_the_shadow(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0)
    add_plane(1, 1, new_material("ShaderNodeBsdfTransparent", Color=COLOR))
    bpy.context.scene.camera.location = (0, 0, 0.5)
    assert_mean(render(tmp_path), ALBEDO / math.pi * 100 / (4 * math.pi) / 4 * np.array(COLOR))


# ---- world and emission ------------------------------------------------------------------------


def test_white_world_on_a_floor(tmp_path: Path) -> None:
    floor_scene(samples=64)
    set_world((1, 1, 1), 0.7)
    assert_mean(render(tmp_path), ALBEDO * 0.7)


def test_world_seen_directly_and_exposed(tmp_path: Path) -> None:
    scene = new_scene()
    add_camera()
    set_world(COLOR, 0.7)
    scene.basicrt.film_exposure = 2.0
    scene.view_settings.exposure = 3.0  # for the screen only
    picture = render(tmp_path)
    assert_mean(picture, 1.4 * np.array(COLOR), rtol=1e-6)
    assert (picture[..., 3] == 1).all()


@pytest.mark.parametrize(("height", "turn"), [(5, 0), (-5, math.pi)])
def test_emission_shines_on_both_sides(tmp_path: Path, height: float, turn: float) -> None:
    new_scene()
    add_plane(2, 0, new_material("ShaderNodeEmission", Color=COLOR, Strength=3))
    add_camera((0, 0, height), (turn, 0, 0), ortho_scale=0.02)
    assert_mean(render(tmp_path), 3 * np.array(COLOR), rtol=1e-6)


def test_emissive_square_lights_a_floor(tmp_path: Path) -> None:
    floor_scene(samples=64)
    add_plane(1, 2, new_material("ShaderNodeEmission", Strength=7.0, Color=(1, 1, 1)))
    bpy.context.scene.camera.location = (0, 0, 1.5)
    expected = ALBEDO / math.pi * 7 * rectangle_irradiance(1, 1, 2, False)
    assert_mean(render(tmp_path), expected, rtol=4e-3)


# ---- light paths -------------------------------------------------------------------------------


@pytest.mark.parametrize(("total", "diffuse"), [(0, 4), (1, 4), (12, 0), (12, 4)])
def test_bounces_are_counted_as_blender_does(tmp_path: Path, total: int, diffuse: int) -> None:
    """Inside a closed box that shines and reflects half, n scatterings give 2 - 2^-n."""
    scene = new_scene(8, 8, 64)
    scene.basicrt.max_bounces, scene.basicrt.diffuse_bounces = total, diffuse
    material, tree, output = empty_material()
    both = tree.nodes.new("ShaderNodeAddShader")
    reflects = add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5))
    shines = add_node(tree, "ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0)
    tree.links.new(reflects.outputs[0], both.inputs[0])
    tree.links.new(shines.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.data.materials.append(material)
    add_camera((0, 0, 0), (0.3, 0.2, 0), kind="PERSP")
    n = min(total, diffuse) + 1
    assert_mean(render(tmp_path), 2 - 0.5**n)


@pytest.mark.parametrize(("sheets", "expected"), [(8, 1), (9, 0)])
def test_transparent_sheets_are_counted(tmp_path: Path, sheets: int, expected: float) -> None:
    new_scene(samples=8)
    add_plane(4, 0, new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0))
    clear = new_material("ShaderNodeBsdfTransparent", Color=(1, 1, 1))
    for index in range(sheets):
        add_plane(4, 0.1 * (index + 1), clear)
    add_camera(ortho_scale=0.02)
    assert_mean(render(tmp_path), expected)


@pytest.mark.parametrize(
    ("bl_idname", "values", "rtol"),
    [
        ("ShaderNodeBsdfDiffuse", {"Color": (1, 1, 1)}, 2e-3),
        ("ShaderNodeBsdfGlass", {"Roughness": 0.0, "IOR": 1.5}, 2e-3),
        ("ShaderNodeBsdfAnisotropic", {"Color": (1, 1, 1), "Roughness": 0.0}, 2e-3),
        ("ShaderNodeBsdfTransparent", {}, 2e-3),
        ("ShaderNodeBsdfPrincipled", {"Base_Color": (1, 1, 1), "Roughness": 0.5}, 2e-2),
        (
            "ShaderNodeBsdfPrincipled",
            {"Base_Color": (1, 1, 1), "Metallic": 1.0, "Roughness": 0.3},
            2e-2,
        ),
    ],
)
def test_white_ball_vanishes_in_a_white_world(
    tmp_path: Path, bl_idname: str, values: dict[str, Any], rtol: float
) -> None:
    scene = new_scene(16, 16, 64)
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent"):
        setattr(scene.basicrt, f"{kind}_bounces", 64)
    set_world((1, 1, 1))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=1)
    ball = bpy.context.object
    ball.data.shade_smooth()
    ball.data.materials.append(new_material(bl_idname, **values))
    add_camera(ortho_scale=1)
    assert_mean(render(tmp_path), 1, rtol)


def test_glass_sheet_transmits_what_fresnel_leaves(tmp_path: Path) -> None:
    new_scene(samples=256)
    add_plane(20, 0, new_material("ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.5))
    add_plane(20, -1, new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0))
    add_camera(ortho_scale=0.02)
    assert_mean(render(tmp_path), 0.96)


def test_mirror_has_its_colour(tmp_path: Path) -> None:
    new_scene()
    add_plane(20, 0, new_material("ShaderNodeBsdfAnisotropic", Color=COLOR, Roughness=0.0))
    add_plane(20, 9, new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0))
    add_camera(ortho_scale=0.02)
    assert_mean(render(tmp_path), COLOR, rtol=1e-5)


def test_visibility_hides_from_the_camera_but_not_from_light(tmp_path: Path) -> None:
    floor_scene()
    add_lamp("POINT", (0, 0, 2), energy=100, shadow_soft_size=0)
    sheet = add_plane(1, 1, new_material("ShaderNodeBsdfDiffuse"))
    bpy.context.scene.camera.location = (0, 0, 1.5)
    sheet.visible_camera = False
    assert_mean(render(tmp_path), 0)
    sheet.visible_shadow = False
    assert_mean(render(tmp_path), ALBEDO / math.pi * 100 / (4 * math.pi) / 4)
