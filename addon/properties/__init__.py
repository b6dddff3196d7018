# SPDX-License-Identifier: GPL-3.0-or-later
"""What BasicRT adds to Blender's data: `scene.basicrt`."""

from __future__ import annotations

from typing import Any

import bpy

from .render_settings import BasicRTRenderSettings

_SCENE: Any = bpy.types.Scene


def settings_of(b_scene: bpy.types.Scene) -> BasicRTRenderSettings:
    """A scene's `basicrt`, which Blender's types don't know."""
    data: Any = b_scene
    settings: BasicRTRenderSettings = data.basicrt
    return settings


def register() -> None:
    """Add `scene.basicrt`."""
    bpy.utils.register_class(BasicRTRenderSettings)
    make: Any = bpy.props.PointerProperty
    _SCENE.basicrt = make(
        type=BasicRTRenderSettings, name="BasicRT", description="BasicRT's render settings"
    )


def unregister() -> None:
    """Take it away; files keep the values."""
    del _SCENE.basicrt
    bpy.utils.unregister_class(BasicRTRenderSettings)
