# SPDX-License-Identifier: GPL-3.0-or-later
"""What materials ask for of the meshes and objects that have them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Source(StrEnum):
    """Where to look for a name; without one it is the map or colour that is active for rendering."""

    ATTRIBUTE = "attribute"
    UV = "uv"
    COLOR = "color"


class Part(StrEnum):
    """What of it."""

    VECTOR = "vector"
    MEAN = "mean"
    ALPHA = "alpha"
    TANGENT = "tangent"  # of the UV map's first coordinate
    TANGENT_SIGN = "tangent_sign"  # -1 where the UV map is mirrored
    ISLAND = "island"  # a random number for each connected piece
    POINTINESS = "pointiness"  # how far it sticks out there


@dataclass(frozen=True, order=True)
class MeshData:
    """Numbers of a mesh that become one of its attributes."""

    source: Source
    name: str
    part: Part = Part.VECTOR

    @property
    def exported_name(self) -> str:
        """Of the attribute in the core."""
        name = self.name or f"active {self.source}"
        return name if self.part == Part.VECTOR else f"{name}:{self.part}"


@dataclass(frozen=True, order=True)
class ObjectData:
    """A property of an object that becomes one of its instance's."""

    name: str
    of_instancer: bool  # what instances it comes first
    is_alpha: bool = False  # the fourth number, not the first three

    @property
    def exported_name(self) -> str:
        """Of the property in the core."""
        owner = "instancer" if self.of_instancer else "object"
        return f"{owner}:{self.name}:alpha" if self.is_alpha else f"{owner}:{self.name}"
