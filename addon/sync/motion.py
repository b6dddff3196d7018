# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves while the shutter is open, or from frame to frame: the scene is followed over further frames."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import bpy
import numpy as np

import basicrt

from ..export import camera, mesh, motion
from ..export.identity import uid
from ..export.motion import Doubles, Shutter
from ..report import Report

# Evaluates the scene at a frame and a part of one, as RenderEngine.frame_set does.
FrameSet = Callable[[int, float], None]
# What is kept of the camera at each frame.
View = TypeVar("View")
# What tells placed objects apart at all frames.
Key = tuple[int, int, tuple[int, ...]]


def set_frame(frame_set: FrameSet, frame: float) -> None:
    """Evaluate the scene at any frame."""
    whole = math.floor(frame)
    frame_set(whole, frame - whole)


def key_of(b_instance: bpy.types.DepsgraphObjectInstance) -> Key:
    """Of a placed object."""
    b_object: Any = b_instance.object
    if not b_instance.is_instance:
        return uid(b_object), 0, ()
    b_parent: Any = b_instance.parent
    return uid(b_object), uid(b_parent), tuple(b_instance.persistent_id)


def hair_key(own: Key, system: int) -> Key:
    """Of the hair of a particle system of the placed object that has a key. Blender's own numbers are not negative."""
    number, parent, place = own
    return number, parent, (*place, -1 - system)


@dataclass
class MovingInstance:
    """An instance of the scene that may move."""

    index: int  # in Scene.instances
    name: str
    intervals: int
    matrices: dict[int, Doubles] = field(default_factory=dict)  # by the number of the key


@dataclass
class MovingShape:
    """A shape of the scene that may deform."""

    index: int  # in Scene.shapes
    name: str
    intervals: int
    topology: mesh.Topology
    moments: dict[int, mesh.Moment | None] = field(default_factory=dict)


class Movement(ABC, Generic[View]):
    """Follows objects, their meshes and the camera over some time.

    First everything is exported half-way and noted here; then follow() evaluates the other frames.
    Moments have numbers from 0 to `most`, and what has fewer intervals than that is at every second one, or
    every fourth, and so on.
    """

    # What to say of hair and points, which are not followed.
    round_shapes_warning: str

    def __init__(self, scene: basicrt.Scene, shutter: Shutter, report: Report) -> None:
        self.shutter = shutter
        self._scene = scene
        self._report = report
        self._instances: dict[Key, MovingInstance] = {}
        self._shapes: dict[Key, MovingShape] = {}  # by one object that shows it
        self._known_shapes: set[int] = set()
        self._hair: dict[Key, list[Key]] = {}  # what grows on an object, and moves with it

    def note(
        self,
        b_instance: bpy.types.DepsgraphObjectInstance,
        b_scene: Any,
        key: Key,
        instance: int,
        shape: int,
    ) -> None:
        """Remember an object, or hair on it, that was exported as that instance of that shape."""
        b_object: Any = b_instance.object
        b_parent = b_instance.parent if b_instance.is_instance else None
        intervals = self._intervals(b_object, b_parent)
        if intervals == 0:
            return
        own_key, name = key_of(b_instance), f'object "{b_object.name}"'
        self._instances[key] = MovingInstance(instance, name, intervals)
        if key != own_key:
            self._hair.setdefault(own_key, []).append(key)
        if key != own_key or b_object.type != "MESH":
            if self._is_deforming(b_object, b_parent, b_scene):
                self._report.warn(name, self.round_shapes_warning)
            return
        is_new = shape not in self._known_shapes and not b_object.data.is_editmode
        if is_new and self._is_deforming(b_object, b_parent, b_scene):
            self._known_shapes.add(shape)
            self._shapes[key] = MovingShape(shape, name, intervals, mesh.topology(b_object.data))

    def follow(
        self, depsgraph: bpy.types.Depsgraph, b_camera: bpy.types.Object, frame_set: FrameSet
    ) -> None:
        """Give the scene its motion. Leaves the dependency graph at the last frame."""
        b_original: Any = b_camera.original
        camera_intervals = self._intervals(b_original, None)
        most = max([camera_intervals, *(one.intervals for one in self._instances.values())])
        if most == 0:
            return
        views: dict[int, View] = {}
        # Half-way is where the scene is already.
        for number in [most // 2, *(i for i in range(most + 1) if i != most // 2)]:
            if number != most // 2:
                set_frame(frame_set, self.shutter.frame(number / most))
            b_scene: Any = depsgraph.scene_eval
            views[number] = self._view(b_original.evaluated_get(depsgraph), b_scene.render)
            self._take(depsgraph, number, most)
        if camera_intervals > 0:
            chosen = [views[number] for number in range(0, most + 1, most // camera_intervals)]
            self._move_camera(chosen, f'camera "{b_original.name}"')
        for instance in self._instances.values():
            self._move_instance(instance, most)
        for shape in self._shapes.values():
            self._deform_shape(shape, most)

    def _take(self, depsgraph: bpy.types.Depsgraph, number: int, most: int) -> None:
        """Note where everything is at the key of that number among 0 to `most`."""
        for b_instance in depsgraph.object_instances:
            b_object: Any = b_instance.object
            key = key_of(b_instance)
            keys = [*self._hair.get(key, ()), *([key] if b_instance.show_self else ())]
            for one in keys:
                instance = self._instances.get(one)
                if instance is not None and number % (most // instance.intervals) == 0:
                    instance.matrices[number] = np.array(b_instance.matrix_world, np.float64)
            shape = self._shapes.get(key) if b_instance.show_self else None
            if shape is not None and number % (most // shape.intervals) == 0:
                shape.moments[number] = mesh.moment(b_object.data, shape.topology)

    @abstractmethod
    def _intervals(self, b_object: bpy.types.Object, b_parent: bpy.types.Object | None) -> int:
        """A power of two, between an object's or the camera's first moment and its last; 0 where it isn't followed."""

    @abstractmethod
    def _is_deforming(
        self, b_object: bpy.types.Object, b_parent: bpy.types.Object | None, b_scene: Any
    ) -> bool:
        """Whether an object's mesh may be another at another time, and is to be followed."""

    @abstractmethod
    def _view(self, b_camera: bpy.types.Object, b_render: bpy.types.RenderSettings) -> View:
        """What is kept of the evaluated camera."""

    @abstractmethod
    def _move_camera(self, views: list[View], item: str) -> None:
        """Give the scene's camera its motion; `item` is its name."""

    @abstractmethod
    def _move_instance(self, instance: MovingInstance, most: int) -> None:
        """Give an instance its motion."""

    @abstractmethod
    def _deform_shape(self, shape: MovingShape, most: int) -> None:
        """Give a shape its motion."""


if TYPE_CHECKING:
    _Movement = Movement[tuple[Doubles, camera.Window]]
else:
    # What is subscripted while running typing keeps for ever, and Blender's module with it: as a Python module
    # Blender 4.2 crashes and 4.5 hangs at exit then.
    _Movement = Movement


class MotionExport(_Movement):
    """What moves while the shutter is open, which blurs it."""

    round_shapes_warning = "hair and points don't deform while the shutter is open"

    def _intervals(self, b_object: bpy.types.Object, b_parent: bpy.types.Object | None) -> int:
        return motion.intervals(b_object, b_parent)

    def _is_deforming(
        self, b_object: bpy.types.Object, b_parent: bpy.types.Object | None, b_scene: Any
    ) -> bool:
        return motion.is_deforming(b_object, b_parent, b_scene)

    def _view(
        self, b_camera: bpy.types.Object, b_render: bpy.types.RenderSettings
    ) -> tuple[Doubles, camera.Window]:
        b_data = b_camera.data
        assert isinstance(b_data, bpy.types.Camera)
        return camera.transform(b_camera), camera.window(b_data, b_render)

    def _move_camera(self, views: list[tuple[Doubles, camera.Window]], item: str) -> None:
        if any(window != views[0][1] for _transform, window in views):
            self._report.warn(item, "changes of its lens are not blurred")
        keys = _keys_of([transform for transform, _window in views])
        if keys is not None:
            moved = self._scene.camera
            assert moved is not None
            moved.transform, moved.motion_transforms = keys[0], list(keys[1:])
            self._scene.camera = moved

    def _move_instance(self, instance: MovingInstance, most: int) -> None:
        numbers = range(0, most + 1, most // instance.intervals)
        if any(number not in instance.matrices for number in numbers):
            self._warn(instance.name, "appears or disappears while the shutter is open")
            return
        keys = _keys_of([instance.matrices[number] for number in numbers])
        if keys is None:
            return
        if not all(np.isfinite(key).all() and np.linalg.det(key[:3, :3]) != 0 for key in keys):
            self._warn(instance.name, "is scaled to nothing while the shutter is open")
            return
        moved = self._scene.instances[instance.index]
        moved.transform, moved.motion_transforms = keys[0], list(keys[1:])
        self._scene.instances[instance.index] = moved

    def _deform_shape(self, shape: MovingShape, most: int) -> None:
        numbers = range(0, most + 1, most // shape.intervals)
        moments = [shape.moments.get(number) for number in numbers]
        present = [moment for moment in moments if moment is not None]
        if len(present) == len(moments) and _are_equal(present):
            return
        still = self._scene.shapes[shape.index]
        assert isinstance(still, basicrt.Mesh)
        moved = mesh.deforming(still, present) if len(present) == len(moments) else None
        if moved is None:
            self._warn(shape.name, "its mesh becomes another one while the shutter is open")
        else:
            self._scene.shapes[shape.index] = moved

    def _warn(self, item: str, reason: str) -> None:
        self._report.warn(item, f"{reason}: it stands still")


def _keys_of(matrices: list[Doubles]) -> Doubles | None:
    """The keys of what goes through these transforms, None where it doesn't move."""
    if all(np.array_equal(matrix, matrices[0]) for matrix in matrices):
        return None
    if not all(np.isfinite(matrix).all() for matrix in matrices):
        return np.array(matrices)
    return motion.object_keys(matrices)


def _are_equal(moments: list[mesh.Moment]) -> bool:
    return all(np.array_equal(moment.positions, moments[0].positions) for moment in moments)
