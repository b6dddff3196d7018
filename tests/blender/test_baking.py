# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Bake with BasicRT, against the Cycles of the same Blender and against what is known."""

import math
import time
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from addon import compat
from addon.engine import BasicRTRenderEngine

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
from support.cycles import SEEDS, expect_alike, neutral_scene

only_in_one_version = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)
SIZE = 16


def target_image(material: Any, size: int = SIZE, name: str = "Baked") -> Any:
    """An image that is baked into, in the material's active node."""
    image = bpy.data.images.new(name, size, size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    return image


def pixels_of(image: Any) -> np.ndarray:
    """(height, width, 4)."""
    values = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)


def select(*objects: Any) -> None:
    """The last one is active."""
    bpy.ops.object.select_all(action="DESELECT")
    for one in objects:
        one.select_set(True)
    bpy.context.view_layer.objects.active = objects[-1]


def bake(image: Any, kind: str, **options: Any) -> np.ndarray:
    """What is baked of the selected objects: (height, width, 4)."""
    assert bpy.ops.object.bake(type=kind, margin=0, **options) == {"FINISHED"}
    return pixels_of(image)


def both(scene: Any, image: Any, kind: str, **options: Any) -> tuple[np.ndarray, np.ndarray]:
    """Ours and Cycles': (seeds, height, width, 4)."""
    stacks = []
    for engine in ("BASICRT", "CYCLES"):
        scene.render.engine = engine
        stack = []
        for seed in range(SEEDS):
            scene.cycles.seed = seed
            stack.append(bake(image, kind, **options).astype(float))
        stacks.append(np.array(stack))
    return stacks[0], stacks[1]


def add_sheet(material: Any, name: str = "Sheet") -> Any:
    """A smooth hill over the whole of its texture."""
    count = 8
    steps = np.linspace(-1, 1, count + 1)
    vertices = [
        (float(x), float(y), 0.4 * math.cos(1.2 * float(x)) * math.cos(1.5 * float(y)))
        for y in steps
        for x in steps
    ]
    faces = [
        (
            row * (count + 1) + i,
            row * (count + 1) + i + 1,
            (row + 1) * (count + 1) + i + 1,
            (row + 1) * (count + 1) + i,
        )
        for row in range(count)
        for i in range(count)
    ]
    sheet = add_mesh(vertices, faces, material, name)
    sheet.data.shade_smooth()
    layer = sheet.data.uv_layers.new(name="UVMap")
    for loop in sheet.data.loops:
        x, y, _z = vertices[loop.vertex_index]
        layer.data[loop.index].uv = (0.5 + 0.5 * x, 0.5 + 0.5 * y)
    return sheet


def paint() -> Any:
    """Reflects in both ways, transmits and shines."""
    return new_material(
        "ShaderNodeBsdfPrincipled",
        "Paint",
        Base_Color=(0.7, 0.4, 0.2),
        Roughness=0.5,
        Transmission_Weight=0.4,
        Emission_Color=(0.2, 0.4, 1),
        Emission_Strength=0.3,
    )


def bumpy() -> Any:
    material, tree, output = empty_material("Bumpy")
    shader = add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8))
    bump = add_node(tree, "ShaderNodeBump", Strength=1.0, Distance=0.3)
    waves = add_node(tree, "ShaderNodeTexWave", Scale=0.4)
    tree.links.new(waves.outputs["Fac"], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], shader.inputs["Normal"])
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def shiny() -> Any:
    return new_material("ShaderNodeBsdfAnisotropic", Color=(0.8, 0.8, 0.8), Roughness=0.3)


def lit_sheet(make: Callable[[], Any] = paint, samples: int = 128) -> tuple[Any, Any]:
    """A sheet under a lamp, a sky, and something that shades and reddens it; the scene and its image."""
    scene = neutral_scene(SIZE, samples)
    material = make()
    sheet = add_sheet(material)
    sheet.location, sheet.rotation_euler, sheet.scale = (
        (0.2, 0.1, 0.3),
        (0.2, 0.1, 0.4),
        (1, 1.3, 1),
    )
    wall = add_plane(2, 0.8, new_material("ShaderNodeBsdfDiffuse", "Wall", Color=(0.8, 0.2, 0.1)))
    wall.location, wall.rotation_euler = (-1.2, 0, 0.8), (0, math.radians(70), 0)
    add_lamp("AREA", (1.5, -0.5, 2.5), (0.2, 0.5, 0), energy=60, size=1)
    set_world((0.3, 0.4, 0.5), 0.5)
    for made in scene.objects:
        if made.type == "MESH":
            made.shadow_terminator_geometry_offset = 0
    select(sheet)
    return scene, target_image(material)


LIGHT = [
    ("COMBINED", {"DIRECT", "INDIRECT", "DIFFUSE", "GLOSSY", "TRANSMISSION", "EMIT"}),
    ("COMBINED", {"DIRECT", "DIFFUSE", "EMIT"}),
    ("COMBINED", {"EMIT"}),
    ("DIFFUSE", {"DIRECT", "INDIRECT", "COLOR"}),
    ("DIFFUSE", {"DIRECT", "INDIRECT"}),
    ("DIFFUSE", {"DIRECT"}),
    ("DIFFUSE", {"INDIRECT", "COLOR"}),
    ("DIFFUSE", {"COLOR"}),
    ("GLOSSY", {"DIRECT", "INDIRECT", "COLOR"}),
    ("GLOSSY", {"COLOR"}),
    ("TRANSMISSION", {"DIRECT", "INDIRECT", "COLOR"}),
    ("TRANSMISSION", {"COLOR"}),
    ("EMIT", {"EMIT"}),
    ("AO", {"EMIT"}),
    ("ROUGHNESS", {"EMIT"}),
    ("ENVIRONMENT", {"EMIT"}),
]


@only_in_one_version
@pytest.mark.parametrize(
    ("kind", "contents"),
    LIGHT,
    ids=lambda value: "+".join(sorted(value)) if isinstance(value, set) else value,
)
def test_light_is_baked_as_by_cycles(kind: str, contents: set[str]) -> None:
    scene, image = lit_sheet()
    ours, theirs = both(scene, image, kind, pass_filter=contents)
    expect_alike(ours, theirs, relative=0.02)


@only_in_one_version
@pytest.mark.parametrize("kind", ["COMBINED", "GLOSSY"])
def test_seen_from_the_camera_as_by_cycles(kind: str) -> None:
    scene, image = lit_sheet(shiny)
    add_camera((3, -2, 0.9), (1.3, 0, 1.0), kind="PERSP")
    scene.render.bake.view_from = "ACTIVE_CAMERA"
    expect_alike(*both(scene, image, kind), relative=0.03)


@only_in_one_version
@pytest.mark.parametrize("space", ["OBJECT", "TANGENT"])
@pytest.mark.parametrize("make", [paint, bumpy])
def test_normals_are_cycles_pixel_by_pixel(space: str, make: Callable[[], Any]) -> None:
    scene, image = lit_sheet(make, samples=1)
    swizzle = {"normal_r": "NEG_Y", "normal_g": "POS_Z", "normal_b": "POS_X"}
    ours, theirs = both(scene, image, "NORMAL", normal_space=space, **swizzle)
    difference = np.abs(ours[0] - theirs[0])
    assert np.median(difference) < 1e-3
    assert np.percentile(difference, 95) < (0.02 if make is bumpy else 1e-3)


@only_in_one_version
def test_places_are_cycles_pixel_by_pixel() -> None:
    """Texture coordinates are not compared: Cycles 5.0 bakes zeros where no node asks for them."""
    _scene, image = lit_sheet(samples=1)
    ours, theirs = both(bpy.context.scene, image, "POSITION")
    np.testing.assert_allclose(ours[0], theirs[0], atol=2e-3)


def matt() -> Any:
    return new_material("ShaderNodeBsdfDiffuse", "Matt", Color=(0.7, 0.6, 0.5))


@only_in_one_version
def test_a_shadow_as_by_cycles() -> None:
    scene, image = lit_sheet(matt)
    expect_alike(*both(scene, image, "SHADOW"), relative=0.02)


@only_in_one_version
def test_indirect_light_is_that_of_its_kinds() -> None:
    """Not compared: Cycles' Combined of indirect light has a share of the world's direct light in it."""
    scene, image = lit_sheet()
    scene.render.engine = "BASICRT"
    whole = bake(image, "COMBINED", pass_filter={"INDIRECT", "DIFFUSE", "GLOSSY"})[..., :3]
    parts = [
        bake(image, kind, pass_filter={"INDIRECT", "COLOR"})[..., :3]
        for kind in ("DIFFUSE", "GLOSSY")
    ]
    assert whole.mean() > 0.002
    assert abs((parts[0] + parts[1]).mean() / whole.mean() - 1) < 0.05


@only_in_one_version
@pytest.mark.parametrize("kind", ["DIFFUSE", "NORMAL"])
def test_selected_to_active_as_by_cycles(kind: str) -> None:
    scene, _image = lit_sheet()
    source = bpy.context.object
    material = new_material("ShaderNodeBsdfDiffuse", "Flat")
    image = target_image(material, name="Of others")
    flat = add_plane(2, 0, material, "Flat")
    flat.location, flat.rotation_euler, flat.scale = (
        source.location,
        source.rotation_euler,
        source.scale,
    )
    layer = flat.data.uv_layers.new(name="UVMap")
    for loop, uv in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        layer.data[loop].uv = uv
    bpy.context.view_layer.update()
    select(source, flat)
    options = {"use_selected_to_active": True, "cage_extrusion": 0.6, "normal_space": "OBJECT"}
    ours, theirs = both(scene, image, kind, **options)
    assert theirs.any()
    expect_alike(ours, theirs, relative=0.02)


def colors_of(made: Any) -> np.ndarray:
    """(corners, 4) of the active colour attribute."""
    attribute = made.data.color_attributes.active_color
    values = np.empty(len(attribute.data) * 4, np.float32)
    attribute.data.foreach_get("color", values)
    return values.reshape(-1, 4)


@only_in_one_version
def test_colours_of_vertices_as_by_cycles() -> None:
    scene, _image = lit_sheet(samples=64)
    sheet = bpy.context.object
    sheet.data.color_attributes.new("Baked", "FLOAT_COLOR", "CORNER")
    sheet.data.color_attributes.active_color_index = 0
    means = []
    for engine in ("BASICRT", "CYCLES"):
        scene.render.engine = engine
        stack = []
        for seed in range(SEEDS):
            scene.cycles.seed = seed
            assert bpy.ops.object.bake(type="DIFFUSE", target="VERTEX_COLORS") == {"FINISHED"}
            stack.append(colors_of(sheet))
        means.append(np.mean(stack, axis=0))
    ours, theirs = means
    assert theirs[:, :3].mean() > 0.05
    np.testing.assert_allclose(ours.mean(axis=0), theirs.mean(axis=0), rtol=0.02)
    assert np.abs(ours - theirs).mean() < 0.1 * theirs.mean()


def flat_scene() -> tuple[Any, Any, Any]:
    """A square of known reflectance under an even sky; no camera. The scene, the square and its image."""
    scene = neutral_scene(SIZE, samples=16)
    scene.render.engine = "BASICRT"
    set_world((0.4, 0.8, 1.2))
    material = new_material("ShaderNodeBsdfDiffuse", "Flat", Color=(0.5, 0.25, 0.75))
    flat = add_plane(2, 0, material)
    layer = flat.data.uv_layers.new(name="UVMap")
    for loop, uv in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        layer.data[loop].uv = uv
    select(flat)
    return scene, flat, target_image(material)


REFLECTED = np.float32((0.2, 0.2, 0.9, 1))


def test_every_version_bakes_into_images() -> None:
    scene, _flat, image = flat_scene()
    picture = bake(image, "COMBINED")
    np.testing.assert_allclose(picture, np.broadcast_to(REFLECTED, picture.shape), rtol=1e-4)
    normal = bake(image, "NORMAL", normal_space="TANGENT")
    np.testing.assert_allclose(
        normal[..., :3], np.broadcast_to((0.5, 0.5, 1), (SIZE, SIZE, 3)), atol=1e-3
    )
    place = (np.arange(SIZE) + 0.5) / SIZE
    scene.cycles.samples = 1  # in the middle of its pixel
    uv = bake(image, "UV")
    np.testing.assert_allclose(uv[..., 0], np.broadcast_to(place, (SIZE, SIZE)), atol=1e-3)
    np.testing.assert_allclose(uv[..., 1], np.broadcast_to(place[:, None], (SIZE, SIZE)), atol=1e-3)


@pytest.mark.parametrize("domain", ["CORNER", "POINT"])
def test_every_version_bakes_into_colours_of_vertices(domain: str) -> None:
    _scene, flat, _image = flat_scene()
    flat.data.color_attributes.new("Baked", "FLOAT_COLOR", domain)
    flat.data.color_attributes.active_color_index = 0
    assert bpy.ops.object.bake(type="COMBINED", target="VERTEX_COLORS") == {"FINISHED"}
    np.testing.assert_allclose(colors_of(flat), np.broadcast_to(REFLECTED, (4, 4)), rtol=1e-3)


def test_each_material_has_its_image() -> None:
    _scene, flat, first = flat_scene()
    material = new_material("ShaderNodeEmission", "Other", Color=(1, 0.5, 0.25))
    second = target_image(material, 8, "Second")
    other = add_plane(2, 1, material)
    other.location.x = 50
    flat.select_set(True)
    other.select_set(True)
    bpy.context.view_layer.objects.active = flat
    bpy.ops.object.join()
    layer = flat.data.uv_layers.active
    for corner, uv in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)) * 2):
        layer.data[corner].uv = uv
    picture = bake(first, "COMBINED")
    np.testing.assert_allclose(picture, np.broadcast_to(REFLECTED, picture.shape), rtol=0.05)
    expected = np.broadcast_to(np.float32((1, 0.5, 0.25, 1)), (8, 8, 4))
    np.testing.assert_allclose(pixels_of(second), expected, rtol=1e-5)


def test_modifiers_are_baked_too() -> None:
    scene, flat, image = flat_scene()
    flat.modifiers.new("Array", "ARRAY").count = 2
    finer = flat.modifiers.new("Finer", "SUBSURF")
    finer.subdivision_type, finer.uv_smooth = "SIMPLE", "NONE"
    scene.cycles.samples = 1  # in the middle of its pixel
    uv = bake(image, "UV")
    place = (np.arange(SIZE) + 0.5) / SIZE
    np.testing.assert_allclose(uv[..., 0], np.broadcast_to(place, (SIZE, SIZE)), atol=1e-3)


def test_the_same_for_any_number_of_threads() -> None:
    scene, _flat, image = flat_scene()
    wall = add_plane(1, 0.5, new_material("ShaderNodeBsdfDiffuse", "Wall"))
    wall.rotation_euler = (1, 0, 0)
    scene.render.threads = 1
    first = bake(image, "COMBINED")
    scene.render.threads = 3
    assert bake(image, "COMBINED").tobytes() == first.tobytes()


def test_a_bake_after_a_render_and_with_motion_blur(tmp_path: Any) -> None:
    scene, flat, image = flat_scene()
    add_camera((0, 0, 5))
    scene.render.use_motion_blur = True
    flat.keyframe_insert("location", frame=0)
    scene.render.filepath = str(tmp_path / "picture.png")
    bpy.ops.render.render(write_still=True)
    picture = bake(image, "COMBINED")
    np.testing.assert_allclose(picture, np.broadcast_to(REFLECTED, picture.shape), rtol=1e-4)


def test_a_bake_can_be_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, _flat, image = flat_scene()
    scene.cycles.samples = 1 << 20
    monkeypatch.setattr(BasicRTRenderEngine, "_is_cancelled", lambda _: True)
    begin = time.monotonic()
    bpy.ops.object.bake(type="COMBINED", margin=0)
    assert time.monotonic() - begin < 30  # all of it would take many minutes
    assert not pixels_of(image)[..., :3].any()


def test_what_cannot_be_baked_is_told() -> None:
    _scene, flat, _image = flat_scene()
    flat.data.vertices[0].co.x = math.nan
    with pytest.raises(RuntimeError, match=r'object "Plane": .*finite'):
        bpy.ops.object.bake(type="COMBINED", margin=0)


def test_the_panel_offers_what_cycles_offers() -> None:
    own = {
        item.identifier
        for item in bpy.context.scene.basicrt.bl_rna.properties["bake_type"].enum_items
    }
    assert own == {
        item.identifier
        for item in bpy.context.scene.cycles.bl_rna.properties["bake_type"].enum_items
    }
    scene = bpy.context.scene
    scene.basicrt.property_unset("bake_type")
    scene.cycles.bake_type = "GLOSSY"
    from addon.properties.choice import Choice

    assert Choice(scene).bake_type == "GLOSSY"
    assert issubclass(bpy.types.BASICRT_RENDER_PT_bake, bpy.types.Panel)


def test_names_of_the_pass_in_each_version() -> None:
    expected = "Ambient Occlusion" if bpy.app.version >= (5, 0) else "AO"
    assert compat.pass_name("Ambient Occlusion") == expected
