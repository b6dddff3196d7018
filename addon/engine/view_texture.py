# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's picture on the graphics card: the one place that draws."""

from __future__ import annotations

from typing import Any, Protocol

import bpy
import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d
from numpy.typing import NDArray

# The largest number of the texture's format.
_LARGEST = 65504.0


class Shown(Protocol):
    """What is read of a picture: as in basicrt.ViewPicture."""

    @property
    def pixels(self) -> NDArray[np.float32]:
        """(height, width, 4), scene-linear, alpha associated."""

    @property
    def rect(self) -> tuple[int, int, int, int]:
        """x, y, width and height."""

    @property
    def film_size(self) -> tuple[int, int]:
        """Width and height of all that the view could show."""


class ViewTexture:
    """Made and drawn only while Blender draws: at other times there is no graphics context."""

    def __init__(self) -> None:
        self._texture: Any = None
        self._place = (0.0, 0.0, 1.0, 1.0)  # x, y, width, height as parts of the region

    def set(self, picture: Shown) -> None:
        """Show this picture from now on."""
        x, y, width, height = picture.rect
        film_width, film_height = picture.film_size
        self._place = x / film_width, y / film_height, width / film_width, height / film_height
        pixels = np.clip(picture.pixels, -_LARGEST, _LARGEST).reshape(-1)
        make: Any = gpu.types.Buffer
        buffer = make("FLOAT", pixels.size, pixels)
        make_texture: Any = gpu.types.GPUTexture
        self._texture = make_texture((width, height), format="RGBA16F", data=buffer)

    def draw(self, engine: Any, b_scene: bpy.types.Scene, width: int, height: int) -> None:
        """Draw it in a region of that size; its values are scene-linear, the view transform is Blender's."""
        if self._texture is None or engine is None:
            return
        left, lower, part_x, part_y = self._place
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(b_scene)
        draw_texture_2d(
            self._texture, (left * width, lower * height), part_x * width, part_y * height
        )
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
