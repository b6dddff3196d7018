# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images as ours, and the textures of a scene that is being exported."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import basicrt

from . import color_spaces
from .mesh_data import MeshData, ObjectData

MISSING = (1.0, 0.0, 1.0)  # the colour of an image that can't be had, as in Cycles


@dataclass(frozen=True)
class ConvertedImage:
    """Our copy of an image."""

    image: basicrt.Image
    key: Hashable  # of the Blender image, or of the picture of it
    # The colour is multiplied by alpha, and Cycles divides by it where the node's alpha is in use.
    is_associated: bool


@dataclass(frozen=True)
class Surroundings:
    """What materials may ask of the Blender scene that they are exported with."""

    frame: int = 1
    # Where to look for an Attribute of the view layer, in this order.
    owners: tuple[bpy.types.bpy_struct, ...] = ()

    def attribute(self, name: str) -> float | tuple[float, ...] | None:
        """A custom property, or one of Blender's own by its path; None where there is none."""
        for owner in self.owners:
            try:
                found: Any = owner[name] if name in owner.keys() else owner.path_resolve(name)  # noqa: SIM118
            except (ValueError, TypeError, KeyError):
                continue
            if isinstance(found, (bool, int, float)):
                return float(found)
            numbers = (
                tuple(found) if hasattr(found, "__len__") and not isinstance(found, str) else ()
            )
            if 3 <= len(numbers) <= 4 and all(
                isinstance(number, (int, float)) for number in numbers
            ):
                return tuple(float(number) for number in numbers)
        return None


class Textures:
    """Converts each image once, and makes equal textures one."""

    def __init__(self, scene: basicrt.Scene, surroundings: Surroundings | None = None) -> None:
        self._scene = scene
        self.surroundings = surroundings or Surroundings()
        # What was asked of the surroundings.
        self._has_frame = False
        self._attributes: dict[str, float | tuple[float, ...] | None] = {}
        self._images: dict[Hashable, ConvertedImage | None] = {}
        self._indices: dict[Hashable, int] = {}
        # By a material's number: what it asks for of meshes.
        self.mesh_data: dict[int, frozenset[MeshData]] = {}
        self.object_data: dict[int, frozenset[ObjectData]] = {}  # the same of objects
        self.aovs: dict[str, int] = {}  # the numbers of AOVs by their names
        self.objects: set[int] = set()  # the numbers of those whose place counts for materials

    @property
    def has_window(self) -> bool:
        """Whether the camera's picture is flat: Window coordinates are known."""
        flat = (basicrt.PerspectiveCamera, basicrt.OrthographicCamera)
        return isinstance(self._scene.camera, flat)

    def attribute(self, name: str) -> float | tuple[float, ...] | None:
        """An Attribute of the view layer."""
        found = self.surroundings.attribute(name)
        self._attributes[name] = found
        return found

    def would_differ(self, surroundings: Surroundings) -> bool:
        """Whether something that was made here is another thing in other surroundings."""
        if self._has_frame and surroundings.frame != self.surroundings.frame:
            return True
        return any(surroundings.attribute(name) != said for name, said in self._attributes.items())

    def image(
        self, b_image: bpy.types.Image | None, b_user: Any, warn: Callable[[str], None]
    ) -> ConvertedImage | None:
        """A node's image; None, with a warning, where it has no pixels. Of a sequence the scene's frame."""
        if b_image is None:
            warn("has no image: drawn magenta")
            return None
        if b_image.source == "SEQUENCE":
            self._has_frame = True
            frame = sequence_frame(b_user, self.surroundings.frame)
            return self._file(b_image, (_key(b_image), frame), frame_path(b_image, frame), warn)
        if b_image.source == "MOVIE":
            warn(f'image "{b_image.name}": of a movie only the current picture is used')
        key = _key(b_image)
        if key not in self._images:
            self._images[key] = _convert(b_image, key, warn)
        if self._images[key] is None:
            warn(f'image "{b_image.name}" can\'t be read: drawn magenta')
        return self._images[key]

    def tiles(
        self, b_image: bpy.types.Image, warn: Callable[[str], None]
    ) -> dict[int, ConvertedImage | None]:
        """The tiles of a UDIM image by their numbers, None for those that can't be read."""
        numbers = [int(tile.number) for tile in b_image.tiles]
        if b_image.packed_file or b_image.is_dirty or len(b_image.packed_files) > 0:
            warn(
                f'image "{b_image.name}": packed or unsaved UDIM tiles are not supported: drawn magenta'
            )
            return dict.fromkeys(numbers)
        return {
            number: self._file(b_image, (_key(b_image), number), tile_path(b_image, number), warn)
            for number in numbers
        }

    def _file(
        self, b_image: bpy.types.Image, key: Hashable, path: str, warn: Callable[[str], None]
    ) -> ConvertedImage | None:
        """One picture of an image that has several."""
        if key not in self._images:
            with _loaded(b_image, path) as b_picture:
                self._images[key] = _convert(b_picture, key, warn) if b_picture else None
        if self._images[key] is None:
            warn(f'image "{b_image.name}": {path} can\'t be read: drawn magenta')
        return self._images[key]

    def draw(self, material: basicrt.Material, *, is_camera_ray: bool) -> basicrt.Image:
        """What a material that emits shows in each direction."""
        return self._scene.draw_environment(material, is_camera_ray=is_camera_ray)

    def add(self, key: Hashable, make: Callable[[], Any]) -> int:
        """The index of the texture with this key."""
        if key not in self._indices:
            self._indices[key] = self._scene.textures.append(make())
        return self._indices[key]


def is_tiled(node: Any) -> bool:
    """Whether a node's image is one of UDIM tiles."""
    b_image = getattr(node, "image", None)
    return b_image is not None and b_image.source == "TILED"


def _key(b_image: Any) -> int:
    """What tells images apart during one export."""
    return int(b_image.original.session_uid)


def sequence_frame(b_user: Any, scene_frame: int) -> int:
    """The number of a sequence's picture in a frame of the scene, as Blender counts."""
    count = int(b_user.frame_duration)
    if count == 0:
        return 0
    place = scene_frame - int(b_user.frame_start) + 1
    place = (place - 1) % count + 1 if b_user.use_cyclic else min(max(place, 0), count)
    return place + int(b_user.frame_offset)


def frame_path(b_image: bpy.types.Image, frame: int) -> str:
    """The file of a frame: its number takes the place of the last one in the file's name."""
    path = bpy.path.abspath(b_image.filepath, library=b_image.library)
    found = re.search(r"(\d+)(\D*)$", bpy.path.basename(path))
    if found is None:
        return path
    stem = path[: len(path) - len(found[0])]
    return f"{stem}{frame:0{len(found[1])}d}{found[2]}"


def tile_path(b_image: bpy.types.Image, number: int) -> str:
    """The file of a UDIM tile."""
    path = bpy.path.abspath(b_image.filepath, library=b_image.library)
    across, up = (number - 1001) % 10, (number - 1001) // 10
    return path.replace("<UDIM>", str(number)).replace("<UVTILE>", f"u{across + 1}_v{up + 1}")


@contextmanager
def _loaded(b_image: bpy.types.Image, path: str) -> Iterator[Any]:
    """An image of one file, read as another image says; None where the file can't be had."""
    try:
        b_picture: Any = bpy.data.images.load(path)
    except RuntimeError:
        yield None
        return
    try:
        b_own: Any = b_image.colorspace_settings
        b_picture.colorspace_settings.name = b_own.name
        b_picture.alpha_mode = b_image.alpha_mode
        yield b_picture
    finally:
        bpy.data.images.remove(b_picture)


def _convert(
    b_image: bpy.types.Image, key: Hashable, warn: Callable[[str], None]
) -> ConvertedImage | None:
    """A copy of an image's pixels, None where there are none."""
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
        encoded = _visible_channels(b_image, _bytes(shaped), 255)
        made = _of_bytes(b_image, encoded, is_associated, warn)
    return ConvertedImage(made, key, is_associated)


def _of_bytes(
    b_image: bpy.types.Image,
    encoded: NDArray[np.uint8],
    is_associated: bool,
    warn: Callable[[str], None],
) -> basicrt.Image:
    """The colours that an image's bytes stand for."""
    encoding = color_spaces.encoding(b_image)
    if encoding is None:
        colors = color_spaces.decoded(b_image, encoded, is_associated=is_associated)
        if colors is not None:
            return basicrt.Image(colors)
        b_colorspace: Any = b_image.colorspace_settings
        warn(
            f'image "{b_image.name}": the colour space {b_colorspace.name} can\'t be converted: '
            "taken for sRGB"
        )
        encoding = "srgb"
    if is_associated and encoded.shape[2] == 4:
        encoded = _associated(encoded)
    return basicrt.Image(encoded, encoding)


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
