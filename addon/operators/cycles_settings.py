# SPDX-License-Identifier: GPL-3.0-or-later
"""The button that makes the settings of Cycles our own."""

from __future__ import annotations

from typing import Any

import bpy

from ..engine import BasicRTRenderEngine
from ..properties.choice import copy_from_cycles, has_cycles


class BASICRT_OT_copy_cycles_settings(bpy.types.Operator):
    """Set BasicRT's settings to the values of Cycles'. Later changes of Cycles' don't matter"""

    bl_idname = "basicrt.copy_cycles_settings"
    bl_label = "Copy from Cycles"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback: only where Cycles has settings."""
        return context.engine == BasicRTRenderEngine.bl_idname and has_cycles(context.scene)

    def execute(self, context: Any) -> Any:
        """Blender's callback."""
        copy_from_cycles(context.scene)
        return {"FINISHED"}


def register() -> None:
    """Add the operator."""
    bpy.utils.register_class(BASICRT_OT_copy_cycles_settings)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_class(BASICRT_OT_copy_cycles_settings)
