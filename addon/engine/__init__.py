# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine BASICRT."""

from __future__ import annotations

import bpy

from ..sync import changes
from . import command_line
from .command_line import Overrides
from .final import BasicRTRenderEngine

__all__ = ["BasicRTRenderEngine", "Overrides", "register", "unregister"]


def register() -> None:
    """Add the engine to Blender."""
    changes.register()
    command_line.check()
    bpy.utils.register_class(BasicRTRenderEngine)


def unregister() -> None:
    """Take it away: Blender 4.2 and 4.5 do not end properly with an engine left registered."""
    bpy.utils.unregister_class(BasicRTRenderEngine)
    changes.unregister()
