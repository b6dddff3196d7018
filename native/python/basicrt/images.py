# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in files: OpenEXR with every pass, and PNG to look at.

In memory a picture is (height, width, channels) float32, scene-linear, with its row 0 at the bottom.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._native import SceneError, passes
from .files import replacing

Picture = npt.NDArray[np.float32]


def write_exr(
    path: str | os.PathLike[str],
    pictures: Mapping[str, npt.ArrayLike],
    metadata: Mapping[str, str] | None = None,
    sums: npt.NDArray[np.uint32] | None = None,
) -> None:
    """Writes passes as 32-bit floats, ZIP compressed: Combined as R G B A, others as in Depth.Z or Normal.X.

    `sums` (height, width, words) are those of a range of the samples, as in Tile.sums, for `merge`.

    The file appears whole or not at all. Raises SceneError for pictures of unlike sizes, OSError.
    """
    import OpenEXR

    channels: dict[str, npt.NDArray[Any]] = {}
    for name, values in pictures.items():
        picture = _checked_picture(name, values)
        prefix = "" if name == "Combined" else f"{name}."
        for index, letter in enumerate(_channel_letters(name, picture.shape[2])):
            channels[prefix + letter] = np.ascontiguousarray(picture[::-1, :, index])
    for index in range(0 if sums is None else sums.shape[2]):
        assert sums is not None
        channels[f"BasicRT sums.{index:04}"] = np.ascontiguousarray(sums[::-1, :, index])
    if len({channel.shape for channel in channels.values()}) != 1:
        raise SceneError(f"{path}: needs one or more pictures, all of the same size")

    header = {
        **(metadata or {}),
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
    }
    with replacing(path) as temporary:
        temporary.touch(exist_ok=False)  # for an OSError that says why: OpenEXR's own does not
        OpenEXR.File(header, channels).write(str(temporary))


def read_exr(path: str | os.PathLike[str]) -> dict[str, Picture]:
    """The passes of a file: bare channels R G B A (or Y) are Combined, bare Z is Depth, the rest go by their layer.

    Raises SceneError where the file can't be read.
    """
    import OpenEXR

    with Path(path).open("rb"):  # for an OSError that says why
        pass
    try:
        file = OpenEXR.File(str(path), separate_channels=True)
        layers: dict[str, dict[str, Picture]] = {}
        # OpenEXR leaves out the parts that it can't decode, and says so on standard error only.
        if len(file.parts) < max(len(OpenEXR.File(str(path), header_only=True).parts), 1):
            raise ValueError("it is damaged")
        for part in range(len(file.parts)):
            for full_name, channel in file.channels(part).items():
                layer, letter = _split_channel_name(full_name)
                values = np.asarray(channel.pixels, dtype=np.float32)[::-1]
                layers.setdefault(layer, {})[letter] = values
    except (RuntimeError, ValueError) as error:
        raise SceneError(f"{path}: can't be read as OpenEXR: {error}") from error
    return {
        layer: np.ascontiguousarray(
            np.stack([channels[letter] for letter in sorted(channels, key=_letter_order)], axis=2)
        )
        for layer, channels in layers.items()
    }


def read_combined(path: str | os.PathLike[str]) -> Picture:
    """The pass Combined of a file. Raises SceneError where it has none or can't be read."""
    pictures = read_exr(path)
    if "Combined" not in pictures:
        raise SceneError(f"{Path(path)}: has no channels R, G and B")
    return pictures["Combined"]


def write_png(path: str | os.PathLike[str], combined: npt.ArrayLike) -> None:
    """Writes Combined (premultiplied alpha) as 8-bit sRGB with straight alpha, without any view transform.

    The file appears whole or not at all. Raises SceneError, OSError.
    """
    from PIL import Image

    picture = _checked_picture("Combined", combined)
    if picture.shape[2] not in (3, 4):
        raise SceneError(f"{path}: Combined must have 3 or 4 channels, has {picture.shape[2]}")
    encoded = np.clip(np.nan_to_num(picture, posinf=1), 0, 1)
    color, alpha = encoded[..., :3], encoded[..., 3:]
    if alpha.size:
        # Divide before clipping, or a bright transparent pixel would darken.
        straight = np.divide(picture[..., :3], alpha, out=np.zeros_like(color), where=alpha > 0)
        color = np.clip(np.nan_to_num(straight, posinf=1), 0, 1)
    encoded[..., :3] = linear_to_srgb(color)
    with replacing(path) as temporary:
        image = Image.fromarray(np.round(encoded[::-1] * 255).astype(np.uint8))
        image.save(temporary, format="PNG")


def linear_to_srgb(linear: Picture) -> Picture:
    """The sRGB curve (IEC 61966-2-1) for values in [0, 1]."""
    curve = 1.055 * np.power(np.maximum(linear, 0.0031308), 1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve).astype(np.float32)


def _checked_picture(name: str, values: npt.ArrayLike) -> Picture:
    picture = np.asarray(values, dtype=np.float32)
    if picture.ndim != 3 or picture.size == 0:
        raise SceneError(
            f"{name}: must have the shape (height, width, channels), is {picture.shape}"
        )
    return picture


def _channel_letters(name: str, count: int) -> str:
    known = {info.name: info.channels for info in passes()}
    letters: str = known.get(name, {1: "V", 3: "RGB", 4: "RGBA"}.get(count, ""))
    if name == "Combined" and count == 3:
        letters = "RGB"
    if len(letters) != count:
        raise SceneError(f"{name}: must have {len(letters) or '1, 3 or 4'} channels, has {count}")
    return letters


def _split_channel_name(name: str) -> tuple[str, str]:
    layer, _, letter = name.rpartition(".")
    if layer:
        return layer, letter
    return {**dict.fromkeys("RGBAY", "Combined"), "Z": "Depth"}.get(name, name), name


def _letter_order(letter: str) -> tuple[int, str]:
    order = "UVRGBArgbaXYZ"
    place = order.find(letter)
    return (place if place >= 0 else len(order), letter)
