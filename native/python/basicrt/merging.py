# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of files that have different samples of it."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._native import SceneError, merge_sums, passes
from .images import Picture, write_exr

RANGE_KEY = "basicrt_range"
SUMS_LAYER = "BasicRT sums"
# What else a header says that is the whole picture's.
_KEPT_KEYS = ("software", "samples", "seed")

Sums = npt.NDArray[np.uint32]


@dataclass(frozen=True)
class _Part:
    """What a file says of its samples."""

    path: Path
    first: int
    end: int
    # All that parts of one picture have in common.
    picture: dict[str, Any]
    metadata: dict[str, str]
    sums: Sums  # of the rectangle that is rendered
    size: tuple[int, int]  # height and width of the whole picture


def merge(paths: Sequence[str | os.PathLike[str]], output: str | os.PathLike[str]) -> None:
    """Writes the picture of all samples that the files have together, bit for bit as if rendered at once.

    They come from renders with settings.samples_from and samples_to. Where the first or the last samples of the picture
    are in none of them, the outcome is a file of a range too, and can be merged again. Raises SceneError where they
    are of different pictures, overlap or leave a gap; OSError.
    """
    parts = sorted((_read_part(Path(path)) for path in paths), key=lambda part: part.first)
    _check_parts(parts)
    first, last = parts[0], parts[-1]
    picture = first.picture
    tile = merge_sums(
        [part.sums for part in parts],
        passes=picture["passes"],
        samples=picture["samples"],
        negative_mass=picture["negative_mass"],
        has_shadow_catchers=picture["shadow_catchers"],
    )
    left, lower, width, height = picture["rect"]
    rows, columns = slice(lower, lower + height), slice(left, left + width)
    pictures: dict[str, Picture] = {}
    for info in passes():
        if info.name not in tile.passes:
            continue
        whole = np.full((*first.size, len(info.channels)), info.background, np.float32)
        whole[rows, columns] = tile[info.name]
        pictures[info.name] = whole
    metadata, sums = dict(first.metadata), None
    if (first.first, last.end) != (0, picture["samples"]):
        metadata[RANGE_KEY] = json.dumps({**picture, "from": first.first, "to": last.end})
        assert tile.sums is not None
        sums = np.zeros((*first.size, tile.sums.shape[2]), np.uint32)
        sums[rows, columns] = tile.sums
    write_exr(output, pictures, metadata, sums)


def _read_part(path: Path) -> _Part:
    import OpenEXR

    with path.open("rb"):  # for an OSError that says why
        pass
    try:
        part = OpenEXR.File(str(path), separate_channels=True).parts[0]
        text = part.header.get(RANGE_KEY)
        if text is None:
            raise SceneError(f"{path}: has all samples of its picture, or is not by BasicRT")
        picture = json.loads(text)
        names = sorted(name for name in part.channels if name.startswith(f"{SUMS_LAYER}."))
        sums = np.stack([part.channels[name].pixels[::-1] for name in names], axis=2)
        left, lower, width, height = picture["rect"]
        return _Part(
            path=path,
            first=picture.pop("from"),
            end=picture.pop("to"),
            picture=picture,
            metadata={key: part.header[key] for key in _KEPT_KEYS if key in part.header},
            sums=np.ascontiguousarray(
                sums[lower : lower + height, left : left + width], dtype=np.uint32
            ),
            size=(sums.shape[0], sums.shape[1]),
        )
    except (RuntimeError, ValueError, LookupError, TypeError) as error:
        raise SceneError(f"{path}: can't be read as a range of samples: {error}") from error


def _check_parts(parts: Sequence[_Part]) -> None:
    if not parts:
        raise SceneError("merge: no files are named")
    for part, after in pairwise(parts):
        for key, what in (
            ("version", "by another version of BasicRT"),
            ("scene", "of another scene or other settings"),
        ):
            if after.picture.get(key) != part.picture.get(key):
                raise SceneError(f"{after.path}: is {what} than {part.path}")
        if after.picture != part.picture or after.size != part.size:
            raise SceneError(f"{after.path}: is not of the same picture as {part.path}")
        if after.first < part.end:
            shared = f"samples {after.first} to {min(part.end, after.end)}"
            raise SceneError(f"{after.path}: has {shared}, which {part.path} has too")
        if after.first > part.end:
            raise SceneError(
                f"samples {part.end} to {after.first} are in no file: {part.path} ends before them, "
                f"{after.path} begins behind them"
            )
