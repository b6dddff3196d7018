# SPDX-License-Identifier: GPL-3.0-or-later
"""What the colours of images mean: by Blender's own configuration of OpenColorIO, whatever spaces it has."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .. import compat

_LINEAR_SPACES = ("Linear", "Linear Rec.709", "scene_linear", "Raw", "Non-Color")
_SRGB_SPACES = ("sRGB", "sRGB Rec.1886")


def encoding(b_image: bpy.types.Image) -> str | None:
    """How an image's bytes stand for colour; None where they have to be `decoded`."""
    b_colorspace: Any = b_image.colorspace_settings
    if b_colorspace.is_data:
        return "linear"
    if not compat.works_in_rec709():
        return None
    if b_colorspace.name in _LINEAR_SPACES:
        return "linear"
    return "srgb" if b_colorspace.name in _SRGB_SPACES else None


def decoded(
    b_image: bpy.types.Image, encoded: NDArray[np.uint8], *, is_associated: bool
) -> NDArray[np.float32] | None:
    """Scene-linear colours of an image's bytes, (height, width, 1, 3 or 4); None where Blender has no way to them.

    As Cycles has it, colours are converted before they are multiplied by alpha, where they are.
    """
    b_colorspace: Any = b_image.colorspace_settings
    pixels: NDArray[np.float32] = np.divide(encoded, 255, dtype=np.float32)
    colors, alpha = pixels[..., :3], pixels[..., 3:]
    if alpha.size == 0:
        return _scene_linear(colors, b_colorspace.name)
    factor = alpha if is_associated else np.ones_like(alpha)
    if not is_associated and not compat.converts_packed_colors():
        # Of channels that have nothing to do with alpha Cycles thinks that they were multiplied by it.
        factor = alpha
        colors /= np.where(alpha > 0, alpha, 1)
    elif is_associated:
        colors *= alpha > 0
    converted = _scene_linear(colors, b_colorspace.name)
    if converted is None:
        return None
    converted *= np.where(alpha > 0, factor, 1)
    return np.concatenate([converted, alpha], axis=2)


def _scene_linear(colors: NDArray[np.float32], space: str) -> NDArray[np.float32] | None:
    """Blender converts pictures of floats as it reads them: it is given one, packed, to read."""
    height, width, _channels = colors.shape
    b_picture: Any = bpy.data.images.new(
        "Colors", width, height, alpha=True, float_buffer=True, is_data=True
    )
    try:
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = colors
        b_picture.pixels.foreach_set(pixels.ravel())
        b_picture.pack()
        b_picture.colorspace_settings.name = space
        if tuple(b_picture.size) != (width, height) or b_picture.channels != 4:
            return None
        b_picture.pixels.foreach_get(pixels.ravel())
    except (TypeError, RuntimeError):  # of a space that this configuration doesn't have
        return None
    finally:
        bpy.data.images.remove(b_picture)
    converted = pixels[..., :3] / np.float32(compat.image_scale(space))
    converted[~np.isfinite(converted)] = 0
    return converted
