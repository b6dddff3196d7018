# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of nodes: what an emission shows of them on a plane, here and in Cycles, pixel by pixel.

Hashes and noise are the same functions, so pixels differ by rounding alone, but for the few where a
step (the edge of a cell or of a brick) runs through the pixel's centre.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import add_camera, add_plane, empty_material, new_scene, render_both

SIZE = 24
# Filters of 0.01 pixels move points by up to 1e-4 m, and patterns' slopes, up to 30, multiply that.
TOLERANCE = 3e-3
ON_A_STEP = 0.01  # share of pixels that may lie on a step


def tree_with(bl_idname: str, **settings: Any) -> tuple[Any, Any, Any]:
    """A tree on a tilted plane, a node in it, and the emission."""
    new_scene(SIZE, SIZE, samples=1)
    material, tree, output = empty_material()
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    node = tree.nodes.new(bl_idname)
    for name, value in settings.items():
        setattr(node, name, value)
    plane = add_plane(size=4, z=0.6, material=material)
    plane.rotation_euler = (0.3, 0.2, 0.1)
    add_camera()
    bpy.context.scene.camera.data.ortho_scale = 0.3
    return tree, node, emission


def compare(tree: Any, socket: Any, emission: Any, folder: Path, steps: float = 0.0) -> None:
    """Both pictures of an output: half of it and a half, so that negative values show."""
    halved = tree.nodes.new("ShaderNodeVectorMath")
    halved.operation = "MULTIPLY_ADD"
    halved.inputs[1].default_value = halved.inputs[2].default_value = (0.5, 0.5, 0.5)
    tree.links.new(socket, halved.inputs[0])
    tree.links.new(halved.outputs[0], emission.inputs["Color"])
    ours, theirs = render_both(folder)
    ours, theirs = ours[..., :3], np.maximum(theirs[..., :3], 0)
    differs = np.abs(ours - theirs).max(axis=2) > TOLERANCE * np.maximum(1, theirs.max(axis=2))
    assert np.ptp(theirs) > 0, "shows nothing that could differ"
    assert differs.mean() <= steps, np.abs(ours - theirs).max()


def link_position(tree: Any, socket: Any) -> Any:
    """Links the position, and returns its node."""
    node = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(node.outputs["Position"], socket)
    return node


def feed_numbers(tree: Any, node: Any) -> None:
    """A coordinate for each of the node's number inputs."""
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    link_position(tree, separate.inputs[0])
    for i, socket in enumerate(s for s in node.inputs if s.type == "VALUE" and s.enabled):
        tree.links.new(separate.outputs[i % 2], socket)


MATH = [
    item.identifier for item in bpy.types.ShaderNodeMath.bl_rna.properties["operation"].enum_items
]
VECTOR_MATH = [
    item.identifier
    for item in bpy.types.ShaderNodeVectorMath.bl_rna.properties["operation"].enum_items
]
BLENDS = [
    item.identifier for item in bpy.types.ShaderNodeMix.bl_rna.properties["blend_type"].enum_items
]


# Steps, poles and constants on this small plane: tests/native/shading holds some of them.
NOT_SMOOTH = {"DIVIDE", "INVERSE_SQRT", "LESS_THAN", "GREATER_THAN", "COMPARE", "ROUND", "TRUNC"}
NOT_SMOOTH |= {"MODULO", "FLOORED_MODULO", "SNAP", "FRACT"}


@pytest.mark.parametrize("kind", [kind for kind in MATH if kind not in NOT_SMOOTH])
def test_math(kind: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeMath", operation=kind)
    feed_numbers(tree, node)
    compare(tree, node.outputs[0], emission, tmp_path, ON_A_STEP)


@pytest.mark.parametrize("kind", VECTOR_MATH)
def test_vector_math(kind: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeVectorMath", operation=kind)
    link_position(tree, node.inputs[0])
    node.inputs[1].default_value = (0.3, 0.7, -0.4)
    node.inputs[2].default_value = (0.2, -0.1, 0.5)
    next(s for s in node.inputs if s.identifier == "Scale").default_value = 0.7
    output = next(socket for socket in node.outputs if socket.enabled)
    compare(tree, output, emission, tmp_path, ON_A_STEP)


@pytest.mark.parametrize("kind", BLENDS)
def test_mix(kind: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeMix", data_type="RGBA", blend_type=kind)
    noise = tree.nodes.new("ShaderNodeTexNoise")
    by_name = {socket.identifier: socket for socket in node.inputs}
    by_name["Factor_Float"].default_value = 0.7
    tree.links.new(noise.outputs["Color"], by_name["A_Color"])
    by_name["B_Color"].default_value = (0.3, 0.6, 0.2, 1)
    output = next(socket for socket in node.outputs if socket.identifier == "Result_Color")
    compare(tree, output, emission, tmp_path, ON_A_STEP)


@pytest.mark.parametrize("interpolation", ["LINEAR", "EASE", "CARDINAL", "B_SPLINE"])
def test_color_ramp(interpolation: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeValToRGB")
    node.color_ramp.interpolation = interpolation
    node.color_ramp.elements.new(0.4).color = (0.9, 0.2, 0.5, 0.5)
    feed_numbers(tree, node)
    compare(tree, node.outputs["Color"], emission, tmp_path, ON_A_STEP)


@pytest.mark.parametrize("interpolation", ["LINEAR", "SMOOTHSTEP", "SMOOTHERSTEP"])
def test_map_range(interpolation: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeMapRange", interpolation_type=interpolation)
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    link_position(tree, separate.inputs[0])
    tree.links.new(separate.outputs[0], node.inputs["Value"])
    compare(tree, node.outputs[0], emission, tmp_path, ON_A_STEP)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR", "NORMAL"])
def test_mapping(kind: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeMapping", vector_type=kind)
    link_position(tree, node.inputs["Vector"])
    node.inputs["Rotation"].default_value = (0.3, 0.7, -0.4)
    node.inputs["Scale"].default_value = (0.5, 1.3, 2)
    if kind in ("POINT", "TEXTURE"):
        node.inputs["Location"].default_value = (0.1, 0.2, 0.3)
    compare(tree, node.outputs[0], emission, tmp_path)


@pytest.mark.parametrize("name", ["Generated", "Normal", "Object", "Camera", "Reflection"])
def test_texture_coordinate(name: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeTexCoord")
    compare(tree, node.outputs[name], emission, tmp_path)


@pytest.mark.parametrize("name", ["Position", "Normal", "True Normal", "Incoming"])
def test_geometry(name: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeNewGeometry")
    compare(tree, node.outputs[name], emission, tmp_path)


NOISES = ["MULTIFRACTAL", "FBM", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HETERO_TERRAIN"]


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
@pytest.mark.parametrize("kind", NOISES)
def test_noise(kind: str, dimensions: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with(
        "ShaderNodeTexNoise", noise_type=kind, noise_dimensions=dimensions
    )
    for socket in node.inputs:
        if socket.identifier in ("Vector", "W"):
            link_position(tree, socket)
    for name, value in (("Scale", 1.7), ("Detail", 2.5), ("Roughness", 0.6), ("Distortion", 0.3)):
        node.inputs[name].default_value = value
    compare(tree, node.outputs["Color"], emission, tmp_path)


@pytest.mark.parametrize(
    ("bl_idname", "output", "settings"),
    [
        ("ShaderNodeTexChecker", "Color", {}),
        ("ShaderNodeTexBrick", "Color", {}),
        ("ShaderNodeTexMagic", "Color", {"turbulence_depth": 5}),
        ("ShaderNodeTexWave", "Color", {"wave_type": "BANDS"}),
        ("ShaderNodeTexWave", "Color", {"wave_type": "RINGS", "wave_profile": "TRI"}),
        *(
            ("ShaderNodeTexGradient", "Color", {"gradient_type": kind})
            for kind in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "SPHERICAL")
        ),
    ],
)
def test_patterns(bl_idname: str, output: str, settings: dict[str, Any], tmp_path: Path) -> None:
    tree, node, emission = tree_with(bl_idname, **settings)
    link_position(tree, node.inputs["Vector"])
    compare(tree, node.outputs[output], emission, tmp_path, ON_A_STEP)
