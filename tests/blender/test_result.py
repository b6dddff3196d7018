# SPDX-License-Identifier: GPL-3.0-or-later
"""What arrives in Blender's render result: passes, alpha, border, view layers, frames, and the same bytes always."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import OpenEXR
import pytest

from support.blender import (
    add_camera,
    add_lamp,
    add_plane,
    new_material,
    new_scene,
    render,
    render_passes,
    set_exr,
    set_world,
)


def emissive(color: tuple[float, float, float], name: str = "Light") -> Any:
    return new_material("ShaderNodeEmission", name, Color=color, Strength=1.0)


def busy_scene(width: int = 61, height: int = 43, samples: int = 4) -> Any:
    """Something different in every pixel: an orthographic view of lit balls over a floor."""
    scene = new_scene(width, height, samples)
    add_plane(8, 0, new_material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.4, 0.3)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=1)
    ball = bpy.context.object
    ball.data.shade_smooth()
    ball.data.materials.append(new_material("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.5, 0.9)))
    add_lamp("POINT", (1, -2, 3), energy=200, shadow_soft_size=0.2)
    set_world((0.3, 0.4, 0.5))
    add_camera((0, -6, 4), (0.95, 0, 0), kind="PERSP", lens=40)
    return scene


# ---- passes and alpha --------------------------------------------------------------------------


def test_depth_is_along_the_axis_and_far_behind_nothing(tmp_path: Path) -> None:
    new_scene(8, 8)
    bpy.context.view_layer.use_pass_z = True
    add_plane(2, 1.5, emissive((1, 1, 1)))
    add_camera((0, 0, 5), ortho_scale=4)
    depth = render_passes(tmp_path)["ViewLayer.Depth"][..., 0]
    assert depth[4, 4] == pytest.approx(3.5, rel=1e-6)
    assert depth[0, 0] == pytest.approx(1e10)


def test_depth_in_perspective_is_no_distance(tmp_path: Path) -> None:
    new_scene(16, 16)
    bpy.context.view_layer.use_pass_z = True
    add_plane(100, 0, emissive((1, 1, 1)))
    add_camera((0, 0, 5), kind="PERSP", lens=10)
    depth = render_passes(tmp_path)["ViewLayer.Depth"]
    np.testing.assert_allclose(depth, 5, rtol=1e-6)


def test_normals_are_the_worlds(tmp_path: Path) -> None:
    new_scene(8, 8)
    bpy.context.view_layer.use_pass_normal = True
    add_plane(2, 0, emissive((1, 1, 1))).rotation_euler = (0.5, 0, 0)
    add_camera((0, 0, 5), ortho_scale=0.5)
    normal = render_passes(tmp_path)["ViewLayer.Normal"]
    np.testing.assert_allclose(
        normal, np.broadcast_to((0, -np.sin(0.5), np.cos(0.5)), normal.shape), atol=1e-5
    )


def test_only_the_passes_asked_for_are_made(tmp_path: Path) -> None:
    new_scene(8, 8)
    add_camera()
    assert set(render_passes(tmp_path)) == {"ViewLayer.Combined"}


def test_rows_begin_at_the_bottom(tmp_path: Path) -> None:
    new_scene(16, 8)
    add_plane(1, 0, emissive((1, 0, 0))).location = (-1, -0.5, 0)  # the lower left quarter
    add_camera(ortho_scale=2)
    scene = bpy.context.scene
    scene.basicrt.filter_type = "BOX"
    picture = render(tmp_path)
    assert (picture[:4, :4, 0] == 1).all()
    picture[:4, :4] = 0
    assert picture[..., 0].max() == 0 or picture[4:, 8:, 0].max() == 0


def test_film_is_transparent_where_nothing_is_hit(tmp_path: Path) -> None:
    scene = new_scene(16, 16)
    scene.render.film_transparent = True
    scene.basicrt.filter_type = "BOX"
    set_world((1, 1, 1))
    add_plane(1, 0, emissive((1, 0.5, 0.25)))
    add_camera(ortho_scale=2)
    picture = render(tmp_path)
    np.testing.assert_allclose(picture[8, 8], (1, 0.5, 0.25, 1))
    np.testing.assert_array_equal(picture[0, 0], (0, 0, 0, 0))


def test_opaque_film_shows_the_world(tmp_path: Path) -> None:
    new_scene(4, 4)
    set_world((0.25, 0.5, 1))
    add_camera()
    np.testing.assert_array_equal(render(tmp_path)[0, 0], (0.25, 0.5, 1, 1))


# ---- border ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "rectangle",
    [
        (0.131, 0.777, 0.21, 0.9),
        (0.0, 0.5, 0.0, 0.5),
        (0.2, 0.21, 0.1, 0.13),
        (0.5, 1.0, 0.7, 1.0),
    ],
)
def test_border_has_the_whole_pictures_pixels(
    tmp_path: Path, rectangle: tuple[float, float, float, float]
) -> None:
    scene = busy_scene(97, 65, samples=2)
    scene.basicrt.tile_size = 16
    whole = render(tmp_path)
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = rectangle[:2]
    scene.render.border_min_y, scene.render.border_max_y = rectangle[2:]
    left, right = int(scene.render.border_min_x * 97), int(scene.render.border_max_x * 97)
    low, high = int(scene.render.border_min_y * 65), int(scene.render.border_max_y * 65)
    part = whole[low:high, left:right]

    scene.render.use_crop_to_border = True
    cropped = render(tmp_path)
    np.testing.assert_array_equal(cropped, part)

    scene.render.use_crop_to_border = False
    uncropped = render(tmp_path)
    assert uncropped.shape == whole.shape
    np.testing.assert_array_equal(uncropped[low:high, left:right], part)
    uncropped[low:high, left:right] = 0
    assert not uncropped.any(), "something outside the border"


# ---- view layers, frames -----------------------------------------------------------------------


def test_each_view_layer_has_its_own_objects_and_passes(tmp_path: Path) -> None:
    scene = new_scene(8, 8)
    add_camera(ortho_scale=0.5)
    for name, color in (("Red", (1, 0, 0)), ("Green", (0, 1, 0))):
        collection = bpy.data.collections.new(name)
        scene.collection.children.link(collection)
        made = add_plane(2, 0, emissive(color))
        scene.collection.objects.unlink(made)
        collection.objects.link(made)
    first = scene.view_layers[0]
    first.name = "First"
    second = scene.view_layers.new("Second")
    first.layer_collection.children["Green"].exclude = True
    second.layer_collection.children["Red"].exclude = True
    second.use_pass_z = True
    passes = render_passes(tmp_path)
    assert set(passes) - {"Composite.Combined"} == {
        "First.Combined",
        "Second.Combined",
        "Second.Depth",
    }
    np.testing.assert_allclose(passes["First.Combined"][4, 4], (1, 0, 0, 1), atol=1e-6)
    np.testing.assert_allclose(passes["Second.Combined"][4, 4], (0, 1, 0, 1), atol=1e-6)


def test_animation_renders_each_frame_anew(tmp_path: Path) -> None:
    scene = new_scene(8, 8)
    material = emissive((1, 1, 1))
    strength = next(n for n in material.node_tree.nodes if n.type == "EMISSION").inputs["Strength"]
    for frame, value in ((1, 1.0), (2, 3.0)):
        strength.default_value = value
        strength.keyframe_insert("default_value", frame=frame)
    made = add_plane(2, 0, material)
    for frame, x in ((1, 0.0), (2, 0.25)):
        made.location.x = x
        made.keyframe_insert("location", frame=frame)
    add_camera(ortho_scale=0.5)
    scene.frame_start, scene.frame_end = 1, 2
    set_exr(scene)
    scene.render.use_file_extension = True
    scene.render.filepath = str(tmp_path / "frame_####")
    bpy.ops.render.render(animation=True)
    for frame, value in ((1, 1.0), (2, 3.0)):
        with OpenEXR.File(str(tmp_path / f"frame_{frame:04}.exr")) as file:
            pixels = file.channels()["RGBA"].pixels
        np.testing.assert_allclose(pixels[4, 4, :3], value, rtol=1e-5)


def test_persistent_data_gives_the_same_picture(tmp_path: Path) -> None:
    scene = busy_scene()
    expected = render(tmp_path)
    scene.render.use_persistent_data = True
    np.testing.assert_array_equal(render(tmp_path), expected)
    bpy.data.objects["Sphere"].location.x += 0.5
    moved = render(tmp_path)
    scene.render.use_persistent_data = False
    np.testing.assert_array_equal(render(tmp_path), moved)
    assert np.abs(moved - expected).max() > 0.1


# ---- determinism -------------------------------------------------------------------------------


def test_threads_and_tiles_do_not_change_a_byte(tmp_path: Path) -> None:
    scene = busy_scene()
    expected = render(tmp_path)
    scene.render.threads, scene.basicrt.tile_size = 1, 17
    np.testing.assert_array_equal(render(tmp_path), expected)
    scene.basicrt.bvh_builder = "MEDIAN"
    np.testing.assert_array_equal(render(tmp_path), expected)


def test_seed_changes_the_noise(tmp_path: Path) -> None:
    scene = busy_scene()
    expected = render(tmp_path)
    scene.basicrt.seed = 1
    assert (render(tmp_path) != expected).any()
