# SPDX-License-Identifier: GPL-3.0-or-later
"""Attribute nodes that read objects and what instances them, against Cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

from support.blender import (
    add_camera,
    add_mesh,
    add_node,
    empty_material,
    export,
    new_scene,
    place,
    render_both,
)

only_in_one_version = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="Cycles is compared with in one version of Blender"
)
SQUARE = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])


def shows(kind: str, name: str, output: str) -> Any:
    """A material that glows by an output of an Attribute node."""
    material, tree, output_node = empty_material(f"{kind} {name} {output}")
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_type, node.attribute_name = kind, name
    emission = add_node(tree, "ShaderNodeEmission")
    tree.links.new(node.outputs[output], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output_node.inputs["Surface"])
    return material


def add_squares(materials: list[Any], values: dict[str, Any]) -> list[Any]:
    """A row of squares of a metre, whose objects have the properties and whose meshes others."""
    made = []
    for i, material in enumerate(materials):
        b_object = add_mesh(*SQUARE, material, "Square", (i, 0, 0))
        for name, value in values.items():
            b_object[name] = value
        b_object.data["of mesh"] = 0.7
        b_object.data["both"] = 0.9
        b_object.color = (0.1, 0.2, 0.3, 0.4)
        b_object.pass_index = 3
        made.append(b_object)
    return made


@only_in_one_version
def test_properties_of_objects_are_as_in_cycles(tmp_path: Path) -> None:
    values = {
        "float": 0.25,
        "int": 2,
        "vector": (0.1, 0.2, 0.6),
        "color": (0.3, 0.5, 0.7, 0.2),
        "both": 0.4,
        "text": "red",
    }
    names = [*values, "of mesh", "pass_index", "no such", '["float"]', "location"]
    asked = [(n, o) for n in names for o in ("Color", "Vector", "Fac", "Alpha")]
    scene = new_scene(len(asked), 1, 4)
    add_camera((len(asked) / 2, 0.5, 5), ortho_scale=len(asked))
    add_squares([shows("OBJECT", n, o) for n, o in asked], values)
    scene.basicrt.filter_type, scene.cycles.pixel_filter_type = "BOX", "BOX"
    scene.basicrt.filter_width = scene.cycles.filter_width = 0.01
    ours, theirs = render_both(tmp_path)
    for i, one in enumerate(asked):
        np.testing.assert_allclose(ours[0, i], theirs[0, i], rtol=1e-4, atol=1e-5, err_msg=str(one))


@only_in_one_version
def test_properties_of_instancers_are_as_in_cycles(tmp_path: Path) -> None:
    names = ["of instancer", "of object", "of mesh", "in both", "no such"]
    scene = new_scene(len(names) * 2, 2, 4)
    add_camera((len(names), 1, 5), ortho_scale=len(names) * 2)
    collection = bpy.data.collections.new("Shown")
    materials = [shows(kind, name, "Color") for kind in ("INSTANCER", "OBJECT") for name in names]
    values = {"of object": 0.3, "in both": (0.2, 0.4, 0.6)}
    for b_object in add_squares(materials, values):
        bpy.context.scene.collection.objects.unlink(b_object)
        collection.objects.link(b_object)
    for y in (0, 1):
        b_empty = place(None, (0, y, 0), name=f"Instancer {y}")
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", collection
        b_empty["of instancer"] = 0.5 + 0.25 * y
        b_empty["in both"] = (0.8, 0.1, 0.1 + y)
    scene.basicrt.filter_width = scene.cycles.filter_width = 0.01
    scene.basicrt.filter_type, scene.cycles.pixel_filter_type = "BOX", "BOX"
    ours, theirs = render_both(tmp_path)
    np.testing.assert_allclose(ours, theirs, rtol=1e-4, atol=1e-5)
    assert not np.allclose(ours[0], ours[1])


def test_only_what_materials_ask_for_is_exported() -> None:
    new_scene()
    add_camera()
    add_squares([shows("OBJECT", "float", "Alpha")], {"float": 0.5, "other": 2.0})
    assert export().instances[0].properties == {"object:float:alpha": (1, 1, 1)}


def test_instances_of_geometry_nodes_are_reported() -> None:
    new_scene()
    add_camera()
    material = shows("INSTANCER", "size", "Color")
    (b_square,) = add_squares([material], {})
    b_group: Any = bpy.data.node_groups.new("Instances", "GeometryNodeTree")
    b_group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    shown = b_group.nodes.new("GeometryNodeObjectInfo")
    shown.inputs["Object"].default_value, shown.inputs["As Instance"].default_value = b_square, True
    output = b_group.nodes.new("NodeGroupOutput")
    b_group.links.new(shown.outputs["Geometry"], output.inputs[0])
    b_parent = add_mesh(*SQUARE, None, "Parent")
    b_parent.modifiers.new("Nodes", "NODES").node_group = b_group
    report = Report()
    export(report)
    expected = 'object "Parent": the attribute "size" of its instances is not known: 0 instead'
    assert report.warnings == (expected,)
