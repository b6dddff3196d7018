# SPDX-License-Identifier: GPL-3.0-or-later
"""The RenderEngine: Blender's callbacks. It exports inside Blender's lock, and renders afterwards."""

from __future__ import annotations

import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from .. import compat
from ..report import HeldReport, Report, caught, show_warnings
from . import command_line
from .result import NOISY_PASS, complete_without_pixels

if TYPE_CHECKING:
    from ..sync.scene_sync import Export
    from .bake import ObjectBake
    from .viewport import Viewport


class BasicRTRenderEngine(bpy.types.RenderEngine):
    """Renders with BasicRT."""

    bl_idname = "BASICRT"
    bl_label = "BasicRT"
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_eevee_viewport = True  # for Material Preview
    bl_use_shading_nodes_custom = False  # Blender's own nodes, in its own menus

    # When set, the next render writes its scene there instead of tracing it: only a render has a
    # dependency graph with the render's own visibility and modifiers.
    export_path: Path | None = None
    # Settings that count before those of the command line and of scenes.
    given_overrides: command_line.Overrides | None = None

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        """Blender calls it twice from 4.5 on."""
        super().__init__(*args, **kwargs)
        self.exported: Export | None = None
        self.viewport: Viewport | None = None
        self.baking: ObjectBake | None = None
        self.warnings = Report()  # of all view layers
        self.failure: str | None = None
        self.overrides = command_line.Overrides()

    def update(self, data: Any = None, depsgraph: Any = None) -> None:
        """Blender's callback, with scene data locked: export everything a render needs."""
        self.exported, self.failure = None, None
        if self._is_baking():
            return
        with caught(self._remember_failure):
            self._export(depsgraph)

    def render(self, depsgraph: Any) -> None:  # type: ignore[override]
        """Blender's callback: render one view layer."""
        exported, self.exported = self.exported, None
        with caught(self._fail):
            if exported is None:
                self._fail(self.failure or "BasicRT: the scene was not exported")
            elif self.is_preview:
                self._draw_preview(exported, depsgraph)
            elif BasicRTRenderEngine.export_path is not None:
                exported.scene.save(str(BasicRTRenderEngine.export_path))
                complete_without_pixels(self)
            else:
                self._trace(exported, depsgraph)

    def _is_baking(self) -> bool:
        """Whether it is bake() that Blender will call: what a render exports would be of no use then.

        Blender doesn't say so of a bake by a script, but then there is no picture to be made, unless
        one was made before.
        """
        is_job = bpy.app.is_job_running("OBJECT_BAKE") and not self.is_preview
        return self.resolution_x == 0 or is_job

    def bake(  # type: ignore[override]
        self,
        depsgraph: Any,
        b_object: Any,
        pass_type: str,
        pass_filter: int,
        width: int,
        height: int,
    ) -> None:
        """Blender's callback: bake an object into one image."""
        with caught(self._fail_baking):
            compat.check_native()
            from ..export.baking import convert_plan
            from .bake import ObjectBake

            if self.baking is None:
                self.overrides = self.given_overrides or command_line.overrides()
                self.baking = ObjectBake(
                    self, depsgraph, self.overrides, self.warnings, self._is_cancelled
                )
            self._check_warnings(depsgraph.scene)
            plan = convert_plan(depsgraph.scene, pass_type, pass_filter)
            self.baking.bake_image(b_object, plan, width, height)

    def _fail_baking(self, message: str) -> None:
        self.report({"ERROR"}, message)

    def view_update(self, context: Any, depsgraph: Any) -> None:
        """Blender's callback: something changed in the scene that a viewport shows."""
        with caught(self._show_failure):
            self._viewport().update(context, depsgraph)

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        """Blender's callback: draw a viewport."""
        with caught(self._show_failure):
            self._viewport().draw(context, depsgraph)

    def _viewport(self) -> Viewport:
        """What shows the scene in the viewport of this engine."""
        if self.viewport is None:
            compat.check_native()
            from .viewport import Viewport

            self.viewport = Viewport(self)
            # Blender tells nobody when it closes a viewport; a dying engine can't be asked for anything.
            weakref.finalize(self, self.viewport.close)
        return self.viewport

    def _show_failure(self, message: str) -> None:
        """In the corner of a viewport."""
        self.update_stats("", message)

    def update_render_passes(
        self, scene: bpy.types.Scene | None = None, renderlayer: bpy.types.ViewLayer | None = None
    ) -> None:
        """Blender's callback: name the passes, for the result and the compositor."""
        if scene is None or renderlayer is None:
            return
        try:
            compat.check_native()
        except compat.NativeModuleError:  # render() tells of it
            self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
            return
        from ..export import denoising
        from ..export.settings import enabled_passes, pass_names

        names = pass_names(renderlayer)
        kinds: dict[str, Any] = dict.fromkeys(("XYZ", "XYZW", "UVA"), "VECTOR")
        kinds |= {"Z": "VALUE", "X": "VALUE"}
        for info in enabled_passes(renderlayer):
            channels, name = info.channels, names[info.name]
            kind = kinds.get(channels, "COLOR")
            self.register_pass(scene, renderlayer, name, len(channels), channels, kind)
        if denoising.convert(scene, renderlayer) is not None:
            self.register_pass(scene, renderlayer, NOISY_PASS, 4, "RGBA", "COLOR")

    def _draw_preview(self, exported: Export, depsgraph: Any) -> None:
        """Render a small scene of Blender's: nobody waits for what it could be at best."""
        from ..export.settings import pass_names
        from . import preview

        layer = depsgraph.view_layer
        preview.render(
            self,
            exported,
            layer.name,
            pass_names(layer),
            depsgraph.scene,
            self.overrides,
            self._is_cancelled,
        )

    def _remember_failure(self, message: str) -> None:
        """update() can't end a render: render() is called after it and does."""
        self.failure = message

    def _fail(self, message: str) -> None:
        """End the render without a picture: Blender writes no file and exits with status 1.

        `report` does that, `error_set` shows the message beside the picture. A render without one
        complete result would crash Blender when it writes an EXR.
        """
        complete_without_pixels(self)
        if not self.is_preview:
            self.report({"ERROR"}, message)
            self.error_set(message)

    def _export(self, depsgraph: Any) -> None:
        """From Blender's data to a scene, and the warnings to their panel."""
        self.overrides = self.given_overrides or command_line.overrides()
        compat.check_native()
        from ..sync import scene_sync

        self.update_stats("", "Exporting")
        b_camera = self.camera_override or depsgraph.scene.camera
        evaluated = b_camera.evaluated_get(depsgraph) if b_camera else None
        if self.is_preview:
            self._export_preview(depsgraph, evaluated)
            return
        self.exported = scene_sync.export(depsgraph, evaluated, self.warnings, self.frame_set)
        self.overrides.apply(self.exported.scene.settings, depsgraph.scene)
        show_warnings(self.warnings)
        self._check_warnings(depsgraph.scene)

    def _export_preview(self, depsgraph: Any, b_camera: Any) -> None:
        """What is not as in Blender is told where the scene itself is rendered."""
        from ..sync import scene_sync
        from . import preview

        self.exported = scene_sync.export(depsgraph, b_camera, HeldReport())
        preview.simplify(self.exported.scene.settings)

    def _trace(self, exported: Export, depsgraph: Any) -> None:
        """Render one view layer."""
        from .layer_render import LayerRender

        layer = LayerRender(self, depsgraph, self.overrides, self.warnings, self._is_cancelled)
        layer.trace(exported)

    def _is_cancelled(self) -> bool:
        """Whether the user pressed Escape, or the process was interrupted."""
        return self.test_break()

    def _check_warnings(self, b_scene: Any) -> None:
        """Raises ExportError where there are some and the user wants none."""
        from .layer_render import check_warnings

        check_warnings(b_scene, self.overrides, self.warnings)
