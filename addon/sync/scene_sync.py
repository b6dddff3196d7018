# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole evaluated scene: the dependency graph's instances become shapes, instances and lights."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy

import basicrt

from .. import compat
from ..export import aovs, camera, light_groups, motion, settings, world
from ..export.identity import uid
from ..nodes import Surroundings, Textures
from ..report import ExportError, Report
from .adjacent_frames import AdjacentFrames
from .changes import Changes, history
from .instances import Instances
from .layer import layer_collections
from .motion import FrameSet, MotionExport, Movement, set_frame
from .shown import Filter


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

    With motion blur or the pass Vector it is evaluated at several frames by `frame_set`, and left at the one
    that it was at; without that function everything stands still. Raises ExportError, naming the culprit,
    where nothing can be rendered.
    """
    b_scene: Any = depsgraph.scene
    if b_camera is None:
        raise ExportError(f'scene "{b_scene.name}" has no camera: choose one in Scene > Camera')
    frame = b_scene.frame_current_final
    b_original: Any = b_camera.original
    b_evaluated_scene: Any = depsgraph.scene_eval
    sync = SceneSync(report)
    movement = _movement(depsgraph, sync.exported.scene, report)
    if movement is None or frame_set is None:
        sync.update(depsgraph, camera.convert(b_camera, b_evaluated_scene.render, report))
        return sync.exported
    try:
        if movement.shutter.center != frame:
            set_frame(frame_set, movement.shutter.center)
        b_evaluated = b_original.evaluated_get(depsgraph)
        b_evaluated_scene = depsgraph.scene_eval
        sync.follow(movement)
        sync.update(depsgraph, camera.convert(b_evaluated, b_evaluated_scene.render, report))
        movement.follow(depsgraph, b_original, frame_set)
    finally:
        set_frame(frame_set, frame)
    return sync.exported


def _movement(
    depsgraph: bpy.types.Depsgraph, scene: basicrt.Scene, report: Report
) -> Movement[Any] | None:
    """What follows a view layer's scene over time, where that is asked for: for motion blur, or else for vectors."""
    b_scene: Any = depsgraph.scene
    b_view_layer: Any = depsgraph.view_layer
    shutter = motion.shutter(b_scene, b_view_layer)
    if shutter is None and b_view_layer.use_pass_vector:
        return AdjacentFrames(scene, b_scene.frame_current_final, report)
    if shutter is None:
        return None
    if b_view_layer.use_pass_vector:
        item = f'view layer "{b_view_layer.name}"'
        report.warn(item, "the pass Vector is 0 where there is motion blur")
    return MotionExport(scene, shutter, report)


class SceneSync:
    """A native scene that is kept like an evaluated one, with as little work as its changes allow.

    What is not known to be as it was is exported again, all of it if need be.
    """

    def __init__(self, report: Report) -> None:
        self.exported = Export()
        self._report = report
        self._movement: Movement[Any] | None = None
        self._changes = Changes(is_everything=True)
        self._textures = Textures(self.exported.scene)
        self._instances = Instances(
            self.exported.scene, self.exported.names, report, self._textures
        )
        self._basis: Any = None  # what everything rests on
        self._world: Any = None  # what surrounds the scene
        self._layout: Any = None  # what all instances rest on

    def follow(self, movement: Movement[Any]) -> None:
        """Tell this of all instances that are converted from now on."""
        self._movement = movement

    def note(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Remember what Blender says has changed, for the next update()."""
        self._changes.note(depsgraph)

    def index_of(self, number: int) -> int | None:
        """Where in Scene.instances an object is that is placed by itself, by its number."""
        return self._instances.index_of(number)

    def rescan(self) -> None:
        """Something else may be shown now, for the next update()."""
        self._changes.is_selection = True

    def update(
        self,
        depsgraph: bpy.types.Depsgraph,
        view_camera: camera.Camera,
        shown: Filter | None = None,
        environment: basicrt.Environment | None = None,
    ) -> None:
        """Make the scene what Blender's is now, looked at by a camera.

        An environment is shown instead of the world. Raises ExportError where nothing can be rendered;
        the next update then begins anew.
        """
        changes, self._changes = self._changes, Changes(is_everything=True)
        self._begin(depsgraph, view_camera, changes)
        self._update(depsgraph, changes, shown or Filter(), environment)
        self._changes = Changes()

    def _begin(
        self, depsgraph: bpy.types.Depsgraph, view_camera: camera.Camera, changes: Changes
    ) -> None:
        """Drop what can't be kept."""
        basis = _basis(depsgraph, view_camera)
        changes.is_everything |= basis != self._basis
        changes.is_everything |= not changes.objects.isdisjoint(self._textures.objects)
        surroundings = _surroundings(depsgraph)
        changes.is_everything |= self._textures.would_differ(surroundings)
        layout = tuple(_layout(depsgraph))
        is_old_layout, self._layout = layout == self._layout, layout
        if changes.is_everything:
            scene, names = self.exported.scene, self.exported.names
            for table in (scene.shapes, scene.textures, scene.materials, scene.instances):
                table.clear()
            for entries in names.values():
                entries.clear()
            scene.world_volume = None
            changes.has_world = True
            self._textures = Textures(scene, surroundings)
            b_original_layer: Any = depsgraph.view_layer
            self._textures.aovs = aovs.numbers(b_original_layer, self._report)
            self._instances = Instances(scene, names, self._report, self._textures, self._movement)
        elif changes.has_renamed or not is_old_layout:
            self._instances.forget()
        changes.is_selection |= changes.is_everything or changes.has_renamed or not is_old_layout
        self._basis = basis
        b_scene: Any = depsgraph.scene_eval
        b_view_layer: Any = depsgraph.view_layer_eval
        settings.convert(b_scene, b_view_layer, self.exported.scene.settings, self._report)
        self.exported.scene.camera = view_camera

    def _update(
        self,
        depsgraph: bpy.types.Depsgraph,
        changes: Changes,
        shown: Filter,
        environment: basicrt.Environment | None,
    ) -> None:
        """Convert what has changed."""
        b_scene: Any = depsgraph.scene_eval
        b_view_layer: Any = depsgraph.view_layer_eval
        b_world = compat.view_layer_world(b_scene, b_view_layer)
        group = light_groups.number_of(b_world, light_groups.numbers(b_view_layer))
        chosen = (uid(b_world) if b_world else 0, environment is not None, group)
        if changes.has_world or environment is not None or chosen != self._world:
            self._convert_world(b_world, environment, group)
            self._world = chosen
        self._instances.begin(depsgraph, changes)
        has_same_slots = self._instances.update_materials(depsgraph, changes)
        if not has_same_slots:
            self._instances.forget()
        needs_scan = changes.is_selection or not has_same_slots
        if needs_scan or not self._instances.touch(depsgraph, changes, shown):
            self._instances.scan(depsgraph, changes, shown)

    def _convert_world(
        self, b_world: bpy.types.World | None, environment: basicrt.Environment | None, group: int
    ) -> None:
        """What surrounds the scene, and the volume that fills it if there is one."""
        scene, names = self.exported.scene, self.exported.names["materials"]
        if environment is not None:
            scene.environment, scene.world_volume = environment, None
            return
        converted = world.convert(b_world, self._report, self._textures)
        converted.light_group = group
        scene.environment = converted
        volume = world.convert_volume(b_world, self._report, self._textures)
        index, scene.world_volume = scene.world_volume, None
        if b_world is None or volume is None:
            return
        if index is None:
            index = scene.materials.append(volume)
            names.append("")
        scene.materials[index], names[index] = volume, f'world "{b_world.name}"'
        scene.world_volume = index


def _surroundings(depsgraph: bpy.types.Depsgraph) -> Surroundings:
    b_scene: Any = depsgraph.scene_eval
    owners = (depsgraph.view_layer_eval, b_scene, b_scene.world)
    return Surroundings(b_scene.frame_current, tuple(owner for owner in owners if owner))


def _basis(depsgraph: bpy.types.Depsgraph, view_camera: camera.Camera) -> Any:
    """What can't change without everything changing."""
    b_scene: Any = depsgraph.scene
    b_view_layer: Any = depsgraph.view_layer
    is_flat = isinstance(view_camera, (basicrt.PerspectiveCamera, basicrt.OrthographicCamera))
    written = tuple(aovs.numbers(b_view_layer).items())
    return uid(b_scene), b_view_layer.name, history(), is_flat, written


def _layout(depsgraph: bpy.types.Depsgraph) -> Iterator[Any]:
    """What instances depend on that Blender doesn't tell of object by object."""
    b_view_layer: Any = depsgraph.view_layer
    override = b_view_layer.material_override
    yield uid(override) if override else 0
    yield light_groups.numbers(b_view_layer)
    for b_layer in layer_collections(b_view_layer):
        yield b_layer.name, b_layer.holdout, b_layer.indirect_only
