# SPDX-License-Identifier: GPL-3.0-or-later
"""BasicRT's own panels in the properties editor."""

from __future__ import annotations

import textwrap
from typing import Any

import bpy

from ..culprit import find_culprit
from ..engine.denoise import is_installed
from ..properties import settings_of
from ..properties.choice import Choice, has_cycles
from ..report import shown_warnings
from .panel import EnginePanel as _Panel
from .panel import register_panels


def _draw(column: Any, context: Any, name: str) -> None:
    """One of our settings, or Cycles' where that is the one that counts."""
    source = Choice(context.scene).source(name)
    if source.is_cycles and name == "adaptive_threshold":
        column.prop(source.owner, "use_adaptive_sampling", text="Adaptive Sampling (Cycles)")
    label = settings_of(context.scene).bl_rna.properties[name].name
    text = f"{label} (Cycles)" if source.is_cycles else label
    column.prop(source.owner, source.name, text=text)


class BASICRT_RENDER_PT_sampling(_Panel, bpy.types.Panel):
    """How much noise is left."""

    bl_label = "Sampling"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        for name in ("adaptive_threshold", "samples", "adaptive_min_samples", "time_limit"):
            _draw(column, context, name)
        column.separator()
        row = column.row(align=True)
        _draw(row, context, "seed")
        source = Choice(context.scene).source("use_animated_seed")
        row.prop(source.owner, source.name, icon_only=True, icon="TIME")
        _draw(column, context, "sampler")
        _draw(column, context, "light_threshold")


class BASICRT_RENDER_PT_viewport(_Panel, bpy.types.Panel):
    """How far viewports are refined."""

    bl_label = "Viewport"
    bl_parent_id = "BASICRT_RENDER_PT_sampling"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        _draw(column, context, "preview_samples")
        column.prop(settings_of(context.scene), "preview_pause")


class BASICRT_RENDER_PT_cycles(_Panel, bpy.types.Panel):
    """What is read from Cycles."""

    bl_label = "Cycles Settings"
    bl_parent_id = "BASICRT_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback: not without Cycles."""
        return super().poll(context) and has_cycles(context.scene)

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        column.prop(settings_of(context.scene), "use_cycles_settings")
        column.operator("basicrt.copy_cycles_settings")


class _DenoisingPanel(_Panel):
    """What the denoisers of finished pictures and of viewports have in common."""

    bl_label = "Denoise"
    bl_options: Any = {"DEFAULT_CLOSED"}
    kind = ""  # how names of settings begin

    def draw_header(self, context: Any) -> None:
        """Blender's callback."""
        source = Choice(context.scene).source(f"use_{self.kind}denoising")
        self.layout.prop(source.owner, source.name, text="")

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        chosen, column = Choice(context.scene), self.column()
        column.active = getattr(chosen, f"use_{self.kind}denoising")
        _draw(column, context, f"{self.kind}denoising_input_passes")
        row = column.row()
        row.active = getattr(chosen, f"{self.kind}denoising_input_passes") != "RGB"
        _draw(row, context, f"{self.kind}denoising_prefilter")
        _draw(column, context, f"{self.kind}denoising_quality")
        self.draw_more(column, context)
        if not is_installed():
            column.label(text="Open Image Denoise is not installed", icon="ERROR")

    def draw_more(self, column: Any, context: Any) -> None:
        """What only one of them has."""


class BASICRT_RENDER_PT_viewport_denoising(_DenoisingPanel, bpy.types.Panel):
    """How noise is taken out of viewports' pictures."""

    bl_parent_id = "BASICRT_RENDER_PT_viewport"
    kind = "preview_"

    def draw_more(self, column: Any, context: Any) -> None:
        """When it begins."""
        _draw(column, context, "preview_denoising_start_sample")


class BASICRT_RENDER_PT_denoising(_DenoisingPanel, bpy.types.Panel):
    """How noise is taken out of the finished picture."""

    bl_parent_id = "BASICRT_RENDER_PT_sampling"


class BASICRT_RENDER_PT_light_paths(_Panel, bpy.types.Panel):
    """How far light is followed."""

    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        _draw(column, context, "max_bounces")
        column.separator()
        for kind in ("diffuse", "glossy", "transmission", "volume", "transparent"):
            _draw(column, context, f"{kind}_bounces")


class BASICRT_RENDER_PT_clamping(_Panel, bpy.types.Panel):
    """Less noise for less light."""

    bl_label = "Clamping"
    bl_parent_id = "BASICRT_RENDER_PT_light_paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        _draw(column, context, "clamp_direct")
        _draw(column, context, "clamp_indirect")


class BASICRT_RENDER_PT_caustics(_Panel, bpy.types.Panel):
    """Which caustics there are."""

    bl_label = "Caustics"
    bl_parent_id = "BASICRT_RENDER_PT_light_paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        for name in ("blur_glossy", "caustics_reflective", "caustics_refractive"):
            _draw(column, context, name)


class BASICRT_RENDER_PT_film(_Panel, bpy.types.Panel):
    """What a pixel is."""

    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        _draw(column, context, "film_exposure")
        column.prop(context.scene.render, "film_transparent", text="Transparent")
        glass = column.column()
        glass.active = context.scene.render.film_transparent
        _draw(glass, context, "film_transparent_glass")
        row = glass.row()
        row.active = Choice(context.scene).film_transparent_glass
        _draw(row, context, "film_transparent_roughness")
        column.separator()
        _draw(column, context, "filter_type")
        row = column.row()
        row.active = Choice(context.scene).filter_type != "BOX"
        _draw(row, context, "filter_width")


class BASICRT_RENDER_PT_motion_blur(_Panel, bpy.types.Panel):
    """How long the shutter is open."""

    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        """Blender's callback."""
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        render = context.scene.render
        column.active = render.use_motion_blur
        column.prop(render, "motion_blur_position", text="Position")
        column.prop(render, "motion_blur_shutter")
        column.template_curve_mapping(render, "motion_blur_shutter_curve")


class BASICRT_RENDER_PT_performance(_Panel, bpy.types.Panel):
    """What changes the time, not the picture."""

    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        render = context.scene.render
        column.prop(render, "threads_mode")
        row = column.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")
        column.separator()
        column.prop(settings_of(context.scene), "tile_size")
        column.prop(settings_of(context.scene), "bvh_builder")


class BASICRT_RENDER_PT_warnings(_Panel, bpy.types.Panel):
    """What the last render could not draw as Blender means it."""

    bl_label = "Warnings"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        self.layout.prop(settings_of(context.scene), "fail_on_warnings")
        if not shown_warnings():
            self.layout.label(text="Nothing to tell of the last render", icon="CHECKMARK")
        # A label is one line, cut in its middle where it is too long; a letter is 7 pixels wide.
        width = context.region.width / (7 * context.preferences.system.ui_scale) - 8
        for text in shown_warnings():
            has_culprit = find_culprit(text) is not None
            room = max(int(width) - 5 * has_culprit, 10)
            row = self.layout.row()
            column = row.column(align=True)
            for index, line in enumerate(textwrap.wrap(text, room)):
                column.label(text=line, icon="BLANK1" if index else "ERROR")
            if has_culprit:
                button: Any = row.operator(
                    "basicrt.select_culprit", text="", icon="RESTRICT_SELECT_OFF"
                )
                button.warning = text


class BASICRT_VIEWLAYER_PT_passes(_Panel, bpy.types.Panel):
    """Which passes a view layer has."""

    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        view_layer = context.view_layer
        column = self.column()
        is_blurred = context.scene.render.use_motion_blur and view_layer.use_motion_blur
        for name, text in (
            ("z", "Depth"),
            ("mist", "Mist"),
            ("position", "Position"),
            ("normal", "Normal"),
            ("vector", "Vector"),
            ("uv", "UV"),
            ("object_index", "Object Index"),
            ("material_index", "Material Index"),
        ):
            row = column.row()
            row.active = name != "vector" or not is_blurred
            row.prop(view_layer, f"use_pass_{name}", text=text)
        for kind in ("Diffuse", "Glossy", "Transmission"):
            column = self.layout.column(heading=kind, align=True)
            for part in ("Direct", "Indirect", "Color"):
                column.prop(view_layer, f"use_pass_{kind.lower()}_{part.lower()}", text=part)
        column = self.layout.column(heading="Other", align=True)
        column.prop(view_layer, "use_pass_emit", text="Emission")
        column.prop(view_layer, "use_pass_environment", text="Environment")
        column.prop(view_layer, "use_pass_ambient_occlusion", text="Ambient Occlusion")
        b_cycles = getattr(view_layer, "cycles", None)
        for name, text in (
            ("use_pass_volume_direct", "Volume Direct"),
            ("use_pass_volume_indirect", "Volume Indirect"),
            ("use_pass_shadow_catcher", "Shadow Catcher"),
            ("pass_debug_sample_count", "Sample Count"),
            ("denoising_store_passes", "Denoising Data"),
        ):
            if hasattr(b_cycles, name):
                column.prop(b_cycles, name, text=text)
        column = self.layout.column(heading="Cryptomatte", align=True)
        for kind in ("Object", "Material", "Asset"):
            column.prop(view_layer, f"use_pass_cryptomatte_{kind.lower()}", text=kind)
        column.prop(view_layer, "pass_cryptomatte_depth", text="Levels")


class BASICRT_OBJECT_PT_ray_visibility(_Panel, bpy.types.Panel):
    """Which rays see an object."""

    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback."""
        kinds = {"MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT", "EMPTY"}
        return super().poll(context) and context.object is not None and context.object.type in kinds

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        column.prop(context.object, "visible_camera", text="Camera")
        if context.object.type != "LIGHT":
            for kind in ("diffuse", "glossy", "transmission", "shadow"):
                column.prop(context.object, f"visible_{kind}", text=kind.capitalize())
            column.prop(context.object, "is_shadow_catcher")
            column.prop(context.object, "is_holdout")


class _ViewportPanel(_Panel):
    """Among the settings of a viewport's shading, where that is the render."""

    bl_space_type: Any = "VIEW_3D"
    bl_region_type: Any = "HEADER"
    bl_context = ""
    bl_parent_id = "VIEW3D_PT_shading"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback."""
        return super().poll(context) and context.space_data.shading.type == "RENDERED"


class BASICRT_VIEW3D_PT_lighting(_ViewportPanel, bpy.types.Panel):
    """What lights a viewport."""

    bl_label = "Lighting"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        shading = context.space_data.shading
        column = self.layout.column()
        column.prop(shading, "use_scene_lights_render")
        column.prop(shading, "use_scene_world_render")
        if shading.use_scene_world_render:
            return
        row = column.row()
        row.scale_y = 0.6
        row.template_icon_view(shading, "studio_light", scale_popup=3)
        column.prop(shading, "studiolight_rotate_z", text="Rotation")
        column.prop(shading, "studiolight_intensity")
        column.prop(shading, "studiolight_background_alpha")


class BASICRT_VIEW3D_PT_render_pass(_ViewportPanel, bpy.types.Panel):
    """What a viewport shows."""

    bl_label = "Render Pass"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        self.layout.prop(context.space_data.shading.basicrt, "render_pass", text="")


# What each panorama_type has beside its name; Blender shows it for Cycles alone.
PANORAMA_PROPERTIES = {
    "EQUIRECTANGULAR": ("latitude_min", "latitude_max", "longitude_min", "longitude_max"),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
    "FISHEYE_LENS_POLYNOMIAL": (
        "fisheye_fov",
        *(f"fisheye_polynomial_k{power}" for power in range(5)),
    ),
    "CENTRAL_CYLINDRICAL": (
        "central_cylindrical_range_v_min",
        "central_cylindrical_range_v_max",
        "central_cylindrical_range_u_min",
        "central_cylindrical_range_u_max",
        "central_cylindrical_radius",
    ),
}


class BASICRT_CAMERA_PT_panorama(_Panel, bpy.types.Panel):
    """How a panoramic camera bends what it sees."""

    bl_label = "Panorama"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Blender's callback."""
        b_camera = getattr(context, "camera", None)
        return super().poll(context) and b_camera is not None and b_camera.type == "PANO"

    def draw(self, context: Any) -> None:
        """Blender's callback."""
        column = self.column()
        column.prop(context.camera, "panorama_type", text="Type")
        for name in PANORAMA_PROPERTIES.get(context.camera.panorama_type, ()):
            column.prop(context.camera, name)


_PANELS = (
    BASICRT_RENDER_PT_sampling,
    BASICRT_RENDER_PT_denoising,
    BASICRT_RENDER_PT_viewport,
    BASICRT_RENDER_PT_viewport_denoising,
    BASICRT_RENDER_PT_cycles,
    BASICRT_RENDER_PT_light_paths,
    BASICRT_RENDER_PT_clamping,
    BASICRT_RENDER_PT_caustics,
    BASICRT_RENDER_PT_film,
    BASICRT_RENDER_PT_motion_blur,
    BASICRT_RENDER_PT_performance,
    BASICRT_RENDER_PT_warnings,
    BASICRT_VIEWLAYER_PT_passes,
    BASICRT_OBJECT_PT_ray_visibility,
    BASICRT_CAMERA_PT_panorama,
    BASICRT_VIEW3D_PT_lighting,
    BASICRT_VIEW3D_PT_render_pass,
)

register, unregister = register_panels(_PANELS)
