# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering a whole picture in one call."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import numpy.typing as npt

from ._native import Progress, Scene, Session, Tile, passes


class PictureBuffer:
    """The pictures of some passes of a rectangle, made of its tiles; until they come, of the passes' backgrounds."""

    def __init__(
        self, names: Iterable[str], width: int, height: int, left: int = 0, lower: int = 0
    ) -> None:
        asked = set(names)
        self._left, self._lower = left, lower
        self.pictures: dict[str, npt.NDArray[np.float32]] = {
            info.name: np.full((height, width, len(info.channels)), info.background, np.float32)
            for info in passes()
            if info.name in asked
        }

    def place(self, tile: Tile) -> tuple[slice, slice]:
        """The rows and columns of a tile."""
        x, y = tile.x - self._left, tile.y - self._lower
        return slice(y, y + tile.height), slice(x, x + tile.width)

    def add(self, tile: Tile) -> None:
        """Copy a tile's pixels."""
        for name in tile.passes:
            self.pictures[name][self.place(tile)] = tile[name]


def render(
    scene: Scene,
    *,
    threads: int = 0,
    tile_size: int = 64,
    progress: Callable[[Progress], None] | None = None,
) -> dict[str, npt.NDArray[np.float32]]:
    """The picture of each of scene.settings.passes, (height, width, channels) float32, row 0 at the bottom.

    What the border leaves out is the pass's background. `threads` 0 is one for each processor; the values depend on
    neither `threads` nor `tile_size`. `progress` is called after each tile, and ten times a second between tiles.
    Raises SceneError, MemoryError, and what `progress` raises, which ends the rendering.
    """
    pictures, _ = render_with_sums(scene, threads=threads, tile_size=tile_size, progress=progress)
    return pictures


def render_with_sums(
    scene: Scene,
    *,
    threads: int = 0,
    tile_size: int = 64,
    progress: Callable[[Progress], None] | None = None,
) -> tuple[dict[str, npt.NDArray[np.float32]], npt.NDArray[np.uint32] | None]:
    """What render() returns, and, of a range of the samples, (height, width, words) sums for merging."""
    settings = scene.settings
    sums: npt.NDArray[np.uint32] | None = None
    buffer = PictureBuffer(settings.passes, settings.width, settings.height)
    with Session(scene, threads=threads, tile_size=tile_size) as session:
        for tile in session.tiles():
            if tile is not None:
                buffer.add(tile)
                part = tile.sums
                if part is not None:
                    if sums is None:
                        shape = (settings.height, settings.width, part.shape[2])
                        sums = np.zeros(shape, np.uint32)
                    sums[buffer.place(tile)] = part
            if progress is not None:
                progress(session.progress)
    return buffer.pictures, sums
