# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes, colours and UV maps of meshes: what materials show of them, here and in Cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

import basicrt
from support.blender import (
    add_camera,
    add_mesh,
    empty_material,
    export,
    new_image,
    new_scene,
    render_both,
)

SIZE = 24
TOLERANCE = 4e-3  # filters of 0.01 pixels, on steep random values


def grid(material: Any, count: int = 3) -> Any:
    """A square of quads, two metres wide, that faces up."""
    steps = np.linspace(-1, 1, count + 1)
    vertices = [(x, y, 0) for y in steps for x in steps]
    row = count + 1
    corners = [i + j * row for j in range(count) for i in range(count)]
    return add_mesh(vertices, [(i, i + 1, i + 1 + row, i + row) for i in corners], material)


def fill(b_attribute: Any, seed: int = 7) -> None:
    """Random numbers."""
    random = np.random.default_rng(seed)
    kind = b_attribute.data_type
    member = {"FLOAT": "value", "INT": "value", "BOOLEAN": "value", "INT8": "value"}.get(
        kind, "vector"
    )
    member = "color" if kind.endswith("COLOR") else member
    width = {"value": 1, "color": 4, "vector": 2 if kind == "FLOAT2" else 3}[member]
    numbers = random.random(len(b_attribute.data) * width).astype(np.float32)
    if kind.startswith("INT"):
        numbers = np.rint(numbers * 3).astype(np.int32)
    if kind == "BOOLEAN":
        numbers = numbers > 0.5
    b_attribute.data.foreach_set(member, numbers)


@pytest.fixture
def shown() -> tuple[Any, Any, Any]:
    """A material's tree, an emission in it, and a grid that has it."""
    new_scene(SIZE, SIZE, samples=1)
    material, tree, output = empty_material()
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    made = grid(material)
    add_camera()
    bpy.context.scene.camera.data.ortho_scale = 2.0
    return tree, emission, made


def compare(folder: Path) -> None:
    """Both pictures."""
    ours, theirs = render_both(folder)
    assert np.ptp(theirs[..., :3]) > 0.1, "shows nothing that could differ"
    np.testing.assert_allclose(ours, theirs, atol=TOLERANCE)


def link(tree: Any, node: Any, output: str, socket: Any) -> None:
    """From an output, by identifier."""
    tree.links.new(next(s for s in node.outputs if s.identifier == output), socket)


DOMAINS = ["POINT", "CORNER", "FACE"]
TYPES = ["FLOAT", "INT", "BOOLEAN", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR"]


@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("kind", TYPES)
def test_attribute(kind: str, domain: str, shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    fill(made.data.attributes.new("Some", kind, domain))
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Some"
    link(tree, node, "Color", emission.inputs["Color"])
    compare(tmp_path)


@pytest.mark.parametrize("output", ["Vector", "Fac", "Alpha"])
@pytest.mark.parametrize("kind", ["FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR"])
def test_outputs_of_an_attribute(kind: str, output: str, shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    fill(made.data.attributes.new("Some", kind, "CORNER"))
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Some"
    link(tree, node, output, emission.inputs["Strength" if output != "Vector" else "Color"])
    emission.inputs["Color"].default_value = (0.5, 1, 0.25, 1)
    if output != "Alpha" or kind == "FLOAT_COLOR":
        compare(tmp_path)
    else:
        np.testing.assert_allclose(*render_both(tmp_path), atol=TOLERANCE)


@pytest.mark.parametrize("output", ["Color", "Fac", "Alpha"])
def test_attribute_that_a_mesh_does_not_have(output: str, shown: Any, tmp_path: Path) -> None:
    tree, emission, _made = shown
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Some"
    link(tree, node, output, emission.inputs["Color"])
    np.testing.assert_allclose(*render_both(tmp_path), atol=TOLERANCE)


@pytest.mark.parametrize("name", ["", "First"])
@pytest.mark.parametrize("output", ["Color", "Alpha"])
def test_color_attribute(name: str, output: str, shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    colors = made.data.color_attributes
    for i, layer in enumerate(("First", "Second")):
        fill(colors.new(layer, "BYTE_COLOR" if i else "FLOAT_COLOR", "CORNER"), seed=i)
    colors.render_color_index = 1
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = name
    link(tree, node, output, emission.inputs["Color"])
    compare(tmp_path)


def add_uv_maps(made: Any) -> None:
    """Three, of which the middle one is active for rendering."""
    for i, name in enumerate(("First", "Second", "Third")):
        layer = made.data.uv_layers.new(name=name)
        random = np.random.default_rng(i)
        layer.uv.foreach_set("vector", random.random(len(layer.uv) * 2).astype(np.float32))
    made.data.uv_layers["Second"].active_render = True


@pytest.mark.parametrize("name", ["", "First", "Second", "Other"])
def test_uv_map(name: str, shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    add_uv_maps(made)
    node = tree.nodes.new("ShaderNodeUVMap")
    node.uv_map = name
    tree.links.new(node.outputs[0], emission.inputs["Color"])
    if name != "Other":
        compare(tmp_path)
    else:
        np.testing.assert_allclose(*render_both(tmp_path), atol=TOLERANCE)


def test_images_over_several_uv_maps(shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    add_uv_maps(made)
    pixels = np.random.default_rng(3).random((4, 4, 4))
    pixels[..., 3] = 1
    added = tree.nodes.new("ShaderNodeVectorMath")
    for i, name in enumerate(("First", "")):
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = new_image(pixels)
        node = tree.nodes.new("ShaderNodeUVMap")
        node.uv_map = name
        tree.links.new(node.outputs[0], image.inputs[0])
        tree.links.new(image.outputs[0], added.inputs[i])
    tree.links.new(added.outputs[0], emission.inputs["Color"])
    compare(tmp_path)


def test_image_on_a_mesh_without_uv_maps(shown: Any, tmp_path: Path) -> None:
    tree, emission, _made = shown
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = new_image(np.random.default_rng(3).random((4, 4, 4)))
    tree.links.new(image.outputs[0], emission.inputs["Color"])
    np.testing.assert_allclose(*render_both(tmp_path), atol=TOLERANCE)


def test_only_what_materials_use_is_exported(shown: Any) -> None:
    tree, emission, made = shown
    add_uv_maps(made)
    for name in ("Used", "Unused"):
        made.data.attributes.new(name, "FLOAT", "POINT")
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Used"
    link(tree, node, "Color", emission.inputs["Color"])
    mesh = export().shapes[0]
    assert isinstance(mesh, basicrt.Mesh)
    assert [name for name, _domain, _values in mesh.attributes] == ["Used"]


def test_objects_that_share_a_mesh_but_not_materials(shown: Any, tmp_path: Path) -> None:
    tree, emission, made = shown
    fill(made.data.attributes.new("Some", "FLOAT_COLOR", "CORNER"))
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "Some"
    link(tree, node, "Color", emission.inputs["Color"])
    other = made.copy()
    bpy.context.scene.collection.objects.link(other)
    other.location = (-1, 0, 0.1)
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = empty_material("Other")[0]
    compare(tmp_path)
