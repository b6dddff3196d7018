# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball for each shader node that BasicRT knows, in two rows on a checkered floor's two greys."""

from __future__ import annotations

import bpy
import stage

WHITE = (1.0, 1.0, 1.0)
COLUMNS = 6
SPACING = 1.15


def new_materials() -> list[bpy.types.Material]:
    """One material for each ball."""
    new = stage.new_material
    return [
        stage.diffuse("Diffuse", (0.8, 0.25, 0.1)),
        new("Glossy", "ShaderNodeBsdfAnisotropic", Color=(0.95, 0.75, 0.4), Roughness=0.25),
        new("Mirror", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.9, 0.9), Roughness=0.0),
        new("Glass", "ShaderNodeBsdfGlass", Color=WHITE, Roughness=0.0, IOR=1.5),
        new("Rough Glass", "ShaderNodeBsdfGlass", Color=(0.8, 0.95, 1.0), Roughness=0.3, IOR=1.5),
        new(
            "Refraction", "ShaderNodeBsdfRefraction", Color=(1.0, 0.9, 0.9), Roughness=0.0, IOR=1.33
        ),
        new("Transparent", "ShaderNodeBsdfTransparent", Color=(0.4, 0.8, 0.5)),
        new("Emission", "ShaderNodeEmission", Color=(1.0, 0.6, 0.25), Strength=3.0),
        new_mix(),
        new_add(),
        new(
            "Principled Plastic",
            "ShaderNodeBsdfPrincipled",
            Base_Color=(0.05, 0.2, 0.7),
            Roughness=0.25,
        ),
        new(
            "Principled Metal",
            "ShaderNodeBsdfPrincipled",
            Base_Color=(0.9, 0.5, 0.3),
            Metallic=1.0,
            Roughness=0.35,
        ),
    ]


def new_mix() -> bpy.types.Material:
    """Half matt, half mirror."""
    material, tree, output = stage.empty_material("Mix")
    mix = stage.new_node(tree, "ShaderNodeMixShader", Fac=0.4)
    first = stage.new_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.1, 0.4, 0.15))
    second = stage.new_node(tree, "ShaderNodeBsdfAnisotropic", Color=WHITE, Roughness=0.1)
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def new_add() -> bpy.types.Material:
    """Matt and shining at once."""
    material, tree, output = stage.empty_material("Add")
    both = tree.nodes.new("ShaderNodeAddShader")
    first = stage.new_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.3, 0.3, 0.8))
    second = stage.new_node(tree, "ShaderNodeEmission", Color=(0.6, 0.1, 0.4), Strength=0.5)
    tree.links.new(first.outputs[0], both.inputs[0])
    tree.links.new(second.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    return material


def build(scene: bpy.types.Scene) -> None:
    """Build it into an empty scene."""
    for index, material in enumerate(new_materials()):
        column, row = index % COLUMNS, index // COLUMNS
        x = (column - (COLUMNS - 1) / 2) * SPACING
        stage.sphere(material.name, 0.5, (x, row * 1.3, 0.5), material)
    build_floor()
    stage.lamp("AREA", "Key", (-3, -3, 5), (40, 0, -40), 300.0, shape="SQUARE", size=2.0)
    stage.set_world((0.75, 0.85, 1.0), 0.5)
    stage.camera((0, -9, 4.2), (0, 0.6, 0.35), lens=49.0)
    stage.set_picture(scene, 640, 320, samples=128)


def build_floor() -> None:
    """Tiles of two materials in one mesh: every second face has the second slot."""
    count, size = 12, 1.0
    half = count * size / 2
    vertices = [
        (x * size - half, y * size - half, 0.0) for y in range(count + 1) for x in range(count + 1)
    ]
    faces = [
        (a, a + 1, a + count + 2, a + count + 1)
        for a in (y * (count + 1) + x for y in range(count) for x in range(count))
    ]
    mesh = stage.new_mesh("Floor", vertices, faces, stage.diffuse("Light Tile", (0.7, 0.7, 0.7)))
    mesh.materials.append(stage.diffuse("Dark Tile", (0.25, 0.25, 0.25)))
    for index, polygon in enumerate(mesh.polygons):
        polygon.material_index = (index % count + index // count) % 2
    stage.place(mesh, "Floor")
