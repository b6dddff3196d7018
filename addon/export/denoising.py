# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether and how the picture of a view layer, or of a viewport, is denoised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

from basicrt.denoising import DENOISING_PASSES

from ..properties.choice import Choice

# What the denoiser is shown beside the picture, by Blender's name of the choice.
_INPUT_PASSES = {
    "RGB": (),
    "RGB_ALBEDO": DENOISING_PASSES[:1],
    "RGB_ALBEDO_NORMAL": DENOISING_PASSES,
}


@dataclass(frozen=True)
class Denoising:
    """How: the passes that the denoiser looks at, and what basicrt.denoise() is told."""

    passes: tuple[str, ...]
    prefilter: str
    quality: str


@dataclass(frozen=True)
class ViewDenoising:
    """How viewports are: as pictures are, once each pixel has so many samples."""

    how: Denoising
    start_sample: int


def convert(b_scene: bpy.types.Scene, b_view_layer: bpy.types.ViewLayer) -> Denoising | None:
    """None where the scene, or Cycles' switch of the view layer, wants none."""
    chosen = Choice(b_scene)
    data: Any = b_view_layer
    if not (chosen.use_denoising and getattr(getattr(data, "cycles", None), "use_denoising", True)):
        return None
    return Denoising(
        passes=_INPUT_PASSES[chosen.denoising_input_passes],
        prefilter=chosen.denoising_prefilter.lower(),
        quality=chosen.denoising_quality.lower(),
    )


def convert_view(b_scene: bpy.types.Scene, pass_name: str) -> ViewDenoising | None:
    """None where the scene wants none for viewports, or where they show another pass than Combined.

    A view layer's switch is for final renders alone, as in Cycles.
    """
    chosen = Choice(b_scene)
    if not chosen.use_preview_denoising or pass_name != "Combined":
        return None
    how = Denoising(
        passes=_INPUT_PASSES[chosen.preview_denoising_input_passes],
        prefilter=chosen.preview_denoising_prefilter.lower(),
        quality=chosen.preview_denoising_quality.lower(),
    )
    return ViewDenoising(how, chosen.preview_denoising_start_sample)
