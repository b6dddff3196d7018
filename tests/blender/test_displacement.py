# SPDX-License-Identifier: GPL-3.0-or-later
"""Displaced surfaces: where they are and which way they face, as in Cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

import basicrt
from support.blender import add_node, export, new_image, place
from support.surfaces import ball, compare, shining_material

# The share of pixels at edges of triangles and of the ball.
EDGES = 0.03
# The same of bumps. Before 4.3 Cycles looks at heights a whole pixel away, and on some facets it is another way.
FACETS = 2 * EDGES if bpy.app.version >= (4, 3, 0) else 4 * EDGES


def noise(tree: Any, coordinates: str = "Generated") -> Any:
    made = add_node(tree, "ShaderNodeTexNoise", Scale=2.5)
    source = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(source.outputs[coordinates], made.inputs["Vector"])
    return made


def displace(tree: Any, socket: Any, method: str) -> None:
    sink = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(socket, sink.inputs["Displacement"])
    bpy.data.materials[0].displacement_method = method


def by_height(tree: Any, space: str = "OBJECT", coordinates: str = "Generated") -> Any:
    node = add_node(tree, "ShaderNodeDisplacement", Scale=0.8, Midlevel=0.4)
    node.space = space
    tree.links.new(noise(tree, coordinates).outputs[0], node.inputs["Height"])
    return node


def fine_ball(is_smooth: bool = True) -> tuple[Any, Any, Any]:
    tree, emission, made = ball(is_smooth)
    made.modifiers.new("Fine", "SUBSURF").render_levels = 2
    made.modifiers[0].levels = 2
    return tree, emission, made


def shown(tree: Any, name: str) -> Any:
    """What pictures are of."""
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    return geometry.outputs[name]


@pytest.mark.parametrize("value", ["Position", "Normal", "True Normal"])
@pytest.mark.parametrize("is_smooth", [True, False])
def test_displacement_by_a_height(value: str, is_smooth: bool, tmp_path: Path) -> None:
    tree, emission, _made = fine_ball(is_smooth)
    displace(tree, by_height(tree).outputs[0], "DISPLACEMENT")
    tolerance, edges = (0.01, EDGES) if is_smooth or value == "Position" else (0.03, 2 * EDGES)
    compare(tree, shown(tree, value), emission, tmp_path, tolerance, edges)


@pytest.mark.parametrize("space", ["OBJECT", "WORLD"])
def test_spaces_of_a_height(space: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    displace(tree, by_height(tree, space).outputs[0], "DISPLACEMENT")
    compare(tree, shown(tree, "Position"), emission, tmp_path, 0.01, EDGES)


@pytest.mark.parametrize("coordinates", ["Generated", "UV"])
@pytest.mark.parametrize("space", ["OBJECT", "WORLD"])
@pytest.mark.parametrize("value", ["Position", "Normal"])
def test_displacement_and_bump(value: str, space: str, coordinates: str, tmp_path: Path) -> None:
    """Bumps are those of the surface as it was, however far it is moved."""
    tree, emission, _made = fine_ball()
    displace(tree, by_height(tree, space, coordinates).outputs[0], "BOTH")
    compare(tree, shown(tree, value), emission, tmp_path, 0.02, FACETS)


# In Cycles what is interpolated changes with the pixel, and on some facets the surface does in another direction: of
# bumps on displaced surfaces the same is known of both.
CHANGING = {"BUMP": "Object", "BOTH": "Generated"}


def by_vectors(tree: Any, space: str, coordinates: str = "Generated") -> Any:
    node = add_node(tree, "ShaderNodeVectorDisplacement", Scale=0.7, Midlevel=0.3)
    node.space = space
    tree.links.new(noise(tree, coordinates).outputs["Color"], node.inputs["Vector"])
    return node


@pytest.mark.parametrize("method", ["BUMP", "BOTH"])
@pytest.mark.parametrize("space", ["OBJECT", "WORLD", "TANGENT"])
def test_bumps_by_vectors(space: str, method: str, tmp_path: Path) -> None:
    tree, emission, _made = fine_ball()
    displace(tree, by_vectors(tree, space, CHANGING[method]).outputs[0], method)
    compare(tree, shown(tree, "Normal"), emission, tmp_path, 0.02, FACETS)


@pytest.mark.parametrize("method", ["BUMP", "BOTH"])
def test_bumps_along_another_normal(method: str, tmp_path: Path) -> None:
    """Of a height that counts along a normal that is linked, only what it raises the surface by."""
    tree, emission, _made = fine_ball()
    node = by_height(tree, coordinates=CHANGING[method])
    tilted = tree.nodes.new("ShaderNodeVectorMath")
    tilted.inputs[1].default_value = (0.5, 0.2, 0.1)
    tree.links.new(shown(tree, "Normal"), tilted.inputs[0])
    tree.links.new(tilted.outputs[0], node.inputs["Normal"])
    displace(tree, node.outputs[0], method)
    compare(tree, shown(tree, "Normal"), emission, tmp_path, 0.02, FACETS)


@pytest.mark.parametrize("space", ["OBJECT", "WORLD", "TANGENT"])
def test_displacement_by_vectors(space: str, tmp_path: Path) -> None:
    tree, emission, _made = ball()
    displace(tree, by_vectors(tree, space).outputs[0], "DISPLACEMENT")
    compare(tree, shown(tree, "Position"), emission, tmp_path, 0.01, EDGES)


def test_displacement_by_a_map(tmp_path: Path) -> None:
    """Of floats, half of which are negative."""
    tree, emission, _made = fine_ball()
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = new_image(np.random.default_rng(3).random((8, 8, 4)) - (0.5, 0.5, 0.5, 0))
    node = add_node(tree, "ShaderNodeVectorDisplacement", Scale=0.5, Midlevel=0.0)
    node.space = "OBJECT"
    tree.links.new(image.outputs["Color"], node.inputs["Vector"])
    displace(tree, node.outputs[0], "DISPLACEMENT")
    compare(tree, shown(tree, "Position"), emission, tmp_path, 0.01, EDGES)


def test_sums_of_displacements(tmp_path: Path) -> None:
    tree, emission, _made = ball()
    other = add_node(tree, "ShaderNodeVectorDisplacement", Vector=(0.2, 0.3, -0.2), Midlevel=0.0)
    total = tree.nodes.new("ShaderNodeVectorMath")
    tree.links.new(by_height(tree).outputs[0], total.inputs[0])
    tree.links.new(other.outputs[0], total.inputs[1])
    displace(tree, total.outputs[0], "DISPLACEMENT")
    compare(tree, shown(tree, "Position"), emission, tmp_path, 0.01, EDGES)


def test_texture_coordinates_are_those_of_the_undisplaced_surface(tmp_path: Path) -> None:
    tree, emission, _made = fine_ball()
    displace(tree, by_height(tree).outputs[0], "DISPLACEMENT")
    source = tree.nodes.new("ShaderNodeTexCoord")
    compare(tree, source.outputs["Generated"], emission, tmp_path, 0.01, EDGES)


def test_the_parts_of_a_mesh_are_moved_by_their_own_materials(tmp_path: Path) -> None:
    tree, emission, made = ball()
    displace(tree, by_height(tree).outputs[0], "DISPLACEMENT")
    plain, _tree, still = shining_material()
    still.inputs["Color"].default_value = (0.2, 0.4, 0.6, 1)
    made.data.materials.append(plain)
    for index, polygon in enumerate(made.data.polygons):
        polygon.material_index = int(index % 3 == 0)
    compare(tree, shown(tree, "Position"), emission, tmp_path, 0.01, 2 * EDGES)


def test_objects_of_one_mesh_and_other_materials_are_displaced_by_themselves() -> None:
    tree, _emission, made = ball()
    displace(tree, by_height(tree).outputs[0], "DISPLACEMENT")
    twin = place(made.data, (3, 0, 0), name="Plain")
    plain, _tree, _still = shining_material()
    twin.material_slots[0].link = "OBJECT"
    twin.material_slots[0].material = plain
    report = Report()
    scene = export(report)
    assert not report.warnings
    materials = [scene.materials[instance.materials[0]] for instance in scene.instances]
    moved = [
        any(isinstance(node, basicrt.DisplacementShader) for node in one.nodes) for one in materials
    ]
    assert sorted(moved) == [False, True, True]


def test_adaptive_subdivision_is_told_of() -> None:
    _tree, _emission, made = fine_ball()
    modifier = made.modifiers[0]
    if hasattr(modifier, "use_adaptive_subdivision"):
        modifier.use_adaptive_subdivision = True
    else:
        bpy.context.scene.cycles.feature_set = "EXPERIMENTAL"
        made.cycles.use_adaptive_subdivision = True
    report = Report()
    export(report)
    told = [text for text in report.warnings if "Adaptive Subdivision" in text]
    assert told == [
        f'object "{made.name}": Adaptive Subdivision is not supported: its levels count'
    ]
