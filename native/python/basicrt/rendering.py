# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering a whole picture in one call."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ._native import Progress, Scene, Session, passes


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
    pictures = {
        info.name: np.full(
            (settings.height, settings.width, len(info.channels)), info.background, dtype=np.float32
        )
        for info in passes()
        if info.name in settings.passes
    }
    with Session(scene, threads=threads, tile_size=tile_size) as session:
        for tile in session.tiles():
            if tile is not None:
                rows = slice(tile.y, tile.y + tile.height)
                columns = slice(tile.x, tile.x + tile.width)
                for name in tile.passes:
                    pictures[name][rows, columns] = tile[name]
                part = tile.sums
                if part is not None:
                    if sums is None:
                        shape = (settings.height, settings.width, part.shape[2])
                        sums = np.zeros(shape, np.uint32)
                    sums[rows, columns] = part
            if progress is not None:
                progress(session.progress)
    return pictures, sums
