# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own panels that any path tracer can use are shown for BasicRT too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from .. import compat
from ..engine import BasicRTRenderEngine

# Marked for every engine, but for settings that BasicRT does not have or shows itself.
_EXCLUDED = {
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify_viewport",
    "DATA_PT_light",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
}


def core_panels() -> Iterator[Any]:
    """The panels of Blender that suit BasicRT."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        name = panel.__name__
        is_general = "BLENDER_RENDER" in engines and name not in _EXCLUDED
        if is_general or name in compat.SHARED_PANELS:
            yield panel


def register() -> None:
    """Add BasicRT to the engines they are shown for."""
    for panel in core_panels():
        panel.COMPAT_ENGINES.add(BasicRTRenderEngine.bl_idname)


def unregister() -> None:
    """Remove it from all of them."""
    for panel in bpy.types.Panel.__subclasses__():
        engines: Any = getattr(panel, "COMPAT_ENGINES", None)
        if engines and not panel.__module__.startswith(__package__ or __name__):
            engines.discard(BasicRTRenderEngine.bl_idname)
