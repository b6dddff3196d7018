# SPDX-License-Identifier: GPL-3.0-or-later
"""What BasicRT's own panels have in common."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import bpy

from ..engine import BasicRTRenderEngine


class EnginePanel:
    """A panel of the properties editor, shown for this engine."""

    bl_space_type: Any = "PROPERTIES"
    bl_region_type: Any = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {BasicRTRenderEngine.bl_idname}
    layout: Any

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback."""
        return context.engine in cls.COMPAT_ENGINES

    def column(self) -> Any:
        """Where properties go, in Blender's two-column style."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


def draw_list(
    layout: Any, list_class: str, view_layer: Any, items: str, active: str, operator: str
) -> None:
    """A view layer's list of passes, with buttons that add and remove; `operator` ends what they do."""
    row = layout.row()
    row.column().template_list(list_class, items, view_layer, items, view_layer, active, rows=3)
    column = row.column(align=True)
    column.operator(f"scene.view_layer_add_{operator}", icon="ADD", text="")
    column.operator(f"scene.view_layer_remove_{operator}", icon="REMOVE", text="")


def register_panels(panels: Sequence[type]) -> tuple[Callable[[], None], Callable[[], None]]:
    """What shows these panels, and what hides them again."""
    make: Any = bpy.utils.register_classes_factory
    register, unregister = make(panels)
    return register, unregister
