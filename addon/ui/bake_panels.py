# SPDX-License-Identifier: GPL-3.0-or-later
"""What is baked and where it goes: Blender shows its settings of that for Cycles alone."""

from __future__ import annotations

from typing import Any

import bpy

from ..properties.choice import Choice
from .panel import EnginePanel, register_panels

# Of these it makes no difference where they are seen from.
_VIEWLESS = {"AO", "POSITION", "NORMAL", "UV", "ROUGHNESS", "ENVIRONMENT"}
_LIGHT = {"DIFFUSE", "GLOSSY", "TRANSMISSION"}


class _BakePanel(EnginePanel):
    bl_options: Any = {"DEFAULT_CLOSED"}


class BASICRT_RENDER_PT_bake(_BakePanel, bpy.types.Panel):
    """What is baked."""

    bl_label = "Bake"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        source = Choice(context.scene).source("bake_type")
        column = self.column()
        column.operator("object.bake", icon="RENDER_STILL").type = source.value
        column.prop(source.owner, source.name)
        if source.value not in _VIEWLESS:
            row = column.row()
            row.active = context.scene.camera is not None
            row.prop(context.scene.render.bake, "view_from")


class BASICRT_RENDER_PT_bake_influence(_BakePanel, bpy.types.Panel):
    """What it is to contain."""

    bl_label = "Influence"
    bl_parent_id = "BASICRT_RENDER_PT_bake"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback: only for what has a choice."""
        has_choice = {"NORMAL", "COMBINED"} | _LIGHT
        return super().poll(context) and Choice(context.scene).bake_type in has_choice

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        bake, kind = context.scene.render.bake, Choice(context.scene).bake_type
        column = self.column()
        if kind == "NORMAL":
            column.prop(bake, "normal_space", text="Space")
            for name, text in (("r", "Swizzle R"), ("g", "G"), ("b", "B")):
                column.prop(bake, f"normal_{name}", text=text)
            return
        contributions = ["color"] if kind in _LIGHT else []
        for name in ("direct", "indirect", *contributions):
            column.prop(bake, f"use_pass_{name}")
        if kind == "COMBINED":
            column.separator()
            for name in ("diffuse", "glossy", "transmission", "emit"):
                column.prop(bake, f"use_pass_{name}")


class BASICRT_RENDER_PT_bake_selected_to_active(_BakePanel, bpy.types.Panel):
    """Whether it is other objects that are seen on the active one."""

    bl_label = "Selected to Active"
    bl_parent_id = "BASICRT_RENDER_PT_bake"

    def draw_header(self, context: Any) -> None:
        """Blender's callback."""
        self.layout.prop(context.scene.render.bake, "use_selected_to_active", text="")

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        bake, column = context.scene.render.bake, self.column()
        column.active = bake.use_selected_to_active
        column.prop(bake, "use_cage", text="Cage")
        if bake.use_cage:
            column.prop(bake, "cage_object")
        row = column.row()
        row.active = not bake.use_cage or bake.cage_object is None
        row.prop(bake, "cage_extrusion", text="Extrusion")
        column.prop(bake, "max_ray_distance")


class BASICRT_RENDER_PT_bake_output(_BakePanel, bpy.types.Panel):
    """Where it goes."""

    bl_label = "Output"
    bl_parent_id = "BASICRT_RENDER_PT_bake"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        bake, column = context.scene.render.bake, self.column()
        column.prop(bake, "target")
        if bake.target != "IMAGE_TEXTURES":
            return
        column.prop(bake, "use_clear", text="Clear Image")
        column.separator()
        kind = Choice(context.scene).bake_type
        # Blender has one kind of margin alone for what must not be mixed with what is beside it.
        if kind != "UV" and not (kind == "NORMAL" and bake.normal_space == "TANGENT"):
            column.prop(bake, "margin_type", text="Margin")
        column.prop(bake, "margin", text="Size")


register, unregister = register_panels(
    (
        BASICRT_RENDER_PT_bake,
        BASICRT_RENDER_PT_bake_influence,
        BASICRT_RENDER_PT_bake_selected_to_active,
        BASICRT_RENDER_PT_bake_output,
    )
)
