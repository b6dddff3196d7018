# SPDX-License-Identifier: GPL-3.0-or-later
"""The button beside a warning: what it finds in the text, and what is selected then."""

from typing import Any

import bpy
import pytest
from addon.culprit import Culprit, find_culprit

from support.blender import add_camera, add_lamp, add_node, add_plane, empty_material, new_scene


@pytest.fixture
def scene() -> Any:
    """Three planes, two of them with a material whose only shader is in a group."""
    made = new_scene(8, 8)
    material, tree, output = empty_material('Odd: "one"')
    group = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    shader = add_node(group, "ShaderNodeBsdfRayPortal")
    end = group.nodes.new("NodeGroupOutput")
    group.links.new(shader.outputs[0], end.inputs[0])
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    plain, *_ = empty_material("Odd")
    for name, materials in (("A", [material]), ("B", [plain, material]), ("C", [])):
        plane = add_plane()
        plane.name = name
        for each in materials:
            plane.data.materials.append(each)
    add_camera()
    return made


def selected() -> set[str]:
    return {b_object.name for b_object in bpy.context.view_layer.objects if b_object.select_get()}


def press(warning: str) -> set[str]:
    return bpy.ops.basicrt.select_culprit(warning=warning)


def test_a_material_and_a_node_in_a_group(scene: Any) -> None:
    warning = 'material "Odd: "one"": node "Ray Portal BSDF": not supported'
    assert find_culprit(warning) == Culprit("material", 'Odd: "one"', "Ray Portal BSDF")
    bpy.data.objects["C"].select_set(True)
    assert press(warning) == {"FINISHED"}
    assert selected() == {"A", "B"}
    assert bpy.data.objects["B"].active_material_index == 1
    tree = bpy.data.materials['Odd: "one"'].node_tree
    assert tree.nodes.active.name == "Group"
    assert [node.name for node in tree.nodes if node.select] == ["Group"]
    assert bpy.data.node_groups["Inner"].nodes.active.name == "Ray Portal BSDF"


def test_an_object_while_another_is_edited(scene: Any) -> None:
    bpy.context.view_layer.objects.active = bpy.data.objects["A"]
    bpy.ops.object.mode_set(mode="EDIT")
    assert press('object "C": 1 of 3 triangles have no area and are left out') == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"
    assert selected() == {"C"}
    assert bpy.context.view_layer.objects.active.name == "C"


def test_a_lamp_by_its_own_name_or_its_datas(scene: Any) -> None:
    lamp = add_lamp("AREA")
    lamp.name, lamp.data.name = "Key", "Softbox"
    for warning in ('light "Key": has no size', 'light "Softbox": node "X" is not supported'):
        bpy.data.objects["A"].select_set(True)
        assert press(warning) == {"FINISHED"}
        assert selected() == {"Key"}


def test_what_can_not_be_selected_has_no_button(scene: Any) -> None:
    for text in (
        f'scene "{scene.name}": stereoscopy is not supported',
        'image "Sky": cannot be read',
        'material "Gone": node "X": not supported',
    ):
        assert find_culprit(text) is None, text


def test_what_is_gone_is_told(scene: Any) -> None:
    assert press('object "Gone": is odd') == {"CANCELLED"}
    bpy.data.objects["C"].users_collection[0].objects.unlink(bpy.data.objects["C"])
    assert press('object "C": is odd') == {"CANCELLED"}
