# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of materials, worlds and lights: small scenes of Blender's, shown at once and refined once."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import bpy

import basicrt

from ..preferences import use_isa
from ..sync.scene_sync import Export
from .command_line import Overrides
from .machine import check_memory, thread_count
from .result import ResultWriter

# Of each pixel: first what is there at once, then what is there to stay.
SAMPLES = (1, 64)
# Of what Blender's icons show nothing more is to be seen.
MOST_BOUNCES = 8
POLL_SECONDS = 0.01


def simplify(settings: basicrt.RenderSettings) -> None:
    """Nothing of a preview is worth more than a moment."""
    settings.passes = ["Combined"]
    settings.adaptive_threshold = settings.time_limit = 0
    settings.max_bounces = min(settings.max_bounces, MOST_BOUNCES)


def render(
    engine: bpy.types.RenderEngine,
    exported: Export,
    layer: str,
    names: Mapping[str, str],
    b_scene: bpy.types.Scene,
    overrides: Overrides,
    is_cancelled: Callable[[], bool],
) -> None:
    """Write the coarse picture and then the fine one, until the user wants another.

    Raises SceneError, and ExportError where there is not enough memory for it.
    """
    threads = thread_count(b_scene, overrides)
    use_isa()
    check_memory(exported.scene.memory(), overrides, is_built=False)
    for samples in SAMPLES:
        if not _render_samples(engine, exported, samples, layer, names, threads, is_cancelled):
            return


def _render_samples(
    engine: Any,
    exported: Export,
    samples: int,
    layer: str,
    names: Mapping[str, str],
    threads: int,
    is_cancelled: Callable[[], bool],
) -> bool:
    """One of the two; false where it was cancelled."""
    exported.scene.settings.samples = samples
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", basicrt.SceneWarning
        )  # those of the scene itself tell of them
        started = basicrt.Session(exported.scene, threads=threads)
    with started as session:
        writer = ResultWriter(engine, layer, session.rect, names)
        for tile in session.tiles(poll_seconds=POLL_SECONDS):
            if tile is not None:
                writer.write(tile)
            if is_cancelled():
                session.stop()
                break
        is_whole = not session.is_stopped
        writer.finish()
    return is_whole
