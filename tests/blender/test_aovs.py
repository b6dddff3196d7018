# SPDX-License-Identifier: GPL-3.0-or-later
"""AOV Output nodes and a view layer's AOVs, beside Cycles'."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import (
    add_camera,
    add_node,
    add_plane,
    empty_material,
    new_scene,
    passes_of_both,
    render_passes,
)


def add_aov(name: str, kind: str) -> None:
    made = bpy.context.view_layer.aovs.add()
    made.name, made.type = name, kind


def add_output(tree: Any, name: str, **values: Any) -> Any:
    node = add_node(tree, "ShaderNodeOutputAOV", **values)
    node.aov_name = name
    return node


def scene_with_aovs() -> Any:
    """A square that writes a colour, a number that varies, and one by way of a group."""
    scene = new_scene(8, 8, 16)
    for name, kind in (("Tint", "COLOR"), ("Height", "VALUE"), ("Inner", "VALUE")):
        add_aov(name, kind)
    material, tree, output = empty_material("Writer")
    shader = add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5))
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    add_output(tree, "Tint", Color=(0.25, 2, 0.5))
    height = add_output(tree, "Height")
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(geometry.outputs["Position"], split.inputs[0])
    tree.links.new(split.outputs[0], height.inputs["Value"])
    add_output(tree, "Nobody's", Value=9.0)
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    add_output(inner, "Inner", Value=0.75)
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree = inner
    add_plane(1, 0, material)
    add_camera(ortho_scale=2)
    return scene


def test_they_are_passes_by_their_names(tmp_path: Path) -> None:
    scene_with_aovs()
    passes = {name.removeprefix("ViewLayer."): p for name, p in render_passes(tmp_path).items()}
    np.testing.assert_allclose(passes["Tint"][4, 4], (0.25, 2, 0.5, 1))
    assert not passes["Tint"][0, 0].any()
    np.testing.assert_allclose(passes["Height"][4, 3:5, 0], (-0.125, 0.125), atol=0.05)
    np.testing.assert_allclose(passes["Inner"][4, 4, 0], 0.75)
    assert "Nobody's" not in passes


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0")
def test_they_are_cycles(tmp_path: Path) -> None:
    ours, theirs = passes_of_both(scene_with_aovs(), tmp_path)
    assert ours.keys() == theirs.keys()
    inside = slice(3, 5)
    for name in ("Tint", "Height", "Inner"):
        assert ours[name].shape == theirs[name].shape
        np.testing.assert_allclose(
            ours[name][inside, inside], theirs[name][inside, inside], atol=0.05, err_msg=name
        )


def test_more_than_there_are_numbers_for_are_told(tmp_path: Path, caplog: Any) -> None:
    scene_with_aovs()
    for index in range(15):
        add_aov(f"More {index:02}", "VALUE")
    names = {name.removeprefix("ViewLayer.") for name in render_passes(tmp_path)}
    assert "More 12" in names
    assert "More 13" not in names
    assert 'there are 16 AOVs at the most: "More 13" is left out' in caplog.text
