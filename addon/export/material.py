# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials, and which of them an object's mesh has in its slots."""

from __future__ import annotations

import bpy

import basicrt

from ..nodes import Textures, translate_surface
from ..report import Report


def convert(b_material: bpy.types.Material, report: Report, textures: Textures) -> basicrt.Material:
    """The surface of a material; its textures go to `textures`."""
    material = translate_surface(b_material, report, textures)
    material.pass_index = b_material.pass_index
    return material


def slots(b_object: bpy.types.Object, b_mesh: bpy.types.Mesh) -> list[bpy.types.Material | None]:
    """The material of each slot: the evaluated mesh's, unless the object's slot has its own."""
    materials: list[bpy.types.Material | None] = list(b_mesh.materials)
    for index, slot in enumerate(b_object.material_slots[: len(materials)]):
        if slot.link == "OBJECT" and slot.material is not None:
            materials[index] = slot.material
    return materials
