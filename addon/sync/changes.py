# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender says has changed in a scene, added up until it is read."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy

from ..export.identity import uid


@dataclass
class Changes:
    """Numbers of datablocks, by what has to be done about them."""

    is_everything: bool = False  # nothing is known to be as it was
    is_selection: bool = False  # objects may have come or gone, or are shown no longer
    has_renamed: bool = False
    objects: set[int] = field(default_factory=set)
    shapes: set[int] = field(default_factory=set)  # objects and meshes with another geometry
    materials: set[int] = field(default_factory=set)
    lights: set[int] = field(default_factory=set)  # lamps' data: all that their nodes tell of
    has_world: bool = False

    def note(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Add what the dependency graph has updated."""
        for b_update in depsgraph.updates:
            self._add(b_update, b_update.id)

    def _add(self, b_update: Any, b_id: Any) -> None:
        if isinstance(b_id, bpy.types.Object):
            self.objects.add(uid(b_id))
            if b_update.is_updated_geometry:
                self.shapes.add(uid(b_id))
            flags = ("is_updated_geometry", "is_updated_transform", "is_updated_shading")
            self.has_renamed |= not any(getattr(b_update, flag) for flag in flags)
        elif isinstance(b_id, (bpy.types.Scene, bpy.types.Collection)):
            self.is_selection = True
        elif isinstance(b_id, bpy.types.Material):
            self.materials.add(uid(b_id))
        elif isinstance(b_id, bpy.types.Light):
            self.lights.add(uid(b_id))
        elif isinstance(b_id, bpy.types.World):
            self.has_world = True
        elif isinstance(b_id, _SHAPES):
            if b_update.is_updated_geometry:
                self.shapes.add(uid(b_id))
        elif not isinstance(b_id, _HARMLESS):
            self.is_everything = True


# What tells of its changes through the objects or materials that have it.
_SHAPES = (bpy.types.Mesh, bpy.types.Curve, bpy.types.MetaBall)
_HARMLESS = (
    bpy.types.NodeTree,
    bpy.types.Camera,
    bpy.types.Action,
    bpy.types.Armature,
    bpy.types.Key,
    bpy.types.Lattice,
    bpy.types.ParticleSettings,
)


class _History:
    """How often Blender has put data back to what it was, after which no pointer means what it did."""

    steps = 0


def history() -> int:
    """A number that is another one after each undo, redo or loaded file."""
    return _History.steps


def _count_step(*_args: Any) -> None:
    _History.steps += 1


_persistent: Any = bpy.app.handlers.persistent
_listener: Any = _persistent(_count_step)  # in the next file too


def _handlers() -> tuple[list[Any], ...]:
    handlers: Any = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post, handlers.load_post


def register() -> None:
    """Listen for undo, redo and loaded files."""
    for handler in _handlers():
        handler.append(_listener)


def unregister() -> None:
    """Listen no longer."""
    for handler in _handlers():
        if _listener in handler:
            handler.remove(_listener)
