# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising of a view layer: its pixels are kept as they come, for the denoiser wants whole pictures."""

from __future__ import annotations

import importlib.util
import sys
from typing import TYPE_CHECKING, Any

import bpy

from ..report import Report

if TYPE_CHECKING:
    import basicrt

    from ..export.denoising import Denoising

    Pictures = dict[str, Any]

# What the denoiser's package needs that Blender's Python lacks.
_PACKAGES = "pyoidn cffi pycparser"


def is_installed() -> bool:
    """Whether the denoiser's package is there."""
    return importlib.util.find_spec("pyoidn") is not None


def install_command() -> str:
    """What installs it: into Blender's folder of scripts, where Blender is a program of its own."""
    if not bpy.app.binary_path:
        return "pip install pyoidn"
    folder = bpy.utils.user_resource("SCRIPTS", path="modules")
    return f'"{sys.executable}" -m pip install --no-deps --target "{folder}" {_PACKAGES}'


def install_hint() -> str:
    """What basicrt.check_denoiser() is to recommend."""
    return f"`{install_command()}` and restart Blender"


def can_denoise(b_scene: bpy.types.Scene, report: Report) -> bool:
    """Whether there is a denoiser; otherwise the picture stays noisy, with a warning."""
    import basicrt

    try:
        basicrt.check_denoiser(install_hint())
    except basicrt.DenoiserError as error:
        warn_noisy(b_scene, error, report)
        return False
    return True


def warn_noisy(b_scene: bpy.types.Scene, error: Exception, report: Report) -> None:
    """Tell why a picture is not denoised."""
    report.warn(f'scene "{b_scene.name}"', f"{error}; the picture stays noisy")


class LayerDenoiser:
    """Collects the tiles of a view layer in `rect` (x, y, width and height), and denoises them."""

    def __init__(
        self, options: Denoising, passes: list[str], rect: tuple[int, int, int, int]
    ) -> None:
        from basicrt.rendering import PictureBuffer

        left, lower, width, height = rect
        self._options = options
        self._buffer = PictureBuffer(passes, width, height, left, lower)

    def add(self, tile: basicrt.Tile) -> None:
        """Keep a finished tile."""
        self._buffer.add(tile)

    def finish(self, threads: int) -> Pictures:
        """All passes, with the picture denoised and the noisy one under a name of its own.

        Raises basicrt.DenoiserError.
        """
        from basicrt.denoising import DENOISING_PASSES, denoised

        pictures = self._buffer.pictures
        shown = {
            name: picture
            for name, picture in pictures.items()
            if name not in DENOISING_PASSES or name in self._options.passes
        }
        how = self._options
        made = denoised(shown, prefilter=how.prefilter, quality=how.quality, threads=threads)
        return {**pictures, **made}
