# SPDX-License-Identifier: GPL-3.0-or-later
"""What nodes give at a surface: pictures of an emission of it, here and in Cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np

from support.blender import add_camera, add_mesh, add_plane, empty_material, new_scene, render_both

SIZE = 24
TOLERANCE = 3e-3


def shining_material() -> tuple[Any, Any, Any]:
    """A material, its tree, and an emission."""
    material, tree, output = empty_material()
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material, tree, emission


def add_ball(material: Any, is_smooth: bool = True, columns: int = 8, rows: int = 6) -> Any:
    """A coarse ball with a UV map: columns mirrored by turns."""
    angles = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    heights = np.linspace(0, np.pi, rows + 1)[1:-1]
    vertices = [
        (np.sin(b) * np.cos(a), np.sin(b) * np.sin(a), np.cos(b)) for b in heights for a in angles
    ]
    faces, uvs = [], []
    for row in range(len(heights) - 1):
        for i in range(columns):
            j = (i + 1) % columns
            faces.append(
                [
                    row * columns + i,
                    (row + 1) * columns + i,
                    (row + 1) * columns + j,
                    row * columns + j,
                ]
            )
            left, right = (i + 1, i) if i % 2 else (i, i + 1)
            v = row / 4
            uvs += [(left / 4, v + 0.25), (left / 4, v), (right / 4, v), (right / 4, v + 0.25)]
    made = add_mesh(vertices, faces, material)
    layer = made.data.uv_layers.new(name="Ball")
    layer.uv.foreach_set("vector", np.array(uvs, np.float32).ravel())
    made.data.polygons.foreach_set("use_smooth", [is_smooth] * len(made.data.polygons))
    made.data.update()
    return made


def place_before_camera(made: Any) -> None:
    """Scaled, turned, parented, and seen in perspective."""
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location, parent.rotation_euler, parent.scale = (
        (0.1, 0.2, -0.1),
        (0.2, 0.1, 0.5),
        (1.2, 1.2, 1.2),
    )
    made.parent = parent
    made.scale, made.rotation_euler = (1.0, 0.7, 1.3), (0.4, 0.3, 0.2)
    # Of a mesh that only one object has, Cycles interpolates normals after the scaling.
    twin = bpy.data.objects.new("Twin", made.data)
    bpy.context.scene.collection.objects.link(twin)
    twin.location.x = 100
    add_camera((0.5, -0.6, 5), (0.1, 0.1, 0.3), "PERSP", lens=70)


def ball(is_smooth: bool = True) -> tuple[Any, Any, Any]:
    """The tree, the emission and the object of a new scene."""
    new_scene(SIZE, SIZE, samples=1)
    material, tree, emission = shining_material()
    made = add_ball(material, is_smooth)
    place_before_camera(made)
    return tree, emission, made


def plane() -> tuple[Any, Any, Any]:
    """The same with a tilted plane that fills the picture."""
    new_scene(SIZE, SIZE, samples=1)
    material, tree, emission = shining_material()
    made = add_plane(size=4, material=material)
    made.data.uv_layers.new(name="Flat")
    made.rotation_euler = (0.3, 0.2, 0.1)
    add_camera((0.1, 0.2, 3), (0.1, 0.05, 0.2), "PERSP", lens=90)
    return tree, emission, made


def output_of(node: Any, identifier: str) -> Any:
    """A socket by identifier."""
    return next(socket for socket in node.outputs if socket.identifier == identifier)


def pictures(
    tree: Any, socket: Any, emission: Any, folder: Path, scale: float = 0.5
) -> tuple[np.ndarray, np.ndarray]:
    """Both of an output, scaled and moved by a half, so that negative values show."""
    halved = tree.nodes.new("ShaderNodeVectorMath")
    halved.operation = "MULTIPLY_ADD"
    halved.inputs[1].default_value = (scale, scale, scale)
    halved.inputs[2].default_value = (0.5, 0.5, 0.5)
    tree.links.new(socket, halved.inputs[0])
    tree.links.new(halved.outputs[0], emission.inputs["Color"])
    ours, theirs = render_both(folder)
    return ours[..., :3], np.maximum(theirs[..., :3], 0)


def compare(
    tree: Any,
    socket: Any,
    emission: Any,
    folder: Path,
    tolerance: float = TOLERANCE,
    share: float = 0.01,
    scale: float = 0.5,
) -> None:
    """Of an output: `share` of the pixels may differ, at the edges of triangles."""
    ours, theirs = pictures(tree, socket, emission, folder, scale)
    assert np.ptp(theirs) > 0, "shows nothing that could differ"
    differences = np.abs(ours - theirs).max(axis=2)
    worst = np.sort(differences.ravel())[::-1][:8]
    assert (differences > tolerance).mean() <= share, f"{worst} of {differences.mean()}"
