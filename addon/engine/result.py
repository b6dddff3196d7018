# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiles into Blender's Render Result: the one place that knows its pixel order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

if TYPE_CHECKING:
    import basicrt

# Cycles' name of the picture before it is denoised.
NOISY_PASS = "Noisy Image"


class ResultWriter:
    """Writes one view layer.

    Blender's pixels are float32, row 0 at the bottom like ours; its coordinates count from the
    lower left corner of the render border, ours from the whole picture's.
    """

    def __init__(
        self,
        engine: bpy.types.RenderEngine,
        layer: str,
        rect: tuple[int, int, int, int],
        names: Mapping[str, str],
    ) -> None:
        """`names` are Blender's of the core's passes."""
        self._engine = engine
        self._layer = layer
        self._names = names
        self._left, self._lower = rect[0], rect[1]
        self._is_empty = True

    def write(self, tile: basicrt.Tile) -> None:
        """Show a finished tile."""
        pictures: dict[str, Any] = {name: tile[name] for name in tile.passes}
        if "Combined" in pictures:
            pictures[NOISY_PASS] = pictures["Combined"]
        x, y = tile.x - self._left, tile.y - self._lower
        self._write(x, y, tile.width, tile.height, pictures)

    def write_whole(self, pictures: Mapping[str, Any]) -> None:
        """Show all of every pass, (height, width, channels) float32."""
        height, width, _channels = pictures["Combined"].shape
        self._write(0, 0, width, height, pictures)

    def _write(self, x: int, y: int, width: int, height: int, pictures: Mapping[str, Any]) -> None:
        result: Any = self._engine.begin_result(x, y, width, height, layer=self._layer)
        if result is None:  # outside of what Blender asks for
            return
        for layer in result.layers:
            for name, picture in pictures.items():
                b_pass = layer.passes.get(self._names.get(name, name))
                if b_pass is not None:
                    # Blender cuts off what lies outside of its picture.
                    pixels = picture[: result.resolution_y, : result.resolution_x]
                    b_pass.rect.foreach_set(np.ascontiguousarray(pixels).ravel())
        self._engine.end_result(result)
        self._is_empty = False

    def finish(self) -> None:
        """A render needs one complete result, even a cancelled one."""
        if self._is_empty:
            complete_without_pixels(self._engine)


def complete_without_pixels(engine: bpy.types.RenderEngine) -> None:
    """End a render that has no picture."""
    result = engine.begin_result(0, 0, 1, 1)
    if result is not None:
        engine.end_result(result)
