# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates Blender's shader nodes into BasicRT's: one small function for each node."""

from __future__ import annotations

from .images import Surroundings, Textures
from .mesh_data import MeshData, ObjectData, Part, Source
from .node_view import LampObject
from .translate import Emission, emission_of, translate_surface
from .world import translate_world, translate_world_volume

__all__ = [
    "Emission",
    "LampObject",
    "MeshData",
    "ObjectData",
    "Part",
    "Source",
    "Surroundings",
    "Textures",
    "emission_of",
    "translate_surface",
    "translate_world",
    "translate_world_volume",
]
