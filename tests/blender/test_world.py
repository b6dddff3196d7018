# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds: what becomes of their nodes, and the same pictures as in Cycles."""

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

from support.blender import (
    add_camera,
    add_node,
    add_plane,
    export,
    make_cycles_neutral,
    new_image,
    new_material,
    new_scene,
    render,
    render_both,
    world_tree,
)

PICTURE = np.random.default_rng(7).random((8, 16, 4)) ** 2
DIRECTIONS = [(0.3, 0.2, 0.1), (1.4, 0.1, 0.7), (2.5, -0.3, 3), (1.7, 0, -1.2)]  # of cameras


@pytest.fixture(autouse=True)
def scene() -> Any:
    made = new_scene()
    add_camera()
    return made


def environment_world(image: Any = None, **settings: Any) -> tuple[Any, Any, Any]:
    """A world that shows an image: its tree, the background and the texture node."""
    tree, background = world_tree()
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image or new_image(PICTURE)
    for name, value in settings.items():
        setattr(texture, name, value)
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    return tree, background, texture


def add_mapping(tree: Any, texture: Any, output: str = "Generated", **values: Any) -> Any:
    mapping = add_node(tree, "ShaderNodeMapping", **values)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs[output], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    return mapping


def exported(*expected_warnings: str) -> Any:
    report = Report()
    environment = export(report).environment
    assert report.warnings == tuple(f'world "World": {text}' for text in expected_warnings)
    return environment


# ---- what becomes of nodes -----------------------------------------------------------------------


def test_an_image_becomes_a_layer() -> None:
    _tree, background, _texture = environment_world(interpolation="Cubic")
    background.inputs["Strength"].default_value = 2.5
    environment = exported()
    (layer,) = environment.layers
    assert environment.radiance == (0, 0, 0)
    assert layer.radiance == (2.5, 2.5, 2.5)
    assert np.allclose(layer.image.pixels, PICTURE)
    assert (layer.projection, layer.interpolation, layer.seen_by) == (
        "equirectangular",
        "cubic",
        "all",
    )
    assert np.array_equal(layer.transform, np.eye(4))


def test_mirror_balls() -> None:
    environment_world(projection="MIRROR_BALL")
    assert exported().layers[0].projection == "mirror_ball"


def test_a_mapping_turns_the_image() -> None:
    tree, _background, texture = environment_world()
    add_mapping(tree, texture, Rotation=(0, 0, math.pi / 2))
    turned = exported().layers[0].transform @ (1, 0, 0, 1)
    assert np.allclose(turned, (0, 1, 0, 1), atol=1e-6)


def light_path_mix(output: str = "Is Camera Ray") -> Any:
    """A world that is red for one kind of ray and blue for the others."""
    tree, background = world_tree()
    background.inputs["Color"].default_value = (0, 0, 1, 1)
    red = add_node(tree, "ShaderNodeBackground", Color=(1, 0, 0), Strength=2.0)
    mix = tree.nodes.new("ShaderNodeMixShader")
    path = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(path.outputs[output], mix.inputs[0])
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(red.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    return mix


def test_camera_rays_may_see_another_world() -> None:
    light_path_mix()
    layers = {layer.seen_by: layer.radiance for layer in exported().layers}
    assert layers == {"camera": (2, 0, 0), "scattered": (0, 0, 1)}


def test_other_kinds_of_rays_are_reported() -> None:
    light_path_mix("Is Glossy Ray").inputs[0].default_value = 0.25
    environment = exported(
        'node "Mix Shader": Fac is linked to "Light Path", which is not supported: its own value is used'
    )
    assert environment.radiance == (0.5, 0, 0.75)


def test_mixes_and_sums_of_backgrounds() -> None:
    tree, background = world_tree()
    background.inputs["Color"].default_value = (0, 0, 1, 1)
    red = add_node(tree, "ShaderNodeBackground", Color=(1, 0, 0), Strength=2.0)
    mix, both = (
        add_node(tree, "ShaderNodeMixShader", Fac=0.25),
        tree.nodes.new("ShaderNodeAddShader"),
    )
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(red.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], both.inputs[0])
    tree.links.new(red.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    assert exported().radiance == (2.5, 0, 0.75)


def test_an_image_may_be_the_surface_itself() -> None:
    tree, _background, texture = environment_world()
    tree.links.new(texture.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    assert exported().layers[0].radiance == (1, 1, 1)


def test_a_world_without_strength_is_black() -> None:
    _tree, background, _texture = environment_world()
    background.inputs["Strength"].default_value = 0
    environment = exported()
    assert environment.radiance == (0, 0, 0)
    assert environment.layers == []


def test_an_unknown_colour_is_the_sockets_own_with_a_warning() -> None:
    tree, background = world_tree()
    background.inputs["Color"].default_value = (0.25, 0.5, 1, 1)
    tree.links.new(tree.nodes.new("ShaderNodeShaderToRGB").outputs[0], background.inputs["Color"])
    environment = exported(
        'node "Shader to RGB" is not supported in a world: the socket\'s own colour is used'
    )
    assert environment.radiance == (0.25, 0.5, 1)


# ---- as in Cycles --------------------------------------------------------------------------------


def assert_sky_is_as_in_cycles(folder: Path) -> None:
    """The world alone, through a wide lens, in several directions.

    But for what the picture changes within a hundredth of a pixel: so far do samples stray.
    """
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 24
    camera = scene.camera
    camera.data.type = "PERSP"
    camera.data.angle = 1.8
    for direction in DIRECTIONS:
        camera.rotation_euler = direction
        ours, theirs = render_both(folder)
        assert theirs[..., :3].std() > 0.01, "the picture must show something"
        difference = np.abs(ours - theirs)[..., :3]
        assert difference.mean() < 1e-3, direction
        assert difference.max() < 0.03, direction


@pytest.mark.parametrize("interpolation", ["Linear", "Cubic"])
@pytest.mark.parametrize("projection", ["EQUIRECTANGULAR", "MIRROR_BALL"])
def test_images_are_looked_up_as_in_cycles(
    projection: str, interpolation: str, tmp_path: Path
) -> None:
    environment_world(projection=projection, interpolation=interpolation)
    assert_sky_is_as_in_cycles(tmp_path)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR"])
def test_mapped_images_are_as_in_cycles(kind: str, tmp_path: Path) -> None:
    tree, _background, texture = environment_world()
    values = {"Rotation": (0.4, 0.3, 0.9), "Scale": (1.5, -0.7, 2)}
    if kind != "VECTOR":
        values["Location"] = (0.3, -0.2, 0.1)
    mapping = add_mapping(tree, texture)
    mapping.vector_type = kind
    for name, value in values.items():
        mapping.inputs[name].default_value = value
    assert_sky_is_as_in_cycles(tmp_path)


def test_object_coordinates_are_directions_too(tmp_path: Path) -> None:
    tree, _background, texture = environment_world()
    add_mapping(tree, texture, "Object", Rotation=(0.4, 0.3, 0.9))
    assert_sky_is_as_in_cycles(tmp_path)


def test_what_stands_between_image_and_background_is_as_in_cycles(tmp_path: Path) -> None:
    tree, background, texture = environment_world()
    gamma = tree.nodes.new("ShaderNodeGamma")
    gamma.inputs["Gamma"].default_value = 0.6
    tree.links.new(texture.outputs[0], gamma.inputs["Color"])
    tree.links.new(gamma.outputs[0], background.inputs["Color"])
    (layer,) = exported().layers
    assert layer.image.pixels.shape == (512, 1024, 3)
    assert_sky_is_as_in_cycles(tmp_path)


def gradient(tree: Any, coordinates: str) -> Any:
    """A colour by the height of the direction."""
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    source = tree.nodes.new("ShaderNodeTexCoord").outputs[coordinates]
    tree.links.new(source, separate.inputs[0])
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = (0.8, 0.5, 0.3, 1)
    ramp.color_ramp.elements[1].color = (0.1, 0.3, 0.9, 1)
    tree.links.new(separate.outputs["Z"], ramp.inputs["Fac"])
    return ramp.outputs["Color"]


@pytest.mark.parametrize("coordinates", ["Generated", "Normal", "Object", "Reflection"])
def test_graphs_are_as_in_cycles(coordinates: str, tmp_path: Path) -> None:
    tree, background = world_tree()
    tree.links.new(gradient(tree, coordinates), background.inputs["Color"])
    assert_sky_is_as_in_cycles(tmp_path)


def test_backgrounds_mixed_by_a_pattern_are_as_in_cycles(tmp_path: Path) -> None:
    tree, background = world_tree()
    tree.links.new(gradient(tree, "Generated"), background.inputs["Color"])
    noise = add_node(tree, "ShaderNodeTexNoise", Scale=2, Detail=1)
    other = add_node(tree, "ShaderNodeBackground", Color=(0.9, 0.9, 0.8), Strength=0.7)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(noise.outputs[0], mix.inputs[0])
    tree.links.new(background.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    assert_sky_is_as_in_cycles(tmp_path)


def test_graphs_tell_camera_rays_apart() -> None:
    tree, background = world_tree()
    is_camera = tree.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"]
    mix = add_node(tree, "ShaderNodeMixRGB", Color1=(0.25, 0.5, 1), Color2=(1, 0.5, 0.25))
    tree.links.new(is_camera, mix.inputs[0])
    tree.links.new(mix.outputs[0], background.inputs["Color"])
    layers = exported().layers
    assert [layer.seen_by for layer in layers] == ["camera", "scattered"]
    colors = [layer.image.pixels.reshape(-1, 3) for layer in layers]
    assert np.allclose(colors[0], (1, 0.5, 0.25))
    assert np.allclose(colors[1], (0.25, 0.5, 1))


def test_other_coordinates_are_reported() -> None:
    tree, _background, texture = environment_world()
    add_mapping(tree, texture, "Window")
    exported(
        'node "Environment Texture": Window coordinates are not supported: the direction is used'
    )


def region_means(folder: Path, seeds: int) -> np.ndarray:
    """(seeds, 16, 3) means over a grid of 4 x 4 regions."""
    scene = bpy.context.scene
    means = []
    for seed in range(seeds):
        scene.basicrt.seed = scene.cycles.seed = seed
        picture = render(folder)[..., :3].astype(float)
        means.append(picture.reshape(4, 6, 4, 6, 3).mean(axis=(1, 3)).reshape(16, 3))
    return np.array(means)


@pytest.mark.parametrize("has_lamp", [False, True])
def test_light_of_an_image_is_as_in_cycles(has_lamp: bool, tmp_path: Path) -> None:
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 24
    scene.basicrt.samples = 128
    picture = PICTURE.copy()
    picture[6, 3, :3] = 80, 60, 30  # a small sun
    tree, _background, texture = environment_world(new_image(picture))
    add_mapping(tree, texture, Rotation=(0.2, 0.1, 2))
    add_plane(6, material=new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.7, 0.6, 0.5)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, location=(0, 0, 1))
    ball = bpy.context.object
    ball.data.shade_smooth()
    ball.data.materials.append(
        new_material("ShaderNodeBsdfPrincipled", "Ball", Roughness=0.3, Metallic=1.0)
    )
    if has_lamp:
        lamp = bpy.data.lights.new("Lamp", "POINT")
        lamp.energy, lamp.shadow_soft_size = 300, 0.3
        placed = bpy.data.objects.new("Lamp", lamp)
        placed.location = (2, 2, 3)
        scene.collection.objects.link(placed)
    scene.camera.data.type = "PERSP"
    scene.camera.location = (0, -6, 3)
    scene.camera.rotation_euler = (math.radians(68), 0, 0)
    seeds = 6
    ours = region_means(tmp_path, seeds)
    make_cycles_neutral(scene)
    scene.render.engine = "CYCLES"
    theirs = region_means(tmp_path, seeds)
    difference = ours.mean(axis=0) - theirs.mean(axis=0)
    variance = ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)
    error = np.sqrt(np.maximum(variance, variance.mean() / 16) / seeds)
    total = ours.mean() / theirs.mean() - 1
    print(
        f"whole picture {total:+.3%}, worst {np.abs(difference / error).max():.2f} standard errors"
    )
    assert (np.abs(difference) <= 5 * error + 0.01 * theirs.mean(axis=0)).all()
    assert abs(total) < 0.01
