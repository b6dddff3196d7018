# SPDX-License-Identifier: GPL-3.0-or-later
"""The shutter, and what objects are told of motion blur."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

Doubles = NDArray[np.float64]

# Numbers that a shutter curve is read into.
_CURVE_SIZE = 256
# Steps as Cycles has them: 2^steps intervals of the shutter's time.
_MOST_STEPS = 7
# Matrices are linear between keys: what turns by more than this (radians) gets keys between, and is
# within 1 - cos(angle / 2) of its size.
_LARGEST_TURN = math.radians(3)
_MOST_KEYS = 257


@dataclass(frozen=True)
class Shutter:
    """When the shutter opens and closes, in frames."""

    opens: float
    closes: float

    @property
    def center(self) -> float:
        """Half-way, where everything that doesn't move is taken from."""
        return 0.5 * (self.opens + self.closes)

    def frame(self, time: float) -> float:
        """The frame at a time from 0 (open) to 1 (closed)."""
        return self.opens + time * (self.closes - self.opens)


def shutter(b_scene: bpy.types.Scene, b_view_layer: bpy.types.ViewLayer) -> Shutter | None:
    """The shutter around the scene's frame, None where motion blur is off."""
    b_render: Any = b_scene.render
    layer: Any = b_view_layer
    duration = b_render.motion_blur_shutter
    if not b_render.use_motion_blur or not layer.use_motion_blur or duration <= 0:
        return None
    frame = b_scene.frame_current_final
    before = {"START": 0.0, "CENTER": 0.5, "END": 1.0}[b_render.motion_blur_position]
    return Shutter(frame - before * duration, frame + (1 - before) * duration)


def shutter_curve(b_render: bpy.types.RenderSettings) -> list[float]:
    """How far the shutter is open at equally spaced times; empty where that never changes."""
    settings: Any = b_render
    mapping = settings.motion_blur_shutter_curve
    mapping.initialize()
    curve = mapping.curves[0]
    places = range(_CURVE_SIZE)
    values = [max(mapping.evaluate(curve, i / (_CURVE_SIZE - 1)), 0.0) for i in places]
    return [] if min(values) == max(values) else values


def intervals(b_object: bpy.types.Object, b_parent: bpy.types.Object | None) -> int:
    """Spans of the shutter's time between two keys of an object's motion; 0 where it isn't blurred.

    The settings are Cycles' own; without its add-on everything is blurred, with two intervals. What
    instances the object has a say too.
    """
    settings = [b.cycles for b in _settings_of(b_object, b_parent)]
    if not all(setting.use_motion_blur for setting in settings):
        return 0
    steps = max([int(setting.motion_steps) for setting in settings], default=1)
    return 1 << min(max(steps, 1), _MOST_STEPS)


def is_deforming(
    b_object: bpy.types.Object, b_parent: bpy.types.Object | None, b_scene: bpy.types.Scene
) -> bool:
    """Whether an object's mesh may be another at another time, and that is to be blurred."""
    settings = [b.cycles for b in _settings_of(b_object, b_parent)]
    wanted = all(setting.use_deform_motion for setting in settings)
    return wanted and bool(b_object.is_deform_modified(b_scene, "RENDER"))


def _settings_of(b_object: bpy.types.Object, b_parent: bpy.types.Object | None) -> list[Any]:
    """Those of an object and what instances it that have Cycles' settings."""
    return [b for b in (b_object, b_parent) if b is not None and hasattr(b, "cycles")]


def object_keys(matrices: Sequence[Doubles]) -> Doubles:
    """(N, 4, 4) transforms at equally spaced times from (4, 4) ones, with more where something turns.

    Between two of the given ones the rotation turns evenly, and scale, shear and place are linear:
    each matrix is split into rotation and the rest by its polar decomposition (Shoemake and Duff 1992,
    "Matrix animation and polar decomposition").
    """
    keys = np.array(matrices, np.float64)
    rotations = [_rotation(key[:3, :3]) for key in keys]
    turns = [
        Matrix((a.T @ b).tolist()).to_quaternion().angle for a, b in itertools.pairwise(rotations)
    ]
    wanted = max(math.ceil(turn / _LARGEST_TURN) for turn in turns)
    parts = min(max(wanted, 1), max((_MOST_KEYS - 1) // (len(keys) - 1), 1))
    if parts == 1:
        return keys
    quaternions = [Matrix(rotation.tolist()).to_quaternion() for rotation in rotations]
    stretches = [rotation.T @ key[:3, :3] for rotation, key in zip(rotations, keys, strict=True)]
    result = []
    for i in range(len(keys) - 1):
        result.append(keys[i])
        for part in range(1, parts):
            share = part / parts
            between = keys[i] * (1 - share) + keys[i + 1] * share
            rotation = np.array(quaternions[i].slerp(quaternions[i + 1], share).to_matrix())
            between[:3, :3] = rotation @ (stretches[i] * (1 - share) + stretches[i + 1] * share)
            result.append(between)
    result.append(keys[-1])
    return np.array(result)


def _rotation(linear: Doubles) -> Doubles:
    """The rotation nearest to a 3x3 matrix, but for a reflection."""
    left, _, right = np.linalg.svd(linear)
    rotation: Doubles = left @ right
    return rotation if np.linalg.det(rotation) > 0 else -rotation
