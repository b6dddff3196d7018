# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Sky Texture."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import basicrt

Sky = basicrt.PreethamSky | basicrt.SingleScatteringSky | basicrt.MultipleScatteringSky

_SMALLEST_SUN = 0.0005  # radians; Cycles makes no sun smaller


def convert_sky(node: Any, warn: Callable[[str], None]) -> Sky:
    """The sky of a Sky Texture; another model in place of one that there is not, with a warning."""
    match node.sky_type:
        case "PREETHAM":
            return _preetham(node)
        case "NISHITA" | "SINGLE_SCATTERING":
            return basicrt.SingleScatteringSky(**_sun_and_air(node))
        case "MULTIPLE_SCATTERING":
            return basicrt.MultipleScatteringSky(**_sun_and_air(node))
        case other:
            title = node.bl_rna.properties["sky_type"].enum_items[other].name
            warn(f"{title} is not supported: Preetham's sky instead")
            return _preetham(node)


def _preetham(node: Any) -> basicrt.PreethamSky:
    x, y, z = node.sun_direction
    return basicrt.PreethamSky(
        sun_elevation=math.asin(min(max(z, -1.0), 1.0)),
        sun_rotation=math.atan2(x, y),
        turbidity=node.turbidity,
    )


def _sun_and_air(node: Any) -> dict[str, Any]:
    has_aerosol = hasattr(node, "aerosol_density")  # called dust before 5.0
    return {
        "sun_elevation": node.sun_elevation,
        "sun_rotation": node.sun_rotation,
        "sun_disc": node.sun_disc,
        "sun_size": max(node.sun_size, _SMALLEST_SUN),
        "sun_intensity": node.sun_intensity,
        "altitude": node.altitude,
        "air_density": node.air_density,
        "aerosol_density": node.aerosol_density if has_aerosol else node.dust_density,
        "ozone_density": node.ozone_density,
    }
