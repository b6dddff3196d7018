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


def _bounces(name: str, default: int, description: str) -> Any:
    """A property that counts bounces."""
    make: Any = IntProperty
    return make(name=name, description=description, default=default, min=0, max=1024)


class BasicRTRenderSettings(bpy.types.PropertyGroup):
    """How BasicRT renders a scene. Read it through `Choice`, which knows when Cycles' values count."""

    if TYPE_CHECKING:
        use_cycles_settings: bool
        samples: int
        seed: int
        use_animated_seed: bool
        sampler: str
        max_bounces: int
        diffuse_bounces: int
        glossy_bounces: int
        transmission_bounces: int
        transparent_bounces: int
        filter_type: str
        filter_width: float
        film_exposure: float
        tile_size: int
        bvh_builder: str
    else:
        use_cycles_settings: BoolProperty(
            name="Use Cycles Settings",
            description="Read every setting that Cycles has too from Cycles. Without it, only those "
            "that were changed for Cycles and never for BasicRT",
            default=False,
        )
        samples: IntProperty(
            name="Samples",
            description="Paths traced for each pixel; twice the noise needs a quarter of them",
            default=128,
            min=1,
            max=1 << 24,
            soft_max=4096,
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
        transparent_bounces: _bounces(
            "Transparent", 8, "Most transparent surfaces that a ray passes straight through"
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
