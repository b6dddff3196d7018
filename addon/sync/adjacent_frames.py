# SPDX-License-Identifier: GPL-3.0-or-later
"""Where everything is one frame before and one frame after, for the pass Vector."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

import basicrt

from ..export import camera, mesh
from ..export.motion import Doubles, Shutter
from ..report import Report
from .motion import Movement, MovingInstance, MovingShape

# The numbers of the moments.
_BEFORE, _NOW, _AFTER = range(3)


if TYPE_CHECKING:
    _Movement = Movement[camera.Camera]
else:  # typing would keep the class for ever, as motion.py says
    _Movement = Movement


class AdjacentFrames(_Movement):
    """Follows the scene from the frame before to the frame after, and blurs nothing.

    As in Cycles no object's settings of motion blur count, and what isn't there in one of the frames stands still
    up to it or from it on.
    """

    round_shapes_warning = "the pass Vector doesn't show how hair and points deform"

    def __init__(self, scene: basicrt.Scene, frame: float, report: Report) -> None:
        super().__init__(scene, Shutter(frame - 1, frame + 1), report)

    def _intervals(self, b_object: bpy.types.Object, b_parent: bpy.types.Object | None) -> int:
        return 2

    def _is_deforming(
        self,
        b_object: bpy.types.Object,
        b_parent: bpy.types.Object | None,
        b_scene: bpy.types.Scene,
    ) -> bool:
        return bool(b_object.is_deform_modified(b_scene, "RENDER"))

    def _view(
        self, b_camera: bpy.types.Object, b_render: bpy.types.RenderSettings
    ) -> camera.Camera:
        return camera.convert(b_camera, b_render, Report())  # its warnings are told already

    def _move_camera(self, views: list[camera.Camera], item: str) -> None:
        self._scene.adjacent_cameras = [views[_BEFORE], views[_AFTER]]

    def _move_instance(self, instance: MovingInstance, most: int) -> None:
        now = instance.matrices[_NOW]

        def at(number: int) -> Doubles:
            matrix = instance.matrices.get(number, now)
            return matrix if np.isfinite(matrix).all() else now

        before, after = at(_BEFORE), at(_AFTER)
        if np.array_equal(before, now) and np.array_equal(after, now):
            return
        moved = self._scene.instances[instance.index]
        moved.adjacent_transforms = [before, after]
        self._scene.instances[instance.index] = moved

    def _deform_shape(self, shape: MovingShape, most: int) -> None:
        still = self._scene.shapes[shape.index]
        assert isinstance(still, basicrt.Mesh)

        def at(number: int) -> mesh.Floats:
            moment = shape.moments.get(number)
            return moment.positions if moment is not None else still.positions

        before, after = at(_BEFORE), at(_AFTER)
        if None in shape.moments.values():
            reason = "its mesh becomes another one from frame to frame"
            self._report.warn(
                shape.name, f"{reason}: the pass Vector shows only how the object moves"
            )
        if np.array_equal(before, still.positions) and np.array_equal(after, still.positions):
            return
        self._scene.shapes[shape.index] = mesh.between_frames(still, before, after)
