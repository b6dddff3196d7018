# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendering of one view layer: tiles are handed out until done or cancelled, and denoised in the end."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import bpy

import basicrt

from ..export import denoising
from ..export.denoising import Denoising
from ..export.settings import pass_names
from ..properties import settings_of
from ..report import ExportError, Report, log, refuse_warnings, show_warnings, summary
from ..sync.scene_sync import Export
from .command_line import Overrides
from .denoise import LayerDenoiser, can_denoise, warn_noisy
from .machine import thread_count
from .result import ResultWriter, complete_without_pixels
from .starting import CancelledError, building_watch, start_session
from .status import show_status

# How often Blender is told of progress, and asked whether to stop.
STATUS_SECONDS = 0.5
POLL_SECONDS = 0.05


def check_warnings(b_scene: Any, overrides: Overrides, report: Report) -> None:
    """Raises ExportError where there are some and the user wants none."""
    if overrides.fails_on_warnings or settings_of(b_scene).fail_on_warnings:
        refuse_warnings(report)


class LayerRender:
    """Of one view layer, whose scene was exported."""

    def __init__(
        self,
        engine: bpy.types.RenderEngine,
        depsgraph: Any,
        overrides: Overrides,
        report: Report,
        is_cancelled: Callable[[], bool],
    ) -> None:
        self._engine: Any = engine
        self._b_scene = depsgraph.scene
        self._b_layer = depsgraph.view_layer
        self._overrides = overrides
        self._report = report
        self._is_cancelled = is_cancelled
        self._threads = thread_count(self._b_scene, overrides)  # 0 is one for each processor

    def trace(self, exported: Export) -> None:
        """Pull tiles until there are no more or the user cancels."""
        options = self._denoising()  # first: it may add a warning
        try:
            started = self._start_session(exported)
        except CancelledError:
            complete_without_pixels(self._engine)
            return
        self._stamp_mattes(exported)
        with started as session:
            names = pass_names(self._b_layer)
            writer = ResultWriter(self._engine, self._b_layer.name, session.rect, names)
            passes = list(exported.scene.settings.passes)
            denoiser = LayerDenoiser(options, passes, session.rect) if options else None
            next_status = 0.0
            for tile in session.tiles(poll_seconds=POLL_SECONDS):
                if tile is not None:
                    writer.write(tile)
                    if denoiser is not None:
                        denoiser.add(tile)
                if self._is_cancelled():
                    session.stop()
                    break
                if time.monotonic() >= next_status:
                    next_status = time.monotonic() + STATUS_SECONDS
                    show_status(self._engine, session.progress)
            if not session.is_stopped:
                show_status(self._engine, session.progress)
                self._log_progress(session.progress)
                if denoiser is not None:
                    self._denoise(denoiser, writer)
        writer.finish()

    def _denoising(self) -> Denoising | None:
        """How the view layer is denoised, if it is to be and can be."""
        options = denoising.convert(self._b_scene, self._b_layer)
        if options is None or not can_denoise(self._b_scene, self._report):
            return None
        return options

    def _denoise(self, denoiser: LayerDenoiser, writer: ResultWriter) -> None:
        """Put the denoised picture in the noisy one's place; it stays where the denoiser fails."""
        self._engine.update_stats("", "Denoising")
        try:
            writer.write_whole(denoiser.finish(self._threads))
        except basicrt.DenoiserError as error:
            warn_noisy(self._b_scene, error, self._report)
            show_warnings(self._report)
            self._engine.report({"WARNING"}, summary(self._report))

    def _stamp_mattes(self, exported: Export) -> None:
        """Into the picture's metadata: which names the ids of mattes stand for."""
        entries = exported.scene.matte_metadata(f"{self._b_layer.name}.")
        if not entries:
            return
        result: Any = self._engine.get_result()
        for key, value in entries.items():
            result.stamp_data_add_field(key, value)

    def _start_session(self, exported: Export) -> basicrt.Session:
        """Build the trees and start the threads; then tell of all that is not as in Blender."""
        self._engine.update_stats("", "Building trees")
        session = start_session(
            exported,
            self._report,
            self._overrides,
            lambda: basicrt.Session(
                exported.scene,
                threads=self._threads,
                tile_size=settings_of(self._b_scene).tile_size,
                preparing=building_watch(self._engine, self._is_cancelled),
            ),
        )
        if self._report.warnings:
            try:
                check_warnings(self._b_scene, self._overrides, self._report)
            except ExportError:
                session.stop()
                raise
            self._engine.report({"WARNING"}, summary(self._report))
        return session

    def _log_progress(self, progress: basicrt.Progress) -> None:
        """What the view layer took."""
        log.info(
            'view layer "%s": %.2f s, %.2f M samples/s, threads: %d, %s',
            self._b_layer.name,
            progress.elapsed_seconds,
            progress.samples_per_second / 1e6,
            self._threads or basicrt.processor_count(),
            basicrt.chosen_kernel(),
        )
