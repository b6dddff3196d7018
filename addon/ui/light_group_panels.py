# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of light groups: a view layer's, and the one that an object or a world is in."""

from __future__ import annotations

from typing import Any

import bpy

from .panel import EnginePanel, draw_list, register_panels


class BASICRT_VIEWLAYER_PT_light_groups(EnginePanel, bpy.types.Panel):
    """The groups whose light has a pass of its own."""

    bl_label = "Light Groups"
    bl_context = "view_layer"
    bl_parent_id = "BASICRT_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        view_layer, active = context.view_layer, "active_lightgroup_index"
        draw_list(self.layout, "UI_UL_list", view_layer, "lightgroups", active, "lightgroup")


class _MembershipPanel(EnginePanel):
    """Which group something is in."""

    bl_label = "Light Group"
    bl_options: Any = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback: only where there is something that could be in one."""
        return super().poll(context) and getattr(context, cls.bl_context, None) is not None

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        owner, view_layer = getattr(context, self.bl_context), context.view_layer
        self.column().prop_search(
            owner, "lightgroup", view_layer, "lightgroups", results_are_suggestions=True
        )


class BASICRT_OBJECT_PT_light_group(_MembershipPanel, bpy.types.Panel):
    """Of what an object emits."""

    bl_context = "object"


class BASICRT_WORLD_PT_light_group(_MembershipPanel, bpy.types.Panel):
    """Of the world's light."""

    bl_context = "world"


_PANELS = (
    BASICRT_VIEWLAYER_PT_light_groups,
    BASICRT_OBJECT_PT_light_group,
    BASICRT_WORLD_PT_light_group,
)

register, unregister = register_panels(_PANELS)
