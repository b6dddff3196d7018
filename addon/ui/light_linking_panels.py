# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of light and shadow linking, for versions of Blender whose own are Cycles' alone."""

from __future__ import annotations

from typing import Any

import bpy

from .panel import EnginePanel, register_panels


class _LinkingPanel(EnginePanel):
    """A collection of objects, each of them included or excluded."""

    bl_context = "object"
    bl_options: Any = {"DEFAULT_CLOSED"}
    kind = ""  # as Blender's operators call what is linked

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback."""
        return super().poll(context) and context.object is not None

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        links, name = context.object.light_linking, f"{self.kind}_collection"
        column = self.column()
        column.template_ID(links, name, new=f"object.light_linking_{name}_new")
        if not getattr(links, name):
            return
        row = self.layout.row()
        row.column().template_light_linking_collection(row, links, name)
        buttons = row.column(align=True)
        adding = buttons.operator(f"object.light_linking_{self.kind}s_link", icon="ADD", text="")
        adding.link_state = "INCLUDE"
        removing = "object.light_linking_unlink_from_collection"
        buttons.operator(removing, icon="REMOVE", text="")
        selecting = f"object.light_linking_{self.kind}s_select"
        buttons.operator(selecting, icon="RESTRICT_SELECT_OFF", text="")


class BASICRT_OBJECT_PT_light_linking(_LinkingPanel, bpy.types.Panel):
    """What an object lights."""

    bl_label = "Light Linking"
    kind = "receiver"


class BASICRT_OBJECT_PT_shadow_linking(_LinkingPanel, bpy.types.Panel):
    """What dims the light of an object."""

    bl_label = "Shadow Linking"
    kind = "blocker"


_PANELS = (BASICRT_OBJECT_PT_light_linking, BASICRT_OBJECT_PT_shadow_linking)
_show, _hide = register_panels(_PANELS)


def _are_needed() -> bool:
    return not hasattr(bpy.types, "OBJECT_PT_light_linking")


def register() -> None:
    """Show the panels where Blender has none that any engine could use."""
    if _are_needed():
        _show()


def unregister() -> None:
    """Hide them again."""
    if _are_needed():
        _hide()
