# SPDX-License-Identifier: GPL-3.0-or-later
"""Placed meshes and lamps: the instances and lights of a native scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

import basicrt

from ..export import hair, light_links
from ..export.identity import uid
from ..nodes import Textures
from ..report import Report
from .changes import Changes
from .lamps import Lamps
from .layer import read_layer
from .models import Models, Placement
from .motion import Key, Movement, hair_key, key_of
from .shown import Filter, Placed


@dataclass(slots=True)
class _Known:
    """An instance of the scene."""

    index: int  # in Scene.instances
    shape: int  # in Scene.shapes
    owners: tuple[int, int]  # the numbers of the object and of what instances it, or 0
    place: int | None  # a hash of all that one of many has of its own; None where that isn't all


@dataclass(slots=True)
class _Seen:
    """An object that is among those placed, by itself or by others."""

    name: str
    systems: list[hair.System] | None = None  # of hair on it, once that was looked for


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
        self._report = report
        self._movement = movement
        self._models = Models(scene, names, report, textures)
        self._shapes = self._models.shapes
        self._lamps = Lamps(scene, names, report, textures)
        self._known: dict[Key, _Known | None] = {}  # None: it is none of ours, or has no faces
        self._seen: dict[int, _Seen] = {}  # by the object's number
        # The numbers of objects that are placed by others, and of those.
        self._instanced: set[int] = set()
        self._links = light_links.LightLinks()
        self._is_forgotten = False

    def begin(self, depsgraph: bpy.types.Depsgraph, changes: Changes) -> None:
        """Forget what has changed."""
        if changes.is_selection:  # Blender says so of each change of a link
            b_scene: Any = depsgraph.scene_eval
            self._links = light_links.read(b_scene, self._report)
        self._layer = read_layer(depsgraph, self._links, self._report)
        may_lack = changes.is_selection and changes.shapes
        present = {uid(b_object) for b_object in depsgraph.objects} if may_lack else None
        self._models.begin(self._layer, changes, present)

    def forget(self) -> None:
        """Convert all of them again in the next scan; shapes and materials stay."""
        self._is_forgotten = True

    def update_materials(self, depsgraph: bpy.types.Depsgraph, changes: Changes) -> bool:
        """Convert again the materials that changed; whether they ask meshes for the same as before."""
        return self._models.materials.update(depsgraph, changes)

    def touch(self, depsgraph: bpy.types.Depsgraph, changes: Changes, shown: Filter) -> bool:
        """Update the objects that changed and nothing else; False where that can't be done."""
        found = []
        for number in changes.objects | self._lamps_with(changes.lights):
            seen = self._seen.get(number)
            b_object: Any = bpy.data.objects.get(seen.name) if seen is not None else None
            if seen is None or b_object is None or b_object.session_uid != number:
                return False
            evaluated = b_object.evaluated_get(depsgraph)
            if seen.systems or len(evaluated.particle_systems) > 0:
                return False
            is_alone = (number, 0, ()) in self._known and number not in self._instanced
            if evaluated.is_instancer or not is_alone:
                return False
            found.append(evaluated)
        for evaluated in found:
            key = (uid(evaluated), 0, ())
            is_shown_lamp = evaluated.type == "LIGHT" and shown.has_lights
            if is_shown_lamp and not self._lamps.touch(key, evaluated, self._layer):
                return False
            known = self._known[key]
            if known is None:
                continue
            placement = self._models.place(Placed(evaluated), known.owners)
            if placement is None:
                return False
            self._scene.instances[known.index] = placement.instance()
            self._shapes.use(placement.model.shape)
            self._shapes.release(known.shape)
            known.shape = placement.model.shape
        self._shapes.sweep()
        return True

    def _lamps_with(self, lights: set[int]) -> set[int]:
        """The numbers of the objects here that have one of these lights."""
        if not lights:
            return set()
        lamps: list[Any] = [each for each in bpy.data.objects if each.type == "LIGHT"]
        return {uid(one) for one in lamps if uid(one.data) in lights} & self._seen.keys()

    def scan(self, depsgraph: bpy.types.Depsgraph, changes: Changes, shown: Filter) -> None:
        """Go over everything, and convert what is new or changed."""
        before, self._known = self._known, {}
        self._seen.clear()
        self._instanced.clear()
        self._lamps.clear()
        kept: list[Placement | None] = []  # None: as it was, at the same place
        moved = len(before) == 0
        for b_instance in depsgraph.object_instances:
            b_object: Any = b_instance.object
            own_key = key_of(b_instance)
            for system in self._parts(b_instance, own_key[0], shown):
                key = own_key if system is None else hair_key(own_key, system.index)
                if b_instance.is_instance:
                    self._instanced.update(key[:2])
                if b_object.type == "LIGHT":
                    self._known[key] = None
                    if shown.has_lights:
                        self._lamps.add(key, b_instance, self._layer)
                    continue
                known = before.get(key)
                if known is not None and self._is_kept(known, b_instance, changes):
                    self._known[key] = _Known(len(kept), known.shape, known.owners, known.place)
                    self._shapes.use(known.shape)
                    moved |= known.index != len(kept)
                    kept.append(None)
                    continue
                self._known[key] = None
                placement = self._models.place(b_instance, key[:2], system)
                if placement is None:
                    continue
                shape = placement.model.shape
                self._shapes.use(shape)
                is_one_of_many = b_instance.is_instance and not placement.model.asked
                place = _place_of(b_instance) if is_one_of_many else None
                self._known[key] = _Known(len(kept), shape, key[:2], place)
                if self._movement is not None:
                    b_scene = self._layer.b_scene
                    self._movement.note(b_instance, b_scene, key, len(kept), shape)
                kept.append(placement)
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

    def _parts(self, b_instance: Any, number: int, shown: Filter) -> list[hair.System | None]:
        """What is shown of a placed object with that number: itself (None), and hair that grows on it."""
        parts: list[hair.System | None] = [None] if shown.shows(b_instance) else []
        has_hair = shown.shows_hair(b_instance)
        if not (parts or has_hair):
            return parts
        seen = self._seen.get(number)
        if seen is None:
            seen = self._seen[number] = _Seen(b_instance.object.original.name)
        if has_hair:
            if seen.systems is None:
                seen.systems = hair.systems(b_instance.object, self._layer.is_render)
            parts += seen.systems
        return parts

    def _replace_instances(
        self, before: dict[Key, _Known | None], kept: list[Placement | None], moved: bool
    ) -> None:
        """Make the table of instances that of the new ones, and of those that stay."""
        table = self._scene.instances
        if not moved and len(kept) == len(table):
            for index, placement in enumerate(kept):
                if placement is not None:
                    table[index] = placement.instance()
            return
        stayed: dict[int, basicrt.Instance] = {}
        for key, known in self._known.items():
            if known is not None and kept[known.index] is None:
                old = before[key]
                assert old is not None
                stayed[known.index] = table[old.index]
        table.clear()
        for index, placement in enumerate(kept):
            table.append(stayed[index] if placement is None else placement.instance())

    def _is_kept(self, known: _Known, b_instance: Any, changes: Changes) -> bool:
        """Whether an instance is what it was. Any object may have to do with where instances of others are."""
        if self._is_forgotten or not changes.objects.isdisjoint(known.owners):
            return False
        if not (changes.objects and b_instance.is_instance):
            return True
        return known.place is not None and known.place == _place_of(b_instance)


def _place_of(b_instance: Any) -> int:
    """A hash of what is an instance's own, if it is one of several."""
    return hash((b_instance.matrix_world.copy().freeze(), b_instance.random_id))
