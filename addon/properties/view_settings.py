# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings kept in each 3D viewport as `shading.basicrt`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from bpy.props import EnumProperty

# The passes that mean something as a colour, by the core's names.
PASSES = (
    "Combined",
    "Depth",
    "Normal",
    "Mist",
    "Position",
    "UV",
    "Object Index",
    "Material Index",
    "Diffuse Direct",
    "Diffuse Indirect",
    "Diffuse Color",
    "Glossy Direct",
    "Glossy Indirect",
    "Glossy Color",
    "Transmission Direct",
    "Transmission Indirect",
    "Transmission Color",
    "Volume Direct",
    "Volume Indirect",
    "Emission",
    "Environment",
    "Shadow Catcher",
)


class BasicRTViewSettings(bpy.types.PropertyGroup):
    """How a viewport shows what BasicRT renders."""

    if TYPE_CHECKING:
        render_pass: str
    else:
        render_pass: EnumProperty(
            name="Render Pass",
            description="What the viewport shows",
            items=[(name, name, "") for name in PASSES],
            default="Combined",
        )
