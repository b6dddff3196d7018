# SPDX-License-Identifier: GPL-3.0-or-later
"""Image Texture nodes: what becomes of their images and settings, and the same values as in Cycles."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.nodes import Textures, translate_surface
from addon.report import Report

import basicrt
from support.blender import (
    add_camera,
    add_mesh,
    add_node,
    empty_material,
    export,
    new_image,
    new_material,
    new_scene,
    render_both,
    set_world,
)
from support.surfaces import add_ball

RAMP = np.array([[[0.1, 0.9, 0.5, 1], [0.8, 0.2, 0.3, 1], [0.4, 0.6, 1, 1]]])


@pytest.fixture(autouse=True)
def scene() -> Any:
    return new_scene()


def textured_material(
    image: Any, bl_idname: str = "ShaderNodeEmission", socket: str = "Color", **settings: Any
) -> tuple[Any, Any]:
    """A material of one shader with an image at an input, and the texture node."""
    material = new_material(bl_idname)
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.bl_idname == bl_idname)
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    for name, value in settings.items():
        setattr(texture, name, value)
    tree.links.new(texture.outputs["Color"], shader.inputs[socket])
    return material, texture


def translate(material: Any, *expected_warnings: str) -> tuple[Any, Any]:
    """The translated material and the scene with its textures."""
    made = basicrt.Scene()
    report = Report()
    translated = translate_surface(material, report, Textures(made))
    assert report.warnings == tuple(
        f'material "{material.name}": {text}' for text in expected_warnings
    )
    return translated, made


def only_texture(material: Any, *expected_warnings: str) -> Any:
    _translated, made = translate(material, *expected_warnings)
    (texture,) = made.textures
    return texture


# ---- what becomes of images ----------------------------------------------------------------------


def test_bytes_stay_bytes() -> None:
    image = new_image(RAMP, "sRGB", is_float=False)
    texture = only_texture(textured_material(image)[0])
    assert texture.image.pixels.dtype == np.uint8
    assert texture.image.encoding == "srgb"
    assert np.array_equal(texture.image.pixels, np.floor(RAMP[..., :3] * 255 + 0.5))


def test_non_color_bytes_are_linear() -> None:
    image = new_image(RAMP, "Non-Color", is_float=False)
    assert only_texture(textured_material(image)[0]).image.encoding == "linear"


def test_floats_stay_floats() -> None:
    texture = only_texture(textured_material(new_image(RAMP * 4))[0])
    assert texture.image.pixels.dtype == np.float32
    assert np.allclose(texture.image.pixels, RAMP[..., :3] * 4)


def test_infinities_become_black() -> None:
    pixels = RAMP.copy()
    pixels[0, 1, :2] = np.inf, np.nan
    made = only_texture(textured_material(new_image(pixels))[0]).image.pixels
    assert np.array_equal(made[0, 1, :2], [0, 0])


@pytest.mark.parametrize(
    ("interpolation", "ours"),
    [("Linear", "linear"), ("Closest", "closest"), ("Cubic", "cubic"), ("Smart", "cubic")],
)
def test_interpolation(interpolation: str, ours: str) -> None:
    material, _ = textured_material(new_image(RAMP), interpolation=interpolation)
    assert only_texture(material).interpolation == ours


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
def test_extension(extension: str) -> None:
    material, _ = textured_material(new_image(RAMP), extension=extension)
    assert only_texture(material).extension == extension.lower()


def test_materials_share_images_and_equal_textures() -> None:
    image = new_image(RAMP)
    made = basicrt.Scene()
    textures = Textures(made)
    for extension in ("REPEAT", "REPEAT", "CLIP"):
        material, _ = textured_material(image, extension=extension)
        translate_surface(material, Report(), textures)
    assert len(made.textures) == 2
    first, second = (texture.image.pixels for texture in made.textures)
    assert first.__array_interface__["data"] == second.__array_interface__["data"]


def test_an_image_that_is_missing_is_magenta(tmp_path: Path) -> None:
    image = bpy.data.images.new("Lost", 4, 4)
    image.source = "FILE"
    image.filepath = str(tmp_path / "nowhere.png")
    image.reload()
    texture = only_texture(
        textured_material(image)[0],
        'node "Image Texture": image "Lost" can\'t be read: drawn magenta',
    )
    assert texture.color == (1, 0, 1)


def test_a_node_without_image_is_magenta() -> None:
    texture = only_texture(
        textured_material(None)[0], 'node "Image Texture": has no image: drawn magenta'
    )
    assert texture.color == (1, 0, 1)


def test_images_over_other_coordinates_are_operations() -> None:
    material, texture = textured_material(new_image(RAMP))
    tree = material.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Object"], texture.inputs["Vector"])
    translated, _scene = translate(material)
    kinds = [type(operation) for operation in translated.operations]
    assert kinds == [basicrt.SurfaceOperation, basicrt.TextureOperation]
    assert translated.operations[0].value == "object_position"


# ---- where they may be ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bl_idname", "socket", "field"),
    [
        ("ShaderNodeBsdfDiffuse", "Color", "color"),
        ("ShaderNodeBsdfAnisotropic", "Color", "color"),
        ("ShaderNodeBsdfGlass", "Color", "T"),
        ("ShaderNodeBsdfTransparent", "Color", "color"),
        ("ShaderNodeEmission", "Color", "radiance"),
        ("ShaderNodeBsdfPrincipled", "Base Color", "base_color"),
        ("ShaderNodeBsdfPrincipled", "Emission Color", "emission"),
    ],
)
def test_colours_take_images(bl_idname: str, socket: str, field: str) -> None:
    material, _ = textured_material(new_image(RAMP), bl_idname, socket)
    translated, _made = translate(material)
    assert getattr(translated.nodes[0], field) == basicrt.TextureRef(0)


def test_alpha_takes_an_image_s_alpha() -> None:
    material, texture = textured_material(
        new_image(RAMP * 0.5), "ShaderNodeBsdfPrincipled", "Base Color"
    )
    tree = material.node_tree
    shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    translated, _made = translate(material)
    assert translated.nodes[0].alpha == basicrt.TextureRef(0, alpha=True)


def test_mix_takes_an_image_as_factor() -> None:
    material, tree, output = empty_material()
    mix = tree.nodes.new("ShaderNodeMixShader")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = new_image(RAMP)
    tree.links.new(texture.outputs["Color"], mix.inputs[0])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    translated, _made = translate(material)
    assert translated.nodes[0].factor == basicrt.TextureRef(0)


def test_numbers_take_images() -> None:
    material, _ = textured_material(new_image(RAMP), "ShaderNodeBsdfAnisotropic", "Roughness")
    translated, _scene = translate(material)
    assert translated.nodes[0].roughness == basicrt.TextureRef(0)


# ---- as in Cycles --------------------------------------------------------------------------------


def add_strip(material: Any) -> Any:
    """A square seen from above, whose u runs from -1 to 2 and whose v from 0.2 to 0.9."""
    strip = add_mesh([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)], material)
    layer = strip.data.uv_layers.new()
    for item, uv in zip(layer.uv, [(-1, 0.2), (2, 0.2), (2, 0.9), (-1, 0.9)], strict=True):
        item.vector = uv
    return strip


def assert_same_as_cycles(folder: Path) -> None:
    """But for what the picture changes within a hundredth of a pixel: so far do samples stray."""
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 24
    add_camera((0, 0, 3), ortho_scale=2.0)
    ours, theirs = render_both(folder)
    assert theirs[..., :3].std() > 0.01, "the picture must show something"
    assert (np.abs(ours - theirs) < 0.01 + 0.02 * np.abs(theirs))[..., :3].all()


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
@pytest.mark.parametrize("interpolation", ["Linear", "Cubic"])
def test_lookups_are_as_in_cycles(interpolation: str, extension: str, tmp_path: Path) -> None:
    picture = np.random.default_rng(3).random((5, 4, 4))
    picture[..., 3] = 1
    image = new_image(picture, "sRGB", is_float=False)
    material, _ = textured_material(image, interpolation=interpolation, extension=extension)
    add_strip(material)
    assert_same_as_cycles(tmp_path)


@pytest.mark.parametrize("is_float", [False, True])
@pytest.mark.parametrize("alpha_mode", ["STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"])
@pytest.mark.parametrize("is_alpha_used", [False, True])
def test_alpha_is_as_in_cycles(
    is_float: bool, alpha_mode: str, is_alpha_used: bool, tmp_path: Path
) -> None:
    if bpy.app.version >= (5, 2) and alpha_mode == ("STRAIGHT" if is_float else "PREMUL"):
        # It multiplies straight floats once more, and takes bytes that Blender divided by alpha as they are. With the
        # same picture in a file it does neither.
        pytest.skip("the Cycles of Blender 5.2 means something else by images in memory")
    picture = np.random.default_rng(4).random((5, 4, 4))
    image = new_image(picture, "sRGB", is_float=is_float)
    image.alpha_mode = alpha_mode
    material, texture = textured_material(image)
    if is_alpha_used:
        tree = material.node_tree
        output = tree.get_output_node("CYCLES")
        mix = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(texture.outputs["Alpha"], mix.inputs[0])
        emission = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeEmission")
        other = add_node(tree, "ShaderNodeEmission", Color=(0.2, 0.4, 0.6))
        tree.links.new(other.outputs[0], mix.inputs[1])
        tree.links.new(emission.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])
    add_strip(material)
    assert_same_as_cycles(tmp_path)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR"])
def test_mapping_is_as_in_cycles(kind: str, tmp_path: Path) -> None:
    picture = np.random.default_rng(5).random((5, 4, 4))
    material, texture = textured_material(new_image(picture), extension="REPEAT")
    tree = material.node_tree
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.vector_type = kind
    if kind != "VECTOR":
        mapping.inputs["Location"].default_value = (0.3, -0.2, 0.7)
    mapping.inputs["Rotation"].default_value = (0.4, 0.3, 0.9)
    mapping.inputs["Scale"].default_value = (1.5, 0.7, 2)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    add_strip(material)
    assert_same_as_cycles(tmp_path)


@pytest.mark.parametrize(
    ("projection", "blend"), [("BOX", 0.0), ("BOX", 0.4), ("BOX", 1.0), ("SPHERE", 0), ("TUBE", 0)]
)
@pytest.mark.parametrize("is_backwards", [False, True])
def test_projections_are_as_in_cycles(
    projection: str, blend: float, is_backwards: bool, tmp_path: Path
) -> None:
    columns, rows = np.meshgrid(np.linspace(0.1, 0.9, 16), np.linspace(0.2, 0.8, 16))
    picture = np.stack([columns, rows, columns * rows, np.ones((16, 16))], axis=2)
    material, texture = textured_material(
        new_image(picture), extension="EXTEND", projection=projection, projection_blend=blend
    )
    tree = material.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], texture.inputs["Vector"])
    made = add_ball(material, is_smooth=True)
    made.rotation_euler = (0.5, 0.4, 0.3)
    if is_backwards:
        made.data.flip_normals()
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 24
    add_camera((0, 0, 3), ortho_scale=1.2)
    ours, theirs = render_both(tmp_path)
    differs = np.abs(ours - theirs)[..., :3].max(axis=2) > 0.004 + 0.01 * theirs.max(axis=2)
    # A sample on the other side of an edge between sides, or of the seam.
    assert differs.mean() < 0.02, np.abs(ours - theirs)[..., :3].max()


def test_an_unlinked_mapping_maps_its_own_vector(tmp_path: Path) -> None:
    material, texture = textured_material(new_image(RAMP))
    tree = material.node_tree
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Vector"].default_value = (0.4, 0.5, 0)
    mapping.inputs["Location"].default_value = (0.4, 0, 0)
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    transform = only_texture(material).uv_transform
    assert np.allclose(transform @ (0.1, 0.7, 0, 1), (0.8, 0.5, 0, 1))


def test_cut_out_leaves_show_what_is_behind(tmp_path: Path) -> None:
    set_world((0.2, 0.5, 0.7))
    picture = np.random.default_rng(6).random((5, 4, 4))
    picture[..., 3] = picture[..., 3] > 0.5
    material, texture = textured_material(
        new_image(picture, "sRGB", is_float=False),
        "ShaderNodeBsdfPrincipled",
        "Emission Color",
        interpolation="Closest",
    )
    tree = material.node_tree
    shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    shader.inputs["Emission Strength"].default_value = 1
    shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
    shader.inputs["Specular IOR Level"].default_value = 0
    tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    add_strip(material)
    assert_same_as_cycles(tmp_path)


def test_only_the_scene_s_own_textures_are_exported() -> None:
    add_strip(textured_material(new_image(RAMP))[0])
    textured_material(new_image(RAMP, name="Unused"))
    add_camera()
    assert len(export().textures) == 1


# ---- images of many pictures ---------------------------------------------------------------------


def save(path: Path, seed: int, is_opaque: bool = True) -> None:
    """A small picture of random colours."""
    picture = np.random.default_rng(seed).random((4, 4, 4))
    if is_opaque:
        picture[..., 3] = 1
    image = new_image(picture, "sRGB", is_float=False)
    image.filepath_raw = str(path)
    image.file_format = "PNG"
    image.save()


def sequence(folder: Path, numbers: range) -> Any:
    for number in numbers:
        save(folder / f"drop 2.{number:03d}.png", number)
    image = bpy.data.images.load(str(folder / f"drop 2.{numbers[0]:03d}.png"))
    image.source = "SEQUENCE"
    return image


@pytest.mark.parametrize("is_cyclic", [False, True])
@pytest.mark.parametrize("frame", [-3, 10, 12, 17])
def test_a_sequence_shows_the_frame_that_cycles_shows(
    frame: int, is_cyclic: bool, tmp_path: Path
) -> None:
    material, texture = textured_material(sequence(tmp_path, range(3, 8)))
    user = texture.image_user
    user.frame_start, user.frame_duration, user.frame_offset = 9, 4, 3
    user.use_cyclic = is_cyclic
    user.use_auto_refresh = True
    add_strip(material)
    bpy.context.scene.frame_set(frame)
    assert_same_as_cycles(tmp_path)


def test_a_sequence_follows_the_scene(tmp_path: Path) -> None:
    material, texture = textured_material(sequence(tmp_path, range(1, 4)))
    texture.image_user.frame_duration = 3
    add_strip(material)
    add_camera()
    pictures = []
    for frame in (1, 2):
        bpy.context.scene.frame_set(frame)
        (made,) = export().textures
        pictures.append(made.image.pixels)
    assert not np.array_equal(*pictures)


def test_a_frame_that_is_not_there_is_told_of(tmp_path: Path) -> None:
    material, texture = textured_material(sequence(tmp_path, range(1, 2)))
    texture.image_user.frame_duration = 5
    texture.image_user.frame_offset = 6
    translated = Textures(basicrt.Scene())
    report = Report()
    translate_surface(material, report, translated)
    (warning,) = report.warnings
    assert "drop 2.007.png can't be read: drawn magenta" in warning


def tiled_image(folder: Path, *numbers: int, is_opaque: bool = True) -> Any:
    for number in numbers:
        save(folder / f"skin.{number}.png", number, is_opaque)
    image = bpy.data.images.load(str(folder / f"skin.{numbers[0]}.png"))
    image.source = "TILED"
    image.filepath_raw = str(folder / "skin.<UDIM>.png")
    image.reload()
    for number in numbers:
        if number not in [tile.number for tile in image.tiles]:
            image.tiles.new(number)
    return image


@pytest.mark.parametrize("is_alpha", [False, True])
def test_tiles_are_as_in_cycles(is_alpha: bool, tmp_path: Path) -> None:
    """The strip goes over tiles that are there and tiles that are not."""
    material, texture = textured_material(
        tiled_image(tmp_path, 1001, 1002, 1011, 1013, is_opaque=not is_alpha)
    )
    tree = material.node_tree
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Scale"].default_value = (3.7, 2.4, 1)
    mapping.inputs["Location"].default_value = (-0.3, -0.2, 0)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    if is_alpha:
        shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeEmission")
        tree.links.new(texture.outputs["Alpha"], shader.inputs["Color"])
    texture.interpolation = "Closest"
    add_strip(material)
    assert_same_as_cycles(tmp_path)


def test_packed_tiles_are_told_of(tmp_path: Path) -> None:
    image = tiled_image(tmp_path, 1001, 1002)
    image.pack()
    report = Report()
    translate_surface(textured_material(image)[0], report, Textures(basicrt.Scene()))
    assert any("packed or unsaved UDIM tiles are not supported" in text for text in report.warnings)
