# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a scene is shown, and objects as the dependency graph shows its instances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mathutils import Matrix


@dataclass
class Placed:
    """An object that is placed by itself, as the dependency graph would show it among its instances."""

    object: Any
    parent: None = None
    is_instance: bool = False

    @property
    def matrix_world(self) -> Matrix:
        """Where it is."""
        matrix: Matrix = self.object.matrix_world
        return matrix


@dataclass(frozen=True)
class Filter:
    """What of the scene is shown."""

    b_space: Any = None  # a viewport that may hide what the scene shows; None hides nothing
    has_lights: bool = True

    def shows(self, b_instance: Any) -> bool:
        """Whether a placed object is among it."""
        return bool(b_instance.show_self) and self._shows_object(b_instance)

    def shows_hair(self, b_instance: Any) -> bool:
        """Whether hair that grows on a placed object is."""
        return bool(b_instance.show_particles) and self._shows_object(b_instance)

    def _shows_object(self, b_instance: Any) -> bool:
        if self.b_space is None:
            return True
        b_root = (b_instance.parent if b_instance.is_instance else None) or b_instance.object
        return bool(b_root.visible_in_viewport_get(self.b_space))
