# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Bake: what leaves an object goes into images or into colours of its vertices."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

import basicrt
from basicrt.rendering import PictureBuffer

from ..export import baking, camera
from ..export.identity import uid
from ..report import ExportError, Report
from ..sync.scene_sync import SceneSync
from .command_line import Overrides
from .machine import thread_count
from .starting import CancelledError, building_watch, start_session

POLL_SECONDS = 0.05


class ObjectBake:
    """Bakes one object, for Blender's images one after another."""

    def __init__(
        self,
        engine: bpy.types.RenderEngine,
        depsgraph: bpy.types.Depsgraph,
        overrides: Overrides,
        report: Report,
        is_cancelled: Callable[[], bool],
    ) -> None:
        """Everything stands still, and a camera is not needed. Raises ExportError."""
        self._engine = engine
        self._report = report
        self._is_cancelled = is_cancelled
        b_scene: Any = depsgraph.scene
        b_evaluated: Any = depsgraph.scene_eval
        b_camera = b_scene.camera.evaluated_get(depsgraph) if b_scene.camera else None
        view = (
            camera.convert(b_camera, b_evaluated.render, report)
            if b_camera is not None
            else basicrt.OrthographicCamera()
        )
        self._sync = SceneSync(report)
        self._sync.update(depsgraph, view)
        overrides.apply(self._sync.exported.scene.settings, b_scene)
        self._overrides = overrides
        self._threads = thread_count(b_scene, overrides)
        self._images = 0

    def bake_image(
        self, b_object: bpy.types.Object, plan: basicrt.BakePlan, width: int, height: int
    ) -> None:
        """The pixels of one image. Raises ExportError; leaves them as they are where the user cancels."""
        instance = self._sync.index_of(uid(b_object))
        if instance is None:
            raise ExportError(f"object \"{b_object.name}\" can't be baked: renders don't show it")
        # Blender tells its images apart by the names of these layers, and crashes where there is none.
        self._images += 1
        layer = f"bake_{self._images}"
        result: Any = self._engine.begin_result(0, 0, width, height, layer=layer)
        b_layer = result.layers[0]
        picture = None
        try:
            target = baking.convert_target(b_layer, width, height, instance)
            picture = self._bake(target, plan)
            if picture is not None:
                baking.write_picture(b_layer, picture)
        finally:
            self._engine.end_result(result, cancel=picture is None)

    def _bake(self, target: basicrt.BakeTarget, plan: basicrt.BakePlan) -> Any:
        """The picture, None where the user cancels."""
        buffer = PictureBuffer(plan.settings.passes, target.width, target.height)
        try:
            started = start_session(
                self._sync.exported,
                self._report,
                self._overrides,
                lambda: basicrt.bake_session(
                    self._sync.exported.scene,
                    target,
                    plan,
                    threads=self._threads,
                    preparing=building_watch(self._engine, self._is_cancelled),
                ),
            )
        except CancelledError:
            return None
        with started as session:
            for tile in session.tiles(poll_seconds=POLL_SECONDS):
                if tile is not None:
                    buffer.add(tile)
                if self._is_cancelled():
                    return None
                self._engine.update_progress(session.progress.fraction)
        return plan.picture(buffer.pictures)
