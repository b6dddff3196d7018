# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's world: one colour from everywhere."""

from __future__ import annotations

from typing import Any

import bpy

import basicrt

from ..nodes import emission_of
from ..report import Report


def convert(b_world: bpy.types.World | None, report: Report) -> basicrt.Environment:
    """The environment of a world, black without one."""
    if b_world is None:
        return basicrt.Environment(radiance=(0.0, 0.0, 0.0))
    emission = emission_of(b_world, report)
    if emission is not None:
        return basicrt.Environment(radiance=emission.radiance)
    color: Any = b_world.color
    return basicrt.Environment(radiance=tuple(color))
