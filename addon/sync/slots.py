# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials of a native scene, and those that objects have in their slots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

import basicrt

from ..export import material
from ..export.identity import uid
from ..nodes import MeshData, ObjectData, Textures
from ..report import Report
from .changes import Changes


@dataclass(frozen=True)
class Slots:
    """What an object's mesh has in its slots."""

    materials: list[int | None]  # in Scene.materials; None is Blender's default
    asked: frozenset[MeshData]  # what they ask of the mesh
    asked_of_object: frozenset[ObjectData]


class Materials:
    """Converts materials, each once."""

    def __init__(
        self, scene: basicrt.Scene, names: list[str], report: Report, textures: Textures
    ) -> None:
        self._scene = scene
        self._names = names
        self._report = report
        self._textures = textures
        self._indices: dict[int, int] = {}  # by the material's number
        self._slots: dict[tuple[int, ...], Slots] = {}  # of one update, by the materials' numbers

    def begin(self) -> None:
        """Materials may ask for something else than they did."""
        self._slots.clear()

    def update(self, depsgraph: bpy.types.Depsgraph, changes: Changes) -> bool:
        """Convert again those that changed; whether they ask meshes for the same as before."""
        is_same = True
        wanted = changes.materials & self._indices.keys()
        for b_material in bpy.data.materials if wanted else ():
            key = uid(b_material)
            if key not in wanted:
                continue
            asked = self._asked_by(key)
            index = self._indices[key]
            evaluated: Any = b_material.evaluated_get(depsgraph)
            converted = material.convert(evaluated, self._report, self._textures)
            self._scene.materials[index] = converted
            self._names[index] = f'material "{b_material.name}"'
            is_same &= asked == self._asked_by(key)
            wanted = wanted - {key}
        return is_same and not wanted

    def _asked_by(self, number: int) -> tuple[Any, Any]:
        """What a material asks for of meshes and of objects."""
        textures = self._textures
        return textures.mesh_data.get(number), textures.object_data.get(number)

    def slots(
        self, b_object: bpy.types.Object, b_mesh: bpy.types.Mesh, b_override: Any = None
    ) -> Slots:
        """Of an object's mesh; all are the override where there is one."""
        b_materials = [b_override] if b_override else material.slots(b_object, b_mesh)
        numbers = tuple([0 if one is None else uid(one) for one in b_materials])
        if numbers not in self._slots:
            self._slots[numbers] = self._make(b_materials, numbers)
        return self._slots[numbers]

    def _make(
        self, b_materials: list[bpy.types.Material | None], numbers: tuple[int, ...]
    ) -> Slots:
        """Of these materials."""
        indices = [self._index(b_material) for b_material in b_materials]
        of_mesh, of_object = self._textures.mesh_data, self._textures.object_data
        return Slots(
            indices,
            frozenset[MeshData]().union(*(of_mesh.get(number, ()) for number in numbers)),
            frozenset[ObjectData]().union(*(of_object.get(number, ()) for number in numbers)),
        )

    def _index(self, b_material: bpy.types.Material | None) -> int | None:
        """The index of a material, None for none."""
        if b_material is None:
            return None
        key = uid(b_material)
        if key not in self._indices:
            converted = material.convert(b_material, self._report, self._textures)
            self._names.append(f'material "{b_material.name}"')
            self._indices[key] = self._scene.materials.append(converted)
        return self._indices[key]
