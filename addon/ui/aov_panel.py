# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of a view layer's AOVs."""

from __future__ import annotations

from typing import Any

import bpy

from .panel import EnginePanel, draw_list, register_panels


class BASICRT_VIEWLAYER_PT_aovs(EnginePanel, bpy.types.Panel):
    """The passes that materials write."""

    bl_label = "Shader AOV"
    bl_context = "view_layer"
    bl_parent_id = "BASICRT_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        view_layer = context.view_layer
        draw_list(self.layout, "VIEWLAYER_UL_aov", view_layer, "aovs", "active_aov_index", "aov")
        chosen = view_layer.active_aov
        if chosen is not None and not chosen.is_valid:
            self.layout.label(text="Another pass has this name", icon="ERROR")


register, unregister = register_panels((BASICRT_VIEWLAYER_PT_aovs,))
