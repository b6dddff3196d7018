# SPDX-License-Identifier: GPL-3.0-or-later
"""The render settings kept in each scene as `scene.basicrt`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

FILTERS = (
    ("BLACKMAN_HARRIS", "Blackman-Harris", "Smooth, hardly any aliasing; Cycles' default"),
    ("GAUSSIAN", "Gaussian", "Smooth"),
    ("TENT", "Tent", "Falls linearly"),
    ("MITCHELL", "Mitchell-Netravali", "Sharp, with negative lobes"),
    ("BOX", "Box", "A pixel is the mean over its own square; the width is one pixel"),
)
SAMPLERS = (
    ("SOBOL", "Sobol", "A pixel's samples are spread evenly: less noise, least at powers of two"),
    ("INDEPENDENT", "Independent", "Each sample is random by itself; for comparisons"),
)
BVH_BUILDERS = (
    ("BINNED_SAH", "Binned SAH", "Trees that are fast to trace"),
    (
        "SPLIT_SAH",
        "Split SAH",
        "Slower to build; faster to trace where long slanted triangles lie among small ones",
    ),
    ("MEDIAN", "Median Split", "The reference: simple, slower to trace"),
)
DENOISING_INPUTS = (
    ("RGB", "None", "The denoiser sees the picture only"),
    ("RGB_ALBEDO", "Albedo", "It sees the colours of surfaces too"),
    (
        "RGB_ALBEDO_NORMAL",
        "Albedo and Normal",
        "It sees the colours and directions of surfaces too",
    ),
)
DENOISING_PREFILTERS = (
    ("NONE", "None", "Albedo and normal are taken as they are, for ones without noise"),
    ("FAST", "Fast", "Their noise is taken away together with the picture's"),
    ("ACCURATE", "Accurate", "Their noise is taken away first: the best, and the slowest"),
)
BAKE_TYPES = (
    ("COMBINED", "Combined", "All light that leaves the surface"),
    ("AO", "Ambient Occlusion", "How open the surface is to light from everywhere"),
    ("SHADOW", "Shadow", "The share of light that other objects leave"),
    ("POSITION", "Position", "Where the surface is in the world"),
    ("NORMAL", "Normal", "Where it faces, bumps included"),
    ("UV", "UV", "Its texture coordinates, those that are active for rendering"),
    ("ROUGHNESS", "Roughness", "How rough its reflections are"),
    ("EMIT", "Emission", "What it emits"),
    ("ENVIRONMENT", "Environment", "The world, seen from the origin towards each place"),
    ("DIFFUSE", "Diffuse", "Light that it reflects diffusely"),
    ("GLOSSY", "Glossy", "Light that it reflects as a gloss"),
    ("TRANSMISSION", "Transmission", "Light that it transmits"),
)
DENOISING_QUALITIES = (
    ("HIGH", "High", "For final pictures"),
    ("BALANCED", "Balanced", "Faster, a little less exact"),
    ("FAST", "Fast", "The fastest"),
)


def _bounces(name: str, default: int, description: str) -> Any:
    """A property that counts bounces."""
    make: Any = IntProperty
    return make(name=name, description=description, default=default, min=0, max=1024)


class BasicRTRenderSettings(bpy.types.PropertyGroup):
    """How BasicRT renders a scene. Read it through `Choice`, which knows when Cycles' values count."""

    if TYPE_CHECKING:
        use_cycles_settings: bool
        samples: int
        preview_samples: int
        preview_pause: bool
        seed: int
        use_animated_seed: bool
        adaptive_threshold: float
        adaptive_min_samples: int
        time_limit: float
        light_threshold: float
        sampler: str
        max_bounces: int
        diffuse_bounces: int
        glossy_bounces: int
        transmission_bounces: int
        volume_bounces: int
        transparent_bounces: int
        clamp_direct: float
        clamp_indirect: float
        blur_glossy: float
        caustics_reflective: bool
        caustics_refractive: bool
        filter_type: str
        filter_width: float
        film_exposure: float
        film_transparent_glass: bool
        film_transparent_roughness: float
        use_denoising: bool
        denoising_input_passes: str
        denoising_prefilter: str
        denoising_quality: str
        use_preview_denoising: bool
        preview_denoising_input_passes: str
        preview_denoising_prefilter: str
        preview_denoising_quality: str
        preview_denoising_start_sample: int
        bake_type: str
        tile_size: int
        bvh_builder: str
        fail_on_warnings: bool
    else:
        use_cycles_settings: BoolProperty(
            name="Use Cycles Settings",
            description="Read every setting that Cycles has too from Cycles. Without it, only those "
            "that were changed for Cycles and never for BasicRT",
            default=False,
        )
        samples: IntProperty(
            name="Samples",
            description="Paths traced for each pixel; twice the noise needs a quarter of them. With a "
            "noise threshold or a time limit, the most of them",
            default=128,
            min=1,
            max=1 << 24,
            soft_max=4096,
        )
        preview_samples: IntProperty(
            name="Viewport Samples",
            description="Paths traced for each pixel of a viewport before it comes to rest; 0 goes on "
            "for ever",
            default=128,
            min=0,
            max=1 << 24,
            soft_max=4096,
        )
        preview_pause: BoolProperty(
            name="Pause Viewport",
            description="Viewports show changes, but take no more samples",
            default=False,
        )
        seed: IntProperty(
            name="Seed",
            description="Another seed gives other noise, the same seed the same picture",
            default=0,
            min=0,
        )
        use_animated_seed: BoolProperty(
            name="Animated Seed",
            description="Other noise in each frame",
            default=False,
        )
        adaptive_threshold: FloatProperty(
            name="Noise Threshold",
            description="A pixel gets no more samples where its noise is below this, relative to the "
            "root of its brightness. 0 gives every pixel all samples",
            default=0.0,
            min=0.0,
            max=1.0,
            soft_max=0.1,
            step=0.1,
            precision=4,
        )
        adaptive_min_samples: IntProperty(
            name="Min Samples",
            description="Samples that every pixel gets before its noise is looked at. 0 chooses by "
            "the noise threshold",
            default=0,
            min=0,
            max=1 << 24,
            soft_max=4096,
        )
        time_limit: FloatProperty(
            name="Time Limit",
            description="Seconds after which no more samples are started, without exporting and "
            "building trees. 0 is no limit",
            default=0.0,
            min=0.0,
            soft_max=3600.0,
            step=100,
            unit="TIME_ABSOLUTE",
        )
        light_threshold: FloatProperty(
            name="Light Threshold",
            description="Light that would add less than this is looked at by chance only, in "
            "proportion: saves time where there are many faint lights, for a little more noise. 0 "
            "looks at all",
            default=0.0,
            min=0.0,
            max=1.0,
            soft_max=0.1,
            precision=4,
        )
        sampler: EnumProperty(
            name="Sampler",
            description="How a pixel's samples are spread over all that they may meet",
            items=SAMPLERS,
            default="SOBOL",
        )
        max_bounces: _bounces("Total", 12, "Most times a path is scattered, whatever it meets")
        diffuse_bounces: _bounces("Diffuse", 4, "Most diffuse reflections of a path")
        glossy_bounces: _bounces("Glossy", 4, "Most glossy reflections of a path")
        transmission_bounces: _bounces("Transmission", 12, "Most refractions of a path")
        volume_bounces: _bounces(
            "Volume", 0, "Most scatterings of a path in volumes after the first"
        )
        transparent_bounces: _bounces(
            "Transparent", 8, "Most transparent surfaces that a ray passes straight through"
        )
        clamp_direct: FloatProperty(
            name="Direct Light",
            description="The most that a sample may add of light that surfaces in view get from "
            "lights, as the mean of red, green and blue. Takes away fireflies and light. 0 is no limit",
            default=0.0,
            min=0.0,
            max=1e8,
            soft_max=100.0,
        )
        clamp_indirect: FloatProperty(
            name="Indirect Light",
            description="The most that a sample may add of light that was scattered more often, as "
            "the mean of red, green and blue. Takes away fireflies and light. 0 is no limit",
            default=0.0,
            min=0.0,
            max=1e8,
            soft_max=100.0,
        )
        blur_glossy: FloatProperty(
            name="Filter Glossy",
            description="Mirrors and glass that are seen by way of rough or diffuse surfaces are "
            "made rougher: caustics blur and have less noise. 0 leaves them as they are",
            default=0.0,
            min=0.0,
            max=10.0,
        )
        caustics_reflective: BoolProperty(
            name="Reflective Caustics",
            description="Light that reaches diffuse surfaces by way of glossy reflection",
            default=True,
        )
        caustics_refractive: BoolProperty(
            name="Refractive Caustics",
            description="Light that reaches diffuse surfaces through glass",
            default=True,
        )
        film_transparent_glass: BoolProperty(
            name="Transparent Glass",
            description="With a transparent film, what is seen of the background through glass is "
            "transparent too",
            default=False,
        )
        film_transparent_roughness: FloatProperty(
            name="Roughness Threshold",
            description="Glass that is rougher stays opaque",
            default=0.1,
            min=0.0,
            max=1.0,
        )
        filter_type: EnumProperty(
            name="Pixel Filter",
            description="How samples near a pixel make up its colour",
            items=FILTERS,
            default="BLACKMAN_HARRIS",
        )
        filter_width: FloatProperty(
            name="Width",
            description="How far the filter reaches from the pixel's centre, in pixels. Wider is "
            "softer",
            default=1.5,
            min=0.01,
            max=10.0,
        )
        film_exposure: FloatProperty(
            name="Exposure",
            description="Brightness of the rendered picture itself: radiance is multiplied by it",
            default=1.0,
            min=0.0,
            soft_max=10.0,
        )
        use_denoising: BoolProperty(
            name="Denoise",
            description="Take the noise out of the finished picture with Intel's Open Image Denoise, "
            "which must be installed. The noisy one is kept as the pass Noisy Image",
            default=False,
        )
        denoising_input_passes: EnumProperty(
            name="Passes",
            description="What the denoiser sees beside the picture, so as to tell details from noise",
            items=DENOISING_INPUTS,
            default="RGB_ALBEDO_NORMAL",
        )
        denoising_prefilter: EnumProperty(
            name="Prefilter",
            description="What becomes of the noise in albedo and normal",
            items=DENOISING_PREFILTERS,
            default="ACCURATE",
        )
        denoising_quality: EnumProperty(
            name="Quality",
            description="How much time the denoiser takes",
            items=DENOISING_QUALITIES,
            default="HIGH",
        )
        use_preview_denoising: BoolProperty(
            name="Viewport Denoise",
            description="Take the noise out of viewports' pictures with Intel's Open Image Denoise, "
            "which must be installed: behind the scenes, each time that they have twice as many "
            "samples, and when they come to rest",
            default=False,
        )
        preview_denoising_input_passes: EnumProperty(
            name="Passes",
            description="What the denoiser of viewports sees beside the picture",
            items=DENOISING_INPUTS,
            default="RGB_ALBEDO",
        )
        preview_denoising_prefilter: EnumProperty(
            name="Prefilter",
            description="What becomes of the noise in albedo and normal in viewports",
            items=DENOISING_PREFILTERS,
            default="FAST",
        )
        preview_denoising_quality: EnumProperty(
            name="Quality",
            description="How much time the denoiser of viewports takes",
            items=DENOISING_QUALITIES,
            default="BALANCED",
        )
        preview_denoising_start_sample: IntProperty(
            name="Start Sample",
            description="Samples that each pixel of a viewport has when it is denoised for the first "
            "time. With fewer, only the picture that comes to rest is",
            default=1,
            min=0,
            max=1 << 24,
            soft_max=4096,
        )
        bake_type: EnumProperty(
            name="Bake Type",
            description="What is baked",
            items=BAKE_TYPES,
            default="COMBINED",
        )
        tile_size: IntProperty(
            name="Tile Size",
            description="Width and height in pixels of the squares that threads work on. The "
            "picture does not depend on it",
            default=64,
            min=8,
            max=4096,
        )
        bvh_builder: EnumProperty(
            name="Tree Builder",
            description="How the trees that rays are traced through are built. The picture does "
            "not depend on it",
            items=BVH_BUILDERS,
            default="BINNED_SAH",
        )
        fail_on_warnings: BoolProperty(
            name="Fail on Warnings",
            description="Make no picture, final or baked, of what can't be drawn as Blender means it",
            default=False,
        )
