# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world: what surrounds the scene."""

from __future__ import annotations

from typing import Any

import bpy

import basicrt

from ..nodes import Textures, translate_world, translate_world_volume
from ..report import Report


def convert(
    b_world: bpy.types.World | None, report: Report, textures: Textures
) -> basicrt.Environment:
    """The environment of a world, black without one; its images are shared through `textures`."""
    if b_world is None:
        return basicrt.Environment()
    environment = translate_world(b_world, report, textures)
    if environment is not None:
        return environment
    color: Any = b_world.color
    return basicrt.Environment(radiance=tuple(color))


def convert_volume(
    b_world: bpy.types.World | None, report: Report, textures: Textures
) -> basicrt.Material | None:
    """A material whose volume fills all space, None where nothing does."""
    return translate_world_volume(b_world, report, textures) if b_world else None
