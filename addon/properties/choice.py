# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings count for a scene: its own `scene.basicrt`, or those that it was saved with for Cycles.

The rule, for each setting that both have:

1. With `use_cycles_settings`, Cycles' value, changed or not.
2. Otherwise ours where it was ever changed.
3. Otherwise Cycles' where that was ever changed.
4. Otherwise our default.

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
    "seed": "seed",
    "use_animated_seed": "use_animated_seed",
    "max_bounces": "max_bounces",
    "diffuse_bounces": "diffuse_bounces",
    "glossy_bounces": "glossy_bounces",
    "transmission_bounces": "transmission_bounces",
    "transparent_bounces": "transparent_max_bounces",
    "film_exposure": "film_exposure",
    "filter_type": "pixel_filter_type",
    "filter_width": "filter_width",
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
        self._cycles = getattr(data, "cycles", None)

    def source(self, name: str) -> Source:
        """Where a setting of ours is read from."""
        own = Source(self._own, name, is_cycles=False)
        if self._cycles is None or name not in CYCLES_NAMES:
            return own
        cycles = Source(self._cycles, CYCLES_NAMES[name], is_cycles=True)
        if self._own.use_cycles_settings:
            return cycles
        if self._own.is_property_set(name) or not self._cycles.is_property_set(cycles.name):
            return own
        return cycles

    def __getattr__(self, name: str) -> Any:
        """The value of a setting, by our name."""
        return self.source(name).value

    def followed(self) -> Iterator[str]:
        """The settings that are read from Cycles."""
        return (name for name in CYCLES_NAMES if self.source(name).is_cycles)


def copy_from_cycles(b_scene: bpy.types.Scene) -> None:
    """Make Cycles' values our own, which count from then on whatever becomes of Cycles'."""
    data: Any = b_scene
    for name, cycles_name in CYCLES_NAMES.items():
        setattr(data.basicrt, name, getattr(data.cycles, cycles_name))
    data.basicrt.use_cycles_settings = False
