# SPDX-License-Identifier: GPL-3.0-or-later
"""Placed meshes and lamps: the instances and lights of a native scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

import basicrt

from .. import compat
from ..export import (
    attributes,
    hair,
    light,
    light_groups,
    light_links,
    material,
    mesh,
    object_properties,
    points,
    visibility,
)
from ..export.identity import random_number, uid
from ..nodes import MeshData, ObjectData, Textures
from ..report import ExportError, Report
from .changes import Changes
from .motion import Key, Movement, hair_key, key_of
from .shapes import Geometry, Shapes

# Kinds of objects that Blender would draw and BasicRT doesn't. (Curves, text and the like come as
# meshes too.)
_UNSUPPORTED = {"VOLUME": "volumes"}
_SUPPORTED = ("MESH", "CURVES", "POINTCLOUD")


@dataclass
class Placed:
    """An object that is placed by itself, as the dependency graph would show it among its instances."""

    object: Any
    parent: None = None
    is_instance: bool = False

    @property
    def matrix_world(self) -> Matrix:
        """Where it is."""
        matrix: Matrix = self.object.matrix_world
        return matrix


@dataclass(frozen=True)
class Filter:
    """What of the scene is shown."""

    b_space: Any = None  # a viewport that may hide what the scene shows; None hides nothing
    has_lights: bool = True

    def shows(self, b_instance: Any) -> bool:
        """Whether a placed object is among it."""
        return bool(b_instance.show_self) and self._shows_object(b_instance)

    def shows_hair(self, b_instance: Any) -> bool:
        """Whether hair that grows on a placed object is."""
        return bool(b_instance.show_particles) and self._shows_object(b_instance)

    def _shows_object(self, b_instance: Any) -> bool:
        if self.b_space is None:
            return True
        b_root = (b_instance.parent if b_instance.is_instance else None) or b_instance.object
        return bool(b_root.visible_in_viewport_get(self.b_space))


@dataclass
class _Known:
    """An instance of the scene."""

    index: int  # in Scene.instances
    shape: int  # in Scene.shapes
    owners: tuple[int, int]  # the numbers of the object and of what instances it, or 0


class Instances:
    """Converts what is placed; what several instances share is converted once."""

    def __init__(
        self,
        scene: basicrt.Scene,
        names: dict[str, list[str]],
        report: Report,
        textures: Textures,
        movement: Movement[Any] | None = None,
    ) -> None:
        self._scene = scene
        self._names = names
        self._report = report
        self._textures = textures
        self._movement = movement
        self._shapes = Shapes(scene, names["shapes"])
        self._materials: dict[int, int] = {}  # by the material's number
        self._known: dict[Key, _Known | None] = {}  # None: it is none of ours, or has no faces
        self._lights: dict[Key, int] = {}  # in Scene.lights
        self._lamp_materials: dict[Key, int] = {}  # in Scene.materials
        self._object_names: dict[int, str] = {}
        self._hairy: set[int] = set()  # the numbers of objects that hair grows on
        self._instanced: set[int] = (
            set()
        )  # the numbers of objects that are placed by others, and of those
        # Of one update, by the numbers of an object and of what instances it, and by the mesh's key.
        self._slots: dict[tuple[int, int], list[int | None]] = {}
        self._asked: dict[tuple[int, int], frozenset[MeshData]] = {}
        self._asked_of_objects: dict[tuple[int, int], frozenset[ObjectData]] = {}
        self._visibility: dict[tuple[int, int], int] = {}
        self._links = light_links.LightLinks()
        self._is_forgotten = False

    def begin(self, depsgraph: bpy.types.Depsgraph, changes: Changes) -> None:
        """Forget what has changed."""
        self._b_view_layer: Any = depsgraph.view_layer_eval
        b_original_layer: Any = depsgraph.view_layer
        self._b_original_layer: Any = b_original_layer
        self._b_scene: Any = depsgraph.scene_eval
        self._is_render = depsgraph.mode == "RENDER"
        self._groups = light_groups.numbers(b_original_layer, self._report)
        if changes.is_selection:  # Blender says so of each change of a link
            self._links = light_links.read(self._b_scene, self._report)
        self._slots.clear()
        self._asked.clear()
        self._asked_of_objects.clear()
        self._visibility.clear()
        if changes.shapes:
            may_lack = changes.is_selection
            present = {uid(b_object) for b_object in depsgraph.objects} if may_lack else None
            self._shapes.forget(changes.shapes, present)

    def forget(self) -> None:
        """Convert all of them again in the next scan; shapes and materials stay."""
        self._is_forgotten = True

    def update_materials(self, depsgraph: bpy.types.Depsgraph, changes: Changes) -> bool:
        """Convert again the materials that changed; whether they ask meshes for the same as before."""
        is_same = True
        wanted = changes.materials & self._materials.keys()
        for b_material in bpy.data.materials if wanted else ():
            key = uid(b_material)
            if key not in wanted:
                continue
            asked = self._asked_by(key)
            index = self._materials[key]
            evaluated: Any = b_material.evaluated_get(depsgraph)
            converted = material.convert(evaluated, self._report, self._textures)
            self._scene.materials[index] = converted
            self._names["materials"][index] = f'material "{b_material.name}"'
            is_same &= asked == self._asked_by(key)
            wanted = wanted - {key}
        return is_same and not wanted

    def _asked_by(self, material_number: int) -> tuple[Any, Any]:
        """What a material asks for of meshes and of objects."""
        textures = self._textures
        return textures.mesh_data.get(material_number), textures.object_data.get(material_number)

    def touch(self, depsgraph: bpy.types.Depsgraph, changes: Changes, shown: Filter) -> bool:
        """Update the objects that changed and nothing else; False where that can't be done."""
        found = []
        for number in changes.objects | self._lamps_with(changes.lights):
            b_object: Any = bpy.data.objects.get(self._object_names.get(number, ""))
            if b_object is None or b_object.session_uid != number:
                return False
            evaluated = b_object.evaluated_get(depsgraph)
            if number in self._hairy or len(evaluated.particle_systems) > 0:
                return False
            is_alone = (number, 0, ()) in self._known and number not in self._instanced
            if evaluated.is_instancer or not is_alone:
                return False
            found.append(evaluated)
        for evaluated in found:
            key = (uid(evaluated), 0, ())
            is_shown_lamp = evaluated.type == "LIGHT" and shown.has_lights
            if is_shown_lamp and not self._touch_light(key, evaluated):
                return False
            known = self._known[key]
            if known is None:
                continue
            made = self._convert(Placed(evaluated), evaluated)
            if made is None:
                return False
            instance, shape = made
            self._scene.instances[known.index] = instance
            self._shapes.use(shape)
            self._shapes.release(known.shape)
            known.shape = shape
        self._shapes.sweep()
        return True

    def _lamps_with(self, lights: set[int]) -> set[int]:
        """The numbers of the objects here that have one of these lights."""
        if not lights:
            return set()
        lamps: list[Any] = [each for each in bpy.data.objects if each.type == "LIGHT"]
        return {uid(one) for one in lamps if uid(one.data) in lights} & self._object_names.keys()

    def scan(self, depsgraph: bpy.types.Depsgraph, changes: Changes, shown: Filter) -> None:
        """Go over everything, and convert what is new or changed."""
        before, self._known = self._known, {}
        self._object_names.clear()
        self._instanced.clear()
        self._hairy.clear()
        self._scene.lights.clear()
        self._lights.clear()
        kept: list[basicrt.Instance | None] = []  # None: as it was, at the same place
        moved = len(before) == 0
        for b_instance in depsgraph.object_instances:
            b_object: Any = b_instance.object
            for system in self._parts(b_instance, shown):
                key = key_of(b_instance) if system is None else hair_key(b_instance, system.index)
                self._object_names[key[0]] = b_object.original.name
                if b_instance.is_instance:
                    self._instanced.update(key[:2])
                if b_object.type == "LIGHT":
                    self._known[key] = None
                    self._add_light(key, b_instance, shown)
                    continue
                known = before.get(key)
                if known is not None and self._is_kept(known, b_instance, changes):
                    self._known[key] = _Known(len(kept), known.shape, known.owners)
                    self._shapes.use(known.shape)
                    moved |= known.index != len(kept)
                    kept.append(None)
                    continue
                self._known[key] = None
                made = self._convert(b_instance, b_object, system)
                if made is None:
                    continue
                instance, shape = made
                self._shapes.use(shape)
                b_parent = b_instance.parent if b_instance.is_instance else None
                owners = (key[0], uid(b_parent) if b_parent else 0)
                self._known[key] = _Known(len(kept), shape, owners)
                if self._movement is not None:
                    self._movement.note(b_instance, self._b_scene, key, len(kept), shape)
                kept.append(instance)
        self._is_forgotten = False
        self._replace_instances(before, kept, moved)
        for known in before.values():
            if known is not None:
                self._shapes.release(known.shape)
        self._shapes.sweep()

    def index_of(self, number: int) -> int | None:
        """Where in Scene.instances an object is that is placed by itself, by its number."""
        known = self._known.get((number, 0, ()))
        return known.index if known is not None else None

    def _parts(self, b_instance: Any, shown: Filter) -> list[hair.System | None]:
        """What is shown of a placed object: itself (None), and hair that grows on it."""
        parts: list[hair.System | None] = [None] if shown.shows(b_instance) else []
        if shown.shows_hair(b_instance):
            systems = hair.systems(b_instance.object, self._is_render)
            if systems:
                self._hairy.add(uid(b_instance.object))
            parts += systems
        return parts

    def _replace_instances(
        self, before: dict[Key, _Known | None], kept: list[basicrt.Instance | None], moved: bool
    ) -> None:
        """Make the table of instances that of the new ones, and of those that stay."""
        table = self._scene.instances
        if not moved and len(kept) == len(table):
            for index, instance in enumerate(kept):
                if instance is not None:
                    table[index] = instance
            return
        for key, known in self._known.items():
            if known is not None and kept[known.index] is None:
                old = before[key]
                assert old is not None
                kept[known.index] = table[old.index]
        table.clear()
        for instance in kept:
            assert instance is not None
            table.append(instance)

    def _is_kept(self, known: _Known, b_instance: Any, changes: Changes) -> bool:
        """Whether an instance is what it was. Any object may have to do with where instances of others are."""
        if self._is_forgotten or (b_instance.is_instance and changes.objects):
            return False
        return changes.objects.isdisjoint(known.owners)

    def _add_light(self, key: Key, b_instance: Any, shown: Filter) -> None:
        """One placed lamp."""
        if not shown.has_lights:
            return
        converted = self._convert_light(key, b_instance)
        if converted is not None:
            self._lights[key] = self._scene.lights.append(converted)

    def _touch_light(self, key: Key, b_object: Any) -> bool:
        """A lamp that changed; False where it begins to shine, or does not shine any more."""
        if key not in self._lights:
            return False
        converted = self._convert_light(key, Placed(b_object))
        if converted is not None:
            self._scene.lights[self._lights[key]] = converted
        return converted is not None

    def _convert_light(self, key: Key, b_instance: Any) -> Any:
        """A lamp, None where it doesn't shine."""
        b_object = b_instance.object
        random = random_number(b_instance)
        made = light.convert(
            b_object, b_instance.matrix_world, random, self._report, self._textures
        )
        if made is None:
            return None
        converted, lamp_material = made
        converted.light_group = light_groups.number_of(b_object, self._groups)
        self._links.apply(converted, b_object)
        if lamp_material is not None:
            converted.material = self._put_lamp_material(key, b_object, lamp_material)
        return converted

    def _put_lamp_material(self, key: Key, b_object: Any, lamp_material: basicrt.Material) -> int:
        """The index of what a lamp's light varies by, in place of what it was."""
        if key not in self._lamp_materials:
            self._names["materials"].append(f'light "{b_object.name}"')
            self._lamp_materials[key] = self._scene.materials.append(lamp_material)
            return self._lamp_materials[key]
        index = self._lamp_materials[key]
        self._scene.materials[index] = lamp_material
        return index

    def _warn(self, b_object: bpy.types.Object, message: str) -> None:
        self._report.warn(f'object "{b_object.name}"', message)

    def _convert(
        self, b_instance: Any, b_object: Any, system: hair.System | None = None
    ) -> tuple[basicrt.Instance, int] | None:
        """One placed object, or hair on it, and the index of its shape; None where there is nothing to see."""
        if b_object.type in _UNSUPPORTED:
            self._warn(b_object, f"{_UNSUPPORTED[b_object.type]} are not supported: left out")
        if compat.has_adaptive_subdivision(b_object, self._b_scene):
            self._warn(b_object, "Adaptive Subdivision is not supported: its levels count")
        b_mesh: Any = b_object.data
        if b_mesh is None or not (b_object.type in _SUPPORTED or system):
            return None
        materials = self._materials_of(b_object, b_mesh)
        if system is not None:
            materials = materials[min(system.slot, len(materials) - 1) :][:1]
        shape = self._shape_of(b_instance, b_object, b_mesh, system)
        if shape is None:
            return None
        transform = np.array(b_instance.matrix_world, np.float64)
        if not np.isfinite(transform).all():
            raise ExportError(f'object "{b_object.name}": its transform is not finite')
        if np.linalg.det(transform[:3, :3].astype(np.float32)) == 0.0:
            self._warn(b_object, "scaled to nothing along an axis: left out")
            return None
        instance = basicrt.Instance(
            shape=shape,
            transform=transform,
            materials=materials,
            name=b_object.name,
            light_group=light_groups.number_of(b_object, self._groups),
            visibility=self._visibility_of(b_instance, b_object),
            color=b_object.color[:3],
            alpha=b_object.color[3],
            random=random_number(b_instance),
            holdout=self._is_holdout(b_instance, b_object),
            shadow_catcher=self._is_shadow_catcher(b_instance, b_object),
            shadow_terminator_offset=compat.shadow_terminator_offset(b_object),
            shadow_terminator_shading_offset=compat.shadow_terminator_shading_offset(b_object),
            pass_index=b_object.pass_index,
            asset_name=self._asset_name(b_instance, b_object),
        )
        b_parent = b_instance.parent if b_instance.is_instance else None
        self._links.apply(instance, b_object, b_parent)
        asked = self._asked_of_objects[uid(b_object), mesh.key(b_mesh)]
        if asked:
            instance.properties = object_properties.convert(b_instance, asked, self._report)
        return instance, shape

    def _shape_of(
        self, b_instance: Any, b_object: Any, b_data: Any, system: hair.System | None
    ) -> int | None:
        """The index of a geometry's shape, None where there is nothing of it."""
        asked = self._asked[uid(b_object), mesh.key(b_data)]
        form = hair.form(self._b_scene) if system or b_object.type == "CURVES" else ""
        number = mesh.key(b_data) if system is None else system.pointer
        key = (hash((number, form)) if form else number, asked)
        if key not in self._shapes:
            name = f'object "{b_object.name}"'
            shape = self._new_shape(name, b_object, asked, system)
            self._shapes.add(key, shape, name)
        b_parent = b_instance.parent if b_instance.is_instance else None
        objects = [uid(b_object), *([uid(b_parent)] if b_parent is not None else [])]
        b_original = b_object.original.data
        return self._shapes.index(key, objects, [uid(b_original)] if b_original is not None else [])

    def _new_shape(
        self, name: str, b_object: Any, asked: frozenset[MeshData], system: hair.System | None
    ) -> Geometry | None:
        """A new shape, called by the name of its first object."""
        b_data = b_object.data
        try:
            if system is not None or b_object.type == "CURVES":
                return self._new_curves(b_object, asked, system)
            if b_object.type == "POINTCLOUD":
                return points.convert(b_data, asked)
            shape = mesh.convert_object(b_object, b_data, asked)
        except basicrt.SceneError as error:
            raise ExportError(f"{name}: {error}") from error
        if shape is not None and attributes.lacks_tangents(b_data, asked):
            self._warn(b_object, "has no UV map for the tangents that its material asks for")
        return shape

    def _new_curves(
        self, b_object: Any, asked: frozenset[MeshData], system: hair.System | None
    ) -> basicrt.Curves | None:
        """Hair, and what of it isn't drawn as Blender has it."""
        form = hair.form(self._b_scene)
        if hair.is_linear(self._b_scene):
            self._warn(b_object, "Linear 3D Curves are drawn as smooth ones")
        if system is not None:
            if hair.asks_for_more(asked):
                self._warn(b_object, "its hair has no attributes but its roots' UV map")
            return hair.convert_system(b_object, system.index, form, self._is_render)
        if not hair.is_all_catmull_rom(b_object.data):
            self._warn(b_object, "its curves are drawn as Catmull-Rom curves through their points")
        return hair.convert(b_object.data, form, asked)

    def _materials_of(self, b_object: bpy.types.Object, b_mesh: bpy.types.Mesh) -> list[int | None]:
        """The material of each slot; Blender's default where a slot has none."""
        key = (uid(b_object), mesh.key(b_mesh))
        if key not in self._slots:
            override = self._b_view_layer.material_override
            materials = [override] if override else material.slots(b_object, b_mesh)
            self._slots[key] = [self._material(b_material) for b_material in materials]
            data = self._textures.mesh_data
            numbers = [uid(one) for one in materials if one is not None]
            self._asked[key] = frozenset().union(*(data.get(number, ()) for number in numbers))
            of_objects = self._textures.object_data
            self._asked_of_objects[key] = frozenset().union(
                *(of_objects.get(number, ()) for number in numbers)
            )
        return self._slots[key]

    def _material(self, b_material: bpy.types.Material | None) -> int | None:
        """The index of a material, None for none."""
        if b_material is None:
            return None
        key = uid(b_material)
        if key not in self._materials:
            converted = material.convert(b_material, self._report, self._textures)
            self._names["materials"].append(f'material "{b_material.name}"')
            self._materials[key] = self._scene.materials.append(converted)
        return self._materials[key]

    def _asset_name(self, b_instance: Any, b_object: bpy.types.Object) -> str:
        """What an object is part of: its topmost parent, or that of what instances it."""
        b_asset: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        while b_asset.parent is not None:
            b_asset = b_asset.parent
        return str(b_asset.name)

    def _is_holdout(self, b_instance: Any, b_object: bpy.types.Object) -> bool:
        """Whether it is a hole in the picture: itself, what instances it, or a collection of it."""
        b_root: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        in_collection = b_root.original.holdout_get(view_layer=self._b_original_layer)
        return bool(b_object.is_holdout or b_root.is_holdout or in_collection)

    def _is_shadow_catcher(self, b_instance: Any, b_object: bpy.types.Object) -> bool:
        """Whether only shadows on it are seen: itself or what instances it says so."""
        b_root: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        return bool(b_object.is_shadow_catcher or b_root.is_shadow_catcher)

    def _visibility_of(self, b_instance: Any, b_object: bpy.types.Object) -> int:
        """Which rays see an instance: those that may see both the object and what instances it."""
        b_parent = b_instance.parent if b_instance.is_instance else None
        key = (uid(b_object), uid(b_parent) if b_parent else 0)
        if key not in self._visibility:
            kinds = visibility.object_visibility(b_object)
            if b_parent is not None:
                kinds &= visibility.object_visibility(b_parent)
            b_root: Any = b_parent or b_object
            if b_root.original.indirect_only_get(view_layer=self._b_original_layer):
                kinds &= ~basicrt.RayKind.CAMERA
            self._visibility[key] = int(kinds)
        return self._visibility[key]
