# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's and a view layer's render settings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

import basicrt

from .. import compat
from ..properties import settings_of
from ..properties.choice import Choice
from ..report import Report
from . import aovs, denoising, light_groups
from .camera import resolution
from .motion import shutter_curve

# Native pass -> the view layer's switch; Combined has none, it is always made.
_PASS_SWITCHES = {
    "Depth": "use_pass_z",
    "Normal": "use_pass_normal",
    "Mist": "use_pass_mist",
    "Position": "use_pass_position",
    "Vector": "use_pass_vector",
    "UV": "use_pass_uv",
    "Object Index": "use_pass_object_index",
    "Material Index": "use_pass_material_index",
    "Diffuse Direct": "use_pass_diffuse_direct",
    "Diffuse Indirect": "use_pass_diffuse_indirect",
    "Diffuse Color": "use_pass_diffuse_color",
    "Glossy Direct": "use_pass_glossy_direct",
    "Glossy Indirect": "use_pass_glossy_indirect",
    "Glossy Color": "use_pass_glossy_color",
    "Transmission Direct": "use_pass_transmission_direct",
    "Transmission Indirect": "use_pass_transmission_indirect",
    "Transmission Color": "use_pass_transmission_color",
    "Emission": "use_pass_emit",
    "Environment": "use_pass_environment",
    "Ambient Occlusion": "use_pass_ambient_occlusion",
}
# Switches that Cycles adds to view layers: not there where it is switched off.
_CYCLES_PASS_SWITCHES = {
    "Volume Direct": "use_pass_volume_direct",
    "Volume Indirect": "use_pass_volume_indirect",
    "Shadow Catcher": "use_pass_shadow_catcher",
    "Debug Sample Count": "pass_debug_sample_count",
    "Denoising Normal": "denoising_store_passes",
    "Denoising Albedo": "denoising_store_passes",
    "Denoising Depth": "denoising_store_passes",
    "Denoising Specular Albedo": "denoising_store_passes",
    "Denoising Roughness": "denoising_store_passes",
}
_MATTE_SWITCHES = {
    "CryptoObject": "use_pass_cryptomatte_object",
    "CryptoMaterial": "use_pass_cryptomatte_material",
    "CryptoAsset": "use_pass_cryptomatte_asset",
}


# Of a pixel: where there is no limit.
MOST_SAMPLES = 1 << 24


@dataclass(frozen=True)
class Border:
    """The pixels that are rendered: lower left corner and size."""

    x: int
    y: int
    width: int
    height: int


def border(b_render: bpy.types.RenderSettings) -> Border:
    """The render border in pixels as Blender rounds it, or the whole picture."""
    width, height = resolution(b_render)
    if not b_render.use_border:
        return Border(0, 0, width, height)
    left, right = int(b_render.border_min_x * width), int(b_render.border_max_x * width)
    lower, upper = int(b_render.border_min_y * height), int(b_render.border_max_y * height)
    return Border(left, lower, right - left, upper - lower)


def enabled_passes(b_view_layer: bpy.types.ViewLayer) -> list[basicrt.PassInfo]:
    """The rows of the table of passes that a view layer asks for."""
    named = _named_passes(b_view_layer)
    return [
        info
        for info in basicrt.passes()
        if info.name in named or _is_enabled(info.name, b_view_layer)
    ]


def _named_passes(b_view_layer: bpy.types.ViewLayer) -> dict[str, str]:
    """Users' names of the passes that have numbers."""
    return light_groups.pass_names(b_view_layer) | aovs.pass_names(b_view_layer)


def pass_names(b_view_layer: bpy.types.ViewLayer) -> dict[str, str]:
    """What Blender calls the passes that a view layer asks for, by the core's names."""
    named = _named_passes(b_view_layer)
    return {
        info.name: named.get(info.name, compat.pass_name(info.name))
        for info in enabled_passes(b_view_layer)
    }


def _is_enabled(name: str, b_view_layer: Any) -> bool:
    if name in _PASS_SWITCHES:
        return bool(getattr(b_view_layer, _PASS_SWITCHES[name]))
    if name in _CYCLES_PASS_SWITCHES:
        b_cycles = getattr(b_view_layer, "cycles", None)
        is_on = bool(getattr(b_cycles, _CYCLES_PASS_SWITCHES[name], False))
        return is_on and compat.has_pass(name)
    layer, number = name[:-2], name[-2:]
    if layer in _MATTE_SWITCHES:  # two levels in each pass
        is_deep_enough = 2 * int(number) < b_view_layer.pass_cryptomatte_depth
        return bool(getattr(b_view_layer, _MATTE_SWITCHES[layer])) and is_deep_enough
    return name == "Combined"


def _convert_world(b_world: bpy.types.World | None, settings: basicrt.RenderSettings) -> None:
    """What a world says of passes. Blender's falloffs are powers."""
    if b_world is None:
        return
    mist = b_world.mist_settings
    falloffs = {"QUADRATIC": 2.0, "LINEAR": 1.0, "INVERSE_QUADRATIC": 0.5}
    settings.mist_start, settings.mist_depth = mist.start, mist.depth
    settings.mist_falloff = falloffs[mist.falloff]
    settings.ao_distance = b_world.light_settings.distance


def seed_of_frame(seed: int, b_scene: bpy.types.Scene) -> int:
    """Another one in each frame where the user wants that."""
    is_animated = Choice(b_scene).use_animated_seed
    return seed + (b_scene.frame_current << 32) if is_animated else seed


def _convert_filter(chosen: Choice, settings: basicrt.RenderSettings) -> None:
    """Blender's width is half of the Blackman-Harris window, and 4 standard deviations of the Gaussian."""
    width = chosen.filter_width
    settings.filter_type = chosen.filter_type.lower()
    settings.filter_radius = width
    if chosen.filter_type == "BOX":
        settings.filter_radius = 0.5
    elif chosen.filter_type == "GAUSSIAN":
        settings.filter_radius, settings.filter_falloff = 1.5 * width, 8.0 / width**2


def convert(
    b_scene: bpy.types.Scene,
    b_view_layer: bpy.types.ViewLayer,
    settings: basicrt.RenderSettings,
    report: Report,
) -> None:
    """Fill in `settings`."""
    b_render = b_scene.render
    own, chosen = settings_of(b_scene), Choice(b_scene)
    rectangle = border(b_render)
    settings.width, settings.height = resolution(b_render)
    settings.border_x, settings.border_y = rectangle.x, rectangle.y
    settings.border_width, settings.border_height = rectangle.width, rectangle.height

    settings.samples = b_view_layer.samples or chosen.samples
    settings.seed = seed_of_frame(chosen.seed, b_scene)
    settings.adaptive_threshold = chosen.adaptive_threshold
    settings.adaptive_min_samples = chosen.adaptive_min_samples
    settings.time_limit = chosen.time_limit
    settings.light_threshold = chosen.light_threshold
    settings.sampler = own.sampler.lower()
    settings.max_bounces = chosen.max_bounces
    settings.diffuse_bounces = chosen.diffuse_bounces
    settings.glossy_bounces = chosen.glossy_bounces
    settings.transmission_bounces = chosen.transmission_bounces
    settings.volume_bounces = chosen.volume_bounces
    settings.transparent_bounces = chosen.transparent_bounces
    settings.clamp_direct, settings.clamp_indirect = chosen.clamp_direct, chosen.clamp_indirect
    settings.blur_glossy = chosen.blur_glossy
    settings.caustics_reflective = chosen.caustics_reflective
    settings.caustics_refractive = chosen.caustics_refractive
    settings.bvh_builder = own.bvh_builder.lower()

    _convert_filter(chosen, settings)
    settings.film_transparent_glass = chosen.film_transparent_glass
    # An alpha, and a hair more: what is as rough as the threshold counts.
    settings.film_transparent_roughness = min(chosen.film_transparent_roughness**2 * 1.00001, 1.0)
    settings.exposure = chosen.film_exposure
    settings.background_vectors = compat.has_background_vectors()
    settings.shutter_curve = shutter_curve(b_render) if b_render.use_motion_blur else []
    settings.film_transparent = b_render.film_transparent
    _convert_world(compat.view_layer_world(b_scene, b_view_layer), settings)
    asked = [info.name for info in enabled_passes(b_view_layer)]
    denoised = denoising.convert(b_scene, b_view_layer)
    settings.passes = list(dict.fromkeys((*asked, *(denoised.passes if denoised else ()))))

    item = f'scene "{b_scene.name}"'
    if b_render.use_multiview:
        report.warn(item, "stereoscopy is not supported: every view is the same")
