# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of coordinates: what an emission shows of them on a plane, here and in Cycles, by pixel.

What is made of coordinates is in test_texture_values.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

from support.blender import add_camera, add_plane, empty_material, new_scene, render_both

SIZE = 24
TOLERANCE = 3e-3  # filters of 0.01 pixels move points by up to 1e-4 m


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


def compare(tree: Any, socket: Any, emission: Any, folder: Path) -> None:
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
    assert not differs.any(), np.abs(ours - theirs).max()


@pytest.mark.parametrize("name", ["Generated", "Normal", "Object", "Camera", "Reflection"])
def test_texture_coordinate(name: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeTexCoord")
    compare(tree, node.outputs[name], emission, tmp_path)


@pytest.mark.parametrize("name", ["Position", "Normal", "True Normal", "Incoming"])
def test_geometry(name: str, tmp_path: Path) -> None:
    tree, node, emission = tree_with("ShaderNodeNewGeometry")
    compare(tree, node.outputs[name], emission, tmp_path)
