# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of a viewport that shows the scene without its world: one of Blender's studio lights."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

import basicrt


class StudioLight:
    """Reads the picture of a studio light once."""

    def __init__(self) -> None:
        self._path = ""
        self._image: basicrt.Image | None = None

    def environment(self, b_shading: Any) -> basicrt.Environment:
        """What surrounds the scene under the light that the viewport's shading has chosen."""
        b_light = b_shading.selected_studio_light
        path = b_light.path if b_light is not None else ""
        if path != self._path:
            self._path, self._image = path, _read(path)
        strength = b_shading.studiolight_intensity
        transform = np.array(Matrix.Rotation(b_shading.studiolight_rotate_z, 4, "Z"), np.float32)
        seen = strength * b_shading.studiolight_background_alpha
        layers = [
            basicrt.EnvironmentLayer(
                radiance=(value, value, value), image=self._image, transform=transform, seen_by=rays
            )
            for value, rays in ((strength, "scattered"), (seen, "camera"))
        ]
        environment = basicrt.Environment()
        environment.layers = layers
        return environment


def key(b_shading: Any) -> Any:
    """What tells such environments apart; None where the scene's world is shown."""
    if b_shading.use_scene_world_render:
        return None
    return (
        b_shading.studio_light,
        b_shading.studiolight_rotate_z,
        b_shading.studiolight_intensity,
        b_shading.studiolight_background_alpha,
    )


def _read(path: str) -> basicrt.Image | None:
    """The pixels of a file, by way of an image that is in Blender's data for that moment only."""
    try:
        b_image = bpy.data.images.load(path)
    except RuntimeError:
        return None
    try:
        width, height = b_image.size
        pixels = np.empty(width * height * b_image.channels, np.float32)
        b_pixels: Any = b_image.pixels
        b_pixels.foreach_get(pixels)
    finally:
        bpy.data.images.remove(b_image)
    return basicrt.Image(pixels.reshape(height, width, -1)[..., :3].copy())
