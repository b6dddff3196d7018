# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images as ours, and the textures of a scene that is being exported."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import basicrt

from .mesh_data import MeshData

MISSING = (1.0, 0.0, 1.0)  # the colour of an image that can't be had, as in Cycles

_LINEAR_SPACES = ("Linear", "Linear Rec.709", "Raw", "Non-Color")
_SRGB_SPACES = ("sRGB", "sRGB Rec.1886")


@dataclass(frozen=True)
class ConvertedImage:
    """Our copy of an image."""

    image: basicrt.Image
    key: int  # of the Blender image
    # The colour is multiplied by alpha, and Cycles divides by it where the node's alpha is in use.
    is_associated: bool


class Textures:
    """Converts each image once, and makes equal textures one."""

    def __init__(self, scene: basicrt.Scene) -> None:
        self._scene = scene
        self._images: dict[int, ConvertedImage | None] = {}
        self._indices: dict[Hashable, int] = {}
        # By a material's number: what it asks for of meshes.
        self.mesh_data: dict[int, frozenset[MeshData]] = {}
        self.aovs: dict[str, int] = {}  # the numbers of AOVs by their names
        self.objects: set[int] = set()  # the numbers of those whose place counts for materials

    @property
    def has_window(self) -> bool:
        """Whether the camera's picture is flat: Window coordinates are known."""
        flat = (basicrt.PerspectiveCamera, basicrt.OrthographicCamera)
        return isinstance(self._scene.camera, flat)

    def image(
        self, b_image: bpy.types.Image | None, warn: Callable[[str], None]
    ) -> ConvertedImage | None:
        """An image; None, with a warning, where it has no pixels."""
        if b_image is None:
            warn("has no image: drawn magenta")
            return None
        key = _key(b_image)
        if key not in self._images:
            self._images[key] = _convert(b_image, key, warn)
        if self._images[key] is None:
            warn(f'image "{b_image.name}" can\'t be read: drawn magenta')
        return self._images[key]

    def draw(self, material: basicrt.Material, *, is_camera_ray: bool) -> basicrt.Image:
        """What a material that emits shows in each direction."""
        return self._scene.draw_environment(material, is_camera_ray=is_camera_ray)

    def add(self, key: Hashable, make: Callable[[], Any]) -> int:
        """The index of the texture with this key."""
        if key not in self._indices:
            self._indices[key] = self._scene.textures.append(make())
        return self._indices[key]


def _key(b_image: Any) -> int:
    """What tells images apart during one export."""
    return int(b_image.original.session_uid)


def _convert(
    b_image: bpy.types.Image, key: int, warn: Callable[[str], None]
) -> ConvertedImage | None:
    """A copy of an image's pixels, None where there are none."""
    if b_image.source in ("SEQUENCE", "MOVIE"):
        warn(f'image "{b_image.name}": of a sequence or movie only the current picture is used')
    elif b_image.source == "TILED":
        warn(f'image "{b_image.name}": UDIM is not supported: its first tile is used')
    width, height = b_image.size
    channels = b_image.channels
    if width * height * channels == 0:
        return None
    pixels: NDArray[np.float32] = np.empty(width * height * channels, np.float32)
    b_pixels: Any = b_image.pixels
    b_pixels.foreach_get(pixels)
    shaped = pixels.reshape(height, width, channels)
    b_colorspace: Any = b_image.colorspace_settings
    is_data = b_colorspace.is_data
    is_associated = not is_data and b_image.alpha_mode in ("STRAIGHT", "PREMUL") and channels == 4
    if b_image.is_float:
        made = basicrt.Image(_visible_channels(b_image, _finite(shaped), 1.0))
    else:
        encoding = _encoding(b_image, warn)
        encoded = _visible_channels(b_image, _bytes(shaped), 255)
        if is_associated and encoded.shape[2] == 4:
            encoded = _associated(encoded)
        made = basicrt.Image(encoded, encoding)
    return ConvertedImage(made, key, is_associated)


def _encoding(b_image: bpy.types.Image, warn: Callable[[str], None]) -> str:
    """How an image's bytes stand for colour."""
    b_colorspace: Any = b_image.colorspace_settings
    name = b_colorspace.name
    if b_colorspace.is_data or name in _LINEAR_SPACES:
        return "linear"
    if name not in _SRGB_SPACES:
        warn(f'image "{b_image.name}": the colour space {name} is not supported: taken for sRGB')
    return "srgb"


def _finite(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Without infinities and NaNs, which become black."""
    if not np.isfinite(pixels.sum(dtype=np.float64)):
        pixels[~np.isfinite(pixels)] = 0.0
    return pixels


def _bytes(pixels: NDArray[np.float32]) -> NDArray[np.uint8]:
    """The bytes that Blender gives as floats. Overwrites the floats."""
    np.multiply(pixels, 255.0, out=pixels)
    np.add(pixels, 0.5, out=pixels)
    np.clip(pixels, 0.0, 255.0, out=pixels)
    return pixels.astype(np.uint8)


def _visible_channels(
    b_image: bpy.types.Image, pixels: NDArray[Any], opaque: float
) -> NDArray[Any]:
    """Without an alpha channel that says nothing or is not to be used."""
    if pixels.shape[2] == 4 and (b_image.alpha_mode == "NONE" or pixels[..., 3].min() >= opaque):
        return pixels[..., :3]
    return pixels


def _associated(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Multiplied by alpha: of encoded bytes, and rounded down, as Cycles does it."""
    alpha = pixels[..., 3:].astype(np.uint16)
    pixels[..., :3] = pixels[..., :3] * alpha // 255
    return pixels
