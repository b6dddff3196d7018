# SPDX-License-Identifier: GPL-3.0-or-later
"""What BasicRT adds to Blender's data: `scene.basicrt`, and `shading.basicrt` of 3D viewports."""

from __future__ import annotations

from typing import Any

import bpy

from .render_settings import BasicRTRenderSettings
from .view_settings import BasicRTViewSettings

_SCENE: Any = bpy.types.Scene
_SHADING: Any = bpy.types.View3DShading


def settings_of(b_scene: bpy.types.Scene) -> BasicRTRenderSettings:
    """A scene's `basicrt`, which Blender's types don't know."""
    data: Any = b_scene
    settings: BasicRTRenderSettings = data.basicrt
    return settings


def register() -> None:
    """Add them."""
    bpy.utils.register_class(BasicRTRenderSettings)
    make: Any = bpy.props.PointerProperty
    _SCENE.basicrt = make(
        type=BasicRTRenderSettings, name="BasicRT", description="BasicRT's render settings"
    )
    bpy.utils.register_class(BasicRTViewSettings)
    _SHADING.basicrt = make(
        type=BasicRTViewSettings, name="BasicRT", description="BasicRT's settings of a viewport"
    )


def unregister() -> None:
    """Take them away; files keep the values."""
    del _SHADING.basicrt
    bpy.utils.unregister_class(BasicRTViewSettings)
    del _SCENE.basicrt
    bpy.utils.unregister_class(BasicRTRenderSettings)
