# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export > BasicRT Scene: the scene as JSON, exactly as a render would trace it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper

from ..engine import BasicRTRenderEngine


class BASICRT_OT_export_scene(bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    """Write the current frame's scene as JSON for the command line. Clears the last render"""

    bl_idname = "basicrt.export_scene"
    bl_label = "Export BasicRT Scene"
    filename_ext = ".json"

    if TYPE_CHECKING:
        filepath: str
        filter_glob: str
    else:
        filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback: only a render with BasicRT can export."""
        return bool(context.engine == BasicRTRenderEngine.bl_idname)

    def execute(self, context: Any) -> Any:
        """Blender's callback."""
        render = context.scene.render
        # A render whose pictures nobody looks at: nothing may be composited or written from it.
        kept = render.use_compositing, render.use_sequencer
        render.use_compositing = render.use_sequencer = False
        BasicRTRenderEngine.export_path = Path(bpy.path.abspath(self.filepath))
        try:
            bpy.ops.render.render(scene=context.scene.name, layer=context.view_layer.name)
        except RuntimeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            BasicRTRenderEngine.export_path = None
            render.use_compositing, render.use_sequencer = kept
        return {"FINISHED"}


def _draw_menu(menu: Any, context: Any) -> None:
    """The entry in File > Export."""
    menu.layout.operator(BASICRT_OT_export_scene.bl_idname, text="BasicRT Scene (.json)")


def register() -> None:
    """Add the operator and its menu entry."""
    bpy.utils.register_class(BASICRT_OT_export_scene)
    bpy.types.TOPBAR_MT_file_export.append(_draw_menu)


def unregister() -> None:
    """Take them away."""
    bpy.types.TOPBAR_MT_file_export.remove(_draw_menu)
    bpy.utils.unregister_class(BASICRT_OT_export_scene)
