# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings count for a scene: its own `scene.basicrt`, or those that it was saved with for Cycles.

The rule, for each setting that both have:

1. With `use_cycles_settings`, Cycles' value, changed or not.
2. Otherwise ours where it was ever changed.
3. Otherwise Cycles' where that was ever changed.
4. Otherwise our default. Ours are neutral (nothing is clamped or blurred, every pixel gets all samples)
   where Cycles' are not.

Adaptive sampling goes with the samples, of which Cycles files often have more than they need: where the
samples are Cycles', so is the noise threshold, changed or not.

Without Cycles (a Blender built without it, or its add-on disabled) ours count always.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy

# Our setting -> Cycles' of the same meaning.
CYCLES_NAMES = {
    "samples": "samples",
    "preview_samples": "preview_samples",
    "seed": "seed",
    "use_animated_seed": "use_animated_seed",
    "max_bounces": "max_bounces",
    "diffuse_bounces": "diffuse_bounces",
    "glossy_bounces": "glossy_bounces",
    "transmission_bounces": "transmission_bounces",
    "volume_bounces": "volume_bounces",
    "transparent_bounces": "transparent_max_bounces",
    "adaptive_threshold": "adaptive_threshold",
    "adaptive_min_samples": "adaptive_min_samples",
    "time_limit": "time_limit",
    "light_threshold": "light_sampling_threshold",
    "clamp_direct": "sample_clamp_direct",
    "clamp_indirect": "sample_clamp_indirect",
    "blur_glossy": "blur_glossy",
    "caustics_reflective": "caustics_reflective",
    "caustics_refractive": "caustics_refractive",
    "film_exposure": "film_exposure",
    "film_transparent_glass": "film_transparent_glass",
    "film_transparent_roughness": "film_transparent_roughness",
    "filter_type": "pixel_filter_type",
    "filter_width": "filter_width",
    "use_denoising": "use_denoising",
    "denoising_input_passes": "denoising_input_passes",
    "denoising_prefilter": "denoising_prefilter",
    "denoising_quality": "denoising_quality",
    "use_preview_denoising": "use_preview_denoising",
    "preview_denoising_input_passes": "preview_denoising_input_passes",
    "preview_denoising_prefilter": "preview_denoising_prefilter",
    "preview_denoising_quality": "preview_denoising_quality",
    "preview_denoising_start_sample": "preview_denoising_start_sample",
    "bake_type": "bake_type",
}


@dataclass(frozen=True)
class Source:
    """Where a setting's value is: a property of `scene.basicrt` or of `scene.cycles`."""

    owner: Any
    name: str
    is_cycles: bool

    @property
    def value(self) -> Any:
        """The value that counts."""
        return getattr(self.owner, self.name)


def has_cycles(b_scene: bpy.types.Scene) -> bool:
    """Whether Cycles' settings can be read."""
    return hasattr(b_scene, "cycles")


class Choice:
    """A scene's settings, each from where it counts."""

    def __init__(self, b_scene: bpy.types.Scene) -> None:
        data: Any = b_scene
        self._own = data.basicrt
        self._cycles: Any = getattr(data, "cycles", None)

    def source(self, name: str) -> Source:
        """Where a setting of ours is read from."""
        own = Source(self._own, name, is_cycles=False)
        if self._cycles is None or name not in CYCLES_NAMES:
            return own
        cycles = Source(self._cycles, CYCLES_NAMES[name], is_cycles=True)
        if self._own.use_cycles_settings:
            return cycles
        if self._own.is_property_set(name) or not self._is_changed_in_cycles(name):
            return own
        return cycles

    def _is_changed_in_cycles(self, name: str) -> bool:
        """Whether Cycles' settings say something about one of ours."""
        if name == "adaptive_threshold":
            return (
                self._cycles.is_property_set("use_adaptive_sampling")
                or self._cycles.is_property_set("adaptive_threshold")
                or self.source("samples").is_cycles
            )
        changed: bool = self._cycles.is_property_set(CYCLES_NAMES[name])
        return changed

    def __getattr__(self, name: str) -> Any:
        """The value of a setting, by our name."""
        return self.source(name).value

    @property
    def adaptive_threshold(self) -> float:
        """0 where sampling is not adaptive."""
        source = self.source("adaptive_threshold")
        value: float = _cycles_threshold(source.owner) if source.is_cycles else source.value
        return value

    def followed(self) -> Iterator[str]:
        """The settings that are read from Cycles."""
        return (name for name in CYCLES_NAMES if self.source(name).is_cycles)


def _cycles_threshold(cycles: Any) -> float:
    """Cycles' noise threshold, of which 0 leaves the choice to the samples."""
    if not cycles.use_adaptive_sampling:
        return 0.0
    return float(cycles.adaptive_threshold or max(0.001, 1.0 / cycles.samples))


def copy_from_cycles(b_scene: bpy.types.Scene) -> None:
    """Make Cycles' values our own, which count from then on whatever becomes of Cycles'."""
    data: Any = b_scene
    data.basicrt.use_cycles_settings = True
    chosen = Choice(b_scene)
    for name in CYCLES_NAMES:
        setattr(data.basicrt, name, getattr(chosen, name))
    data.basicrt.use_cycles_settings = False
