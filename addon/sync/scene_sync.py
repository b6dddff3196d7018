# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole evaluated scene: the dependency graph's instances become shapes, instances and lights."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

import basicrt

from .. import compat
from ..export import (
    attributes,
    camera,
    light,
    light_groups,
    material,
    mesh,
    motion,
    settings,
    visibility,
    world,
)
from ..export.identity import random_number, uid
from ..nodes import MeshData, Textures
from ..report import ExportError, Report
from .motion import FrameSet, MotionExport, set_frame

# Kinds of objects that Blender would draw and BasicRT doesn't. (Curves, text and the like come as
# meshes too.)
_UNSUPPORTED = {
    "CURVES": "hair curves",
    "POINTCLOUD": "point clouds",
    "VOLUME": "volumes",
}


@dataclass
class Export:
    """A scene, and what its user calls the things in it."""

    scene: basicrt.Scene = field(default_factory=basicrt.Scene)
    # For each of the core's tables, what each entry is called.
    names: dict[str, list[str]] = field(default_factory=lambda: {"shapes": [], "materials": []})

    def in_users_words(self, message: str) -> str:
        """A message of the core with names instead of `shapes[3]` or `materials[1]`."""
        tables = "|".join(self.names)
        return re.sub(rf"\b({tables})\[(\d+)\]", lambda m: self.names[m[1]][int(m[2])], message)


def export(
    depsgraph: bpy.types.Depsgraph,
    b_camera: bpy.types.Object | None,
    report: Report,
    frame_set: FrameSet | None = None,
) -> Export:
    """The scene that a view layer shows to an (evaluated) camera.

    With motion blur it is evaluated at several frames by `frame_set`, and left at the one that it was
    at; without that function everything stands still. Raises ExportError, naming the culprit, where
    nothing can be rendered.
    """
    b_scene: Any = depsgraph.scene
    b_view_layer: Any = depsgraph.view_layer
    if b_camera is None:
        raise ExportError(f'scene "{b_scene.name}" has no camera: choose one in Scene > Camera')
    shutter = motion.shutter(b_scene, b_view_layer)
    exported = Export()
    if shutter is None or frame_set is None:
        _fill(exported, depsgraph, b_camera, report, None)
        return exported
    frame = b_scene.frame_current_final
    b_original: Any = b_camera.original
    movement = MotionExport(exported.scene, shutter, report)
    try:
        if shutter.center != frame:
            set_frame(frame_set, shutter.center)
        _fill(exported, depsgraph, b_original.evaluated_get(depsgraph), report, movement)
        movement.follow(depsgraph, b_original, frame_set)
    finally:
        set_frame(frame_set, frame)
    return exported


def _fill(
    exported: Export,
    depsgraph: bpy.types.Depsgraph,
    b_camera: bpy.types.Object,
    report: Report,
    movement: MotionExport | None,
) -> None:
    """The scene as it is evaluated now; what may move is noted in `movement`."""
    b_scene: Any = depsgraph.scene_eval
    b_view_layer: Any = depsgraph.view_layer_eval
    scene = exported.scene
    settings.convert(b_scene, b_view_layer, scene.settings, report)
    scene.camera = camera.convert(b_camera, b_scene.render, report)
    textures = Textures(scene)
    b_world = compat.view_layer_world(b_scene, b_view_layer)
    groups = light_groups.numbers(b_view_layer, report)
    environment = world.convert(b_world, report, textures)
    environment.light_group = light_groups.number_of(b_world, groups)
    scene.environment = environment
    _fill_space(exported, b_world, report, textures)
    _InstanceExport(exported, depsgraph, report, textures, movement, groups).run()


def _fill_space(
    exported: Export, b_world: bpy.types.World | None, report: Report, textures: Textures
) -> None:
    """The volume of the world, if it has one."""
    volume = world.convert_volume(b_world, report, textures)
    if b_world is not None and volume is not None:
        exported.names["materials"].append(f'world "{b_world.name}"')
        exported.scene.world_volume = exported.scene.materials.append(volume)


class _InstanceExport:
    """Goes over the dependency graph once; what several instances share is converted once."""

    def __init__(
        self,
        exported: Export,
        depsgraph: bpy.types.Depsgraph,
        report: Report,
        textures: Textures,
        movement: MotionExport | None,
        groups: dict[str, int],
    ) -> None:
        self._groups = groups  # of lights
        self._scene = exported.scene
        self._names = exported.names
        self._depsgraph = depsgraph
        self._report = report
        self._textures = textures
        self._movement = movement
        # By a mesh's key and what its materials ask for.
        self._shapes: dict[tuple[int, frozenset[MeshData]], int | None] = {}
        self._materials: dict[int, int] = {}
        # By the numbers of an object and of what instances it, and by the mesh's key.
        self._slots: dict[tuple[int, int], list[int | None]] = {}
        self._asked: dict[tuple[int, int], frozenset[MeshData]] = {}
        self._visibility: dict[tuple[int, int], int] = {}

    def run(self) -> None:
        """Export everything."""
        for b_instance in self._depsgraph.object_instances:
            if not b_instance.show_self:
                continue
            b_object: Any = b_instance.object
            if b_object.type == "MESH":
                self._add_mesh(b_instance, b_object)
            elif b_object.type == "LIGHT":
                converted = light.convert(b_object, b_instance.matrix_world, self._report)
                if converted is not None:
                    converted.light_group = light_groups.number_of(b_object, self._groups)
                    self._scene.lights.append(converted)
            elif b_object.type in _UNSUPPORTED:
                self._warn(b_object, f"{_UNSUPPORTED[b_object.type]} are not supported: left out")

    def _warn(self, b_object: bpy.types.Object, message: str) -> None:
        self._report.warn(f'object "{b_object.name}"', message)

    def _add_mesh(
        self, b_instance: bpy.types.DepsgraphObjectInstance, b_object: bpy.types.Object
    ) -> None:
        """One placed mesh."""
        b_mesh: Any = b_object.data
        materials = self._materials_of(b_object, b_mesh)
        shape = self._shape_of(b_object, b_mesh)
        if shape is None:
            return
        transform = np.array(b_instance.matrix_world, np.float64)
        if not np.isfinite(transform).all():
            raise ExportError(f'object "{b_object.name}": its transform is not finite')
        if np.linalg.det(transform[:3, :3].astype(np.float32)) == 0.0:
            self._warn(b_object, "scaled to nothing along an axis: left out")
            return
        instance = self._scene.instances.append(
            basicrt.Instance(
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
        )
        if self._movement is not None:
            self._movement.note(b_instance, self._depsgraph.scene_eval, instance, shape)

    def _shape_of(self, b_object: bpy.types.Object, b_mesh: bpy.types.Mesh) -> int | None:
        """The index of a mesh's shape, None where it has no faces."""
        asked = self._asked[uid(b_object), mesh.key(b_mesh)]
        key = (mesh.key(b_mesh), asked)
        if key not in self._shapes:
            self._shapes[key] = self._new_shape(b_object, b_mesh, asked)
        return self._shapes[key]

    def _new_shape(
        self, b_object: bpy.types.Object, b_mesh: bpy.types.Mesh, asked: frozenset[MeshData]
    ) -> int | None:
        """The index of a mesh's new shape, called by the name of its first object."""
        name = f'object "{b_object.name}"'
        try:
            shape = mesh.convert_object(b_object, b_mesh, asked)
        except basicrt.SceneError as error:
            raise ExportError(f"{name}: {error}") from error
        if shape is None:
            return None
        if attributes.lacks_tangents(b_mesh, asked):
            self._warn(b_object, "has no UV map for the tangents that its material asks for")
        self._names["shapes"].append(name)
        return self._scene.shapes.append(shape)

    def _materials_of(self, b_object: bpy.types.Object, b_mesh: bpy.types.Mesh) -> list[int | None]:
        """The material of each slot; Blender's default where a slot has none."""
        key = (uid(b_object), mesh.key(b_mesh))
        if key not in self._slots:
            b_view_layer: Any = self._depsgraph.view_layer_eval
            override = b_view_layer.material_override
            materials = [override] if override else material.slots(b_object, b_mesh)
            self._slots[key] = [self._material(b_material) for b_material in materials]
            data = self._textures.mesh_data
            asked = [data.get(uid(one), ()) for one in materials if one is not None]
            self._asked[key] = frozenset().union(*asked)
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

    def _asset_name(
        self, b_instance: bpy.types.DepsgraphObjectInstance, b_object: bpy.types.Object
    ) -> str:
        """What an object is part of: its topmost parent, or that of what instances it."""
        b_asset: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        while b_asset.parent is not None:
            b_asset = b_asset.parent
        return str(b_asset.name)

    def _is_holdout(
        self, b_instance: bpy.types.DepsgraphObjectInstance, b_object: bpy.types.Object
    ) -> bool:
        """Whether it is a hole in the picture: itself, what instances it, or a collection of it."""
        b_root: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        in_collection = b_root.original.holdout_get(view_layer=self._depsgraph.view_layer)
        return bool(b_object.is_holdout or b_root.is_holdout or in_collection)

    def _is_shadow_catcher(
        self, b_instance: bpy.types.DepsgraphObjectInstance, b_object: bpy.types.Object
    ) -> bool:
        """Whether only shadows on it are seen: itself or what instances it says so."""
        b_root: Any = (b_instance.parent if b_instance.is_instance else None) or b_object
        return bool(b_object.is_shadow_catcher or b_root.is_shadow_catcher)

    def _visibility_of(
        self, b_instance: bpy.types.DepsgraphObjectInstance, b_object: bpy.types.Object
    ) -> int:
        """Which rays see an instance: those that may see both the object and what instances it."""
        b_parent = b_instance.parent if b_instance.is_instance else None
        key = (uid(b_object), uid(b_parent) if b_parent else 0)
        if key not in self._visibility:
            kinds = visibility.object_visibility(b_object)
            if b_parent is not None:
                kinds &= visibility.object_visibility(b_parent)
            b_root: Any = b_parent or b_object
            if b_root.original.indirect_only_get(view_layer=self._depsgraph.view_layer):
                kinds &= ~basicrt.RayKind.CAMERA
            self._visibility[key] = int(kinds)
        return self._visibility[key]
