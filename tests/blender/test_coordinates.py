# SPDX-License-Identifier: GPL-3.0-or-later
"""What nodes read of surfaces, objects, the camera and rays, as in Cycles."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

from support.blender import (
    add_camera,
    add_lamp,
    add_node,
    add_plane,
    empty_material,
    export,
    new_material,
    new_scene,
    render_both,
)
from support.surfaces import (
    SIZE,
    add_ball,
    ball,
    compare,
    output_of,
    pictures,
    plane,
    shining_material,
)


@pytest.mark.parametrize(
    "name", ["Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection"]
)
def test_texture_coordinate(name: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeTexCoord")
    compare(tree, node.outputs[name], emission, tmp_path, scale=0.3)


def test_window_of_an_orthographic_camera(tmp_path: Path) -> None:
    tree, emission, _made = plane()
    camera = bpy.context.scene.camera.data
    camera.type, camera.ortho_scale, camera.shift_x = "ORTHO", 1.5, 0.2
    node = tree.nodes.new("ShaderNodeTexCoord")
    compare(tree, node.outputs["Window"], emission, tmp_path)


def test_coordinates_of_another_object(tmp_path: Path) -> None:
    tree, emission, made = ball()
    node = tree.nodes.new("ShaderNodeTexCoord")
    node.object = bpy.data.objects.new("Other", None)
    bpy.context.scene.collection.objects.link(node.object)
    node.object.parent = made
    node.object.location, node.object.rotation_euler = (0.2, 0.4, 0.1), (0.5, 0.2, 0.1)
    compare(tree, node.outputs["Object"], emission, tmp_path, scale=0.3)


GEOMETRY = ["Position", "Normal", "Tangent", "True Normal", "Incoming", "Backfacing"]


@pytest.mark.parametrize("name", GEOMETRY)
def test_geometry(name: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeNewGeometry")
    compare(tree, node.outputs[name], emission, tmp_path, scale=0.3)


def test_parametric(tmp_path: Path) -> None:
    tree, emission, _made = plane()
    node = tree.nodes.new("ShaderNodeNewGeometry")
    compare(tree, node.outputs["Parametric"], emission, tmp_path)


@pytest.mark.parametrize("name", ["Normal", "Tangent", "True Normal", "Backfacing"])
def test_geometry_of_the_back_of_a_mirrored_object(name: str, tmp_path: Path) -> None:
    tree, emission, made = ball()
    made.scale = (-1, 0.7, 1.3)
    made.data.flip_normals()
    node = tree.nodes.new("ShaderNodeNewGeometry")
    compare(tree, node.outputs[name], emission, tmp_path, scale=0.3)


@pytest.mark.parametrize("is_split", [False, True])
def test_pointiness(is_split: bool, tmp_path: Path) -> None:
    tree, emission, made = ball()
    place = made.data.vertices[21].co
    made.data.vertices[21].co = place * 1.4  # a spike
    if is_split:  # vertices at the same place count as one
        modifier = made.modifiers.new("Split", "EDGE_SPLIT")
        modifier.split_angle = 0.2
    node = tree.nodes.new("ShaderNodeNewGeometry")
    compare(tree, node.outputs["Pointiness"], emission, tmp_path)


@pytest.mark.parametrize("output", ["AO", "Color"])
@pytest.mark.parametrize(
    ("settings", "distance"),
    [({}, 1.0), ({}, 0.0), ({"only_local": True}, 2.0), ({"inside": True}, 0.4)],
)
def test_ambient_occlusion(
    settings: dict[str, bool], distance: float, output: str, tmp_path: Path
) -> None:
    tree, emission, made = ball()
    made.location.z += 0.3
    floor = add_plane(size=3, material=new_material("ShaderNodeBsdfDiffuse", Color=(0, 0, 0)))
    floor.location = (0.2, 0.1, -0.5)
    node: Any = tree.nodes.new("ShaderNodeAmbientOcclusion")
    node.samples = 64
    node.inputs["Distance"].default_value = distance
    for name, value in settings.items():
        setattr(node, name, value)
    bpy.context.scene.basicrt.samples = bpy.context.scene.cycles.samples = 16
    ours, theirs = pictures(tree, output_of(node, output), emission, tmp_path)
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), theirs.mean(axis=(0, 1)), rtol=0.01)
    assert np.abs(ours - theirs).mean() < 0.03 * theirs.max()


def blocks(shown: np.ndarray, size: int = 4) -> np.ndarray:
    """The means of squares of pixels."""
    height, width, channels = shown.shape
    split = shown.reshape(height // size, size, width // size, size, channels)
    mean: np.ndarray = split.mean(axis=(1, 3))
    return mean


@pytest.mark.parametrize("radius", [0.05, 0.3])
@pytest.mark.parametrize("kind", ["smooth", "flat", "inside", "normal"])
def test_bevel(kind: str, radius: float, tmp_path: Path) -> None:
    """Of a ball whose sides meet in edges; one that is smooth has them flattened by the mean."""
    tree, emission, made = ball(is_smooth=kind == "smooth")
    if kind == "inside":
        made.data.flip_normals()
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 64
    node = add_node(tree, "ShaderNodeBevel", Radius=radius)
    node.samples = 128
    if kind == "normal":
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], node.inputs["Normal"])
    bpy.context.scene.cycles.samples = 4
    ours, theirs = (blocks(one) for one in pictures(tree, node.outputs[0], emission, tmp_path))
    differences = np.abs(ours - theirs)
    assert differences.mean() < 0.004, differences.mean()
    assert np.quantile(differences, 0.98) < 0.02


def test_bevel_rounds_edges(tmp_path: Path) -> None:
    """Where it does nothing, pictures of normals are of other colours than where it does."""
    tree, emission, _made = ball(is_smooth=False)
    node = add_node(tree, "ShaderNodeBevel", Radius=0.3)
    rounded, _theirs = pictures(tree, node.outputs[0], emission, tmp_path)
    node.inputs["Radius"].default_value = 0
    sharp, _theirs = pictures(tree, node.outputs[0], emission, tmp_path)
    assert np.abs(rounded - sharp).mean() > 0.005


def test_islands_have_numbers_of_their_own(tmp_path: Path) -> None:
    tree, emission, made = ball()
    bpy.context.view_layer.objects.active = made
    other = made.copy()
    other.data = made.data.copy()
    other.location.x += 0.8
    bpy.context.scene.collection.objects.link(other)
    with bpy.context.temp_override(selected_editable_objects=[made, other], active_object=made):
        bpy.ops.object.join()
    node = tree.nodes.new("ShaderNodeNewGeometry")
    ours, theirs = pictures(tree, node.outputs["Random Per Island"], emission, tmp_path)
    assert len(np.unique(ours.round(4))) == len(np.unique(theirs.round(4)))


@pytest.mark.parametrize(
    "name", ["Location", "Color", "Alpha", "Object Index", "Material Index", "Random"]
)
def test_object_info(name: str, tmp_path: Path) -> None:
    tree, emission, made = ball()
    made.color, made.pass_index = (0.2, 0.7, 0.4, 0.6), 3
    made.data.materials[0].pass_index = 2
    node = tree.nodes.new("ShaderNodeObjectInfo")
    compare(tree, node.outputs[name], emission, tmp_path, scale=0.3)


@pytest.mark.parametrize("name", ["Location", "Color", "Random"])
def test_object_info_of_instances(name: str, tmp_path: Path) -> None:
    tree, emission, made = ball()
    made.color = (0.2, 0.7, 0.4, 0.6)
    carrier = add_plane(size=2.5, name="Carrier")
    carrier.instance_type = "VERTS"
    carrier.show_instancer_for_render = False
    made.parent = carrier
    made.scale = (0.3, 0.3, 0.3)
    made.location = (0, 0, 0)
    node = tree.nodes.new("ShaderNodeObjectInfo")
    compare(tree, node.outputs[name], emission, tmp_path, scale=0.3, share=0.02)


@pytest.mark.parametrize("name", ["View Vector", "View Z Depth", "View Distance"])
def test_camera_data(name: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeCameraData")
    compare(tree, output_of(node, name), emission, tmp_path, scale=0.1)


@pytest.mark.parametrize("is_back", [False, True])
@pytest.mark.parametrize("name", ["Fresnel", "Fresnel of layers", "Facing"])
def test_angles_of_view(name: str, is_back: bool, tmp_path: Path) -> None:
    tree, emission, made = ball()
    if is_back:
        made.data.flip_normals()
    if name == "Fresnel":
        node = add_node(tree, "ShaderNodeFresnel", IOR=1.4)
        socket = node.outputs[0]
    else:
        node = add_node(tree, "ShaderNodeLayerWeight", Blend=0.3)
        socket = node.outputs[name.split()[0]]
    map_ = add_node(tree, "ShaderNodeNormalMap", Color=(0.6, 0.4, 0.9))
    if bpy.app.version >= (5, 2, 0):
        map_.space = "OBJECT"  # see test_normals.py for what tangents are there
    tree.links.new(map_.outputs[0], node.inputs["Normal"])
    compare(tree, socket, emission, tmp_path)


@pytest.mark.parametrize(("direction", "axis"), [("UV_MAP", "Z"), *(("RADIAL", a) for a in "XYZ")])
def test_tangent(direction: str, axis: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeTangent")
    node.direction_type, node.axis = direction, axis
    compare(tree, node.outputs[0], emission, tmp_path)


SPACES = ["WORLD", "OBJECT", "CAMERA"]


@pytest.mark.parametrize("kind", ["POINT", "VECTOR", "NORMAL"])
@pytest.mark.parametrize(("source", "target"), [(a, b) for a in SPACES for b in SPACES])
def test_vector_transform(source: str, target: str, kind: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeVectorTransform")
    node.vector_type, node.convert_from, node.convert_to = kind, source, target
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(geometry.outputs["Normal"], node.inputs[0])
    compare(tree, node.outputs[0], emission, tmp_path, scale=0.1)


@pytest.mark.parametrize(("size", "in_pixels"), [(0.08, False), (2.5, True)])
def test_wireframe(size: float, in_pixels: bool, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = add_node(tree, "ShaderNodeWireframe", Size=size)
    node.use_pixel_size = in_pixels
    compare(tree, node.outputs[0], emission, tmp_path, share=0.03)


def test_hair_info_of_a_surface(tmp_path: Path) -> None:
    tree, emission, _made = ball()
    node = tree.nodes.new("ShaderNodeHairInfo")
    np.testing.assert_allclose(
        *pictures(tree, output_of(node, "Is Strand"), emission, tmp_path), atol=1e-3
    )


@pytest.mark.parametrize("output", ["Color", "Vector", "Fac", "Alpha"])
@pytest.mark.parametrize("name", ["tint", "wind", "cycle", "frame_current", "render.fps", "none"])
def test_attributes_of_the_view_layer(name: str, output: str, tmp_path: Path) -> None:
    tree, emission, _made = plane()
    scene = bpy.context.scene
    bpy.context.view_layer["tint"], scene["tint"] = (0.1, 0.4, 0.7, 0.3), 5.0
    scene["wind"] = 0.25
    scene.world = scene.world or bpy.data.worlds.new("World")
    scene.world["cycle"] = 3
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_type, node.attribute_name = "VIEW_LAYER", name
    ours, theirs = pictures(tree, output_of(node, output), emission, tmp_path, 0.2)
    assert (abs(theirs[..., :3] - 0.5).max() > 1e-3) == (name != "none")
    assert np.allclose(ours, theirs, rtol=1e-3, atol=1e-4)


@pytest.mark.parametrize("smooth", [0.0, 1.5])
@pytest.mark.parametrize("output", ["Quadratic", "Linear", "Constant"])
def test_light_falloff_of_a_surface(output: str, smooth: float, tmp_path: Path) -> None:
    tree, emission, _made = plane()
    bpy.context.scene.camera.data.clip_start = 1e-5  # where Cycles' rays begin
    node = add_node(tree, "ShaderNodeLightFalloff", Strength=0.4, Smooth=smooth)
    ours, theirs = pictures(tree, node.outputs[output], emission, tmp_path, 0.2)
    assert theirs[..., :3].min() > 0
    assert np.allclose(ours, theirs, rtol=2e-3, atol=1e-4)


UNSUPPORTED = [
    ("ShaderNodeParticleInfo", "Age"),
]


@pytest.mark.parametrize(("bl_idname", "output"), UNSUPPORTED)
def test_what_is_not_supported_is_reported(bl_idname: str, output: str) -> None:
    tree, emission, _made = plane()
    node = tree.nodes.new(bl_idname)
    tree.links.new(output_of(node, output), emission.inputs["Strength"])
    report = Report()
    export(report)
    assert len(report.warnings) == 1, report.warnings


# ---- light paths ---------------------------------------------------------------------------------

LIGHT_PATH = [
    "Is Camera Ray",
    "Is Shadow Ray",
    "Is Diffuse Ray",
    "Is Glossy Ray",
    "Is Singular Ray",
    "Is Reflection Ray",
    "Is Transmission Ray",
    "Ray Length",
    "Ray Depth",
    "Diffuse Depth",
    "Glossy Depth",
    "Transparent Depth",
    "Transmission Depth",
]


def seen_through(bl_idname: str, **values: Any) -> tuple[Any, Any]:
    """The tree and the emission of walls around an object with a shader."""
    new_scene(SIZE, SIZE, samples=1)
    first = new_material(bl_idname, **values)
    material, tree, emission = shining_material()
    walls = add_ball(material, columns=16, rows=12)
    walls.scale = (6, 6, 6)
    add_plane(size=12, z=-3, material=material)
    add_plane(size=12, z=4, material=material)
    add_plane(size=2, material=first).rotation_euler = (0.3, 0.2, 0.1)
    # Cycles measures camera rays from where the camera's clipping begins.
    add_camera((0, 0, 3), (0, 0, 0), "PERSP", lens=60, clip_start=1e-3)
    return tree, emission


@pytest.mark.parametrize("name", LIGHT_PATH)
@pytest.mark.parametrize("kind", ["Mirror", "Pane", "Window"])
def test_light_path(kind: str, name: str, tmp_path: Path) -> None:
    tree, emission = {
        "Mirror": lambda: seen_through("ShaderNodeBsdfAnisotropic", Roughness=0.0),
        "Pane": lambda: seen_through("ShaderNodeBsdfRefraction", IOR=1.2, Roughness=0.0),
        "Window": lambda: seen_through("ShaderNodeBsdfTransparent", Color=(0.5, 0.7, 0.9)),
    }[kind]()
    node = tree.nodes.new("ShaderNodeLightPath")
    ours, theirs = pictures(tree, node.outputs[name], emission, tmp_path, scale=0.1)
    assert (np.abs(ours - theirs).max(axis=2) > 3e-3).mean() <= 0.02, (ours - theirs)[12, 12]


@pytest.mark.parametrize("name", LIGHT_PATH)
def test_light_path_of_a_shadow_ray(name: str, tmp_path: Path) -> None:
    """A pane that lets through as much as the node says lies between a sun and a floor."""
    new_scene(SIZE, SIZE, samples=1)
    material, tree, output = empty_material()
    transparent = tree.nodes.new("ShaderNodeBsdfTransparent")
    tree.links.new(transparent.outputs[0], output.inputs["Surface"])
    node = tree.nodes.new("ShaderNodeLightPath")
    scaled = tree.nodes.new("ShaderNodeMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value, scaled.inputs[2].default_value = 0.1, 0.2
    tree.links.new(node.outputs[name], scaled.inputs[0])
    tree.links.new(scaled.outputs[0], transparent.inputs["Color"])
    add_plane(size=20, material=new_material("ShaderNodeBsdfDiffuse"))
    add_plane(size=6, z=1, material=material)
    add_plane(size=6, z=1.5, material=material)
    add_lamp("SUN", (0, 0, 5), (0.3, 0.2, 0), energy=3, angle=0)
    cycles = bpy.context.scene.cycles
    cycles.min_light_bounces = cycles.min_transparent_bounces = 8  # no roulette
    add_camera((0, -4, 3), (math.radians(55), 0, 0), "PERSP", lens=40, clip_start=1e-3)
    ours, theirs = render_both(tmp_path)
    differences = np.abs(ours - theirs)[..., :3].max(axis=2)
    assert (differences > 3e-3).mean() <= 0.03, np.sort(differences.ravel())[::-1][:8]
