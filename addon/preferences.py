# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's page in Blender's preferences: whether the native module is there."""

from __future__ import annotations

from typing import Any

import bpy

from . import compat


class BasicRTPreferences(bpy.types.AddonPreferences):
    """Shows which native module renders, or why none can."""

    bl_idname = __package__ or "basicrt"

    def draw(self, context: bpy.types.Context) -> None:
        """Blender's callback."""
        try:
            text, icon = f"Native module {compat.check_native()}", "CHECKMARK"
        except compat.NativeModuleError as error:
            text, icon = str(error), "ERROR"
        layout: Any = self.layout
        layout.label(text=text, icon=icon)


def register() -> None:
    """Register the preferences."""
    bpy.utils.register_class(BasicRTPreferences)


def unregister() -> None:
    """Undo register()."""
    bpy.utils.unregister_class(BasicRTPreferences)
