# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Sky Texture."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import basicrt

from .hosek_wilkie import CLEAREST, brightness_over_preetham

Sky = basicrt.PreethamSky | basicrt.SingleScatteringSky | basicrt.MultipleScatteringSky

_SMALLEST_SUN = 0.0005  # radians; Cycles makes no sun smaller


def convert_sky(node: Any, warn: Callable[[str], None]) -> tuple[Sky, tuple[float, float, float]]:
    """The sky of a Sky Texture, and what it is multiplied by.

    Another model stands in for one that there is not, with a warning.
    """
    sky = _sky_of(node, warn)
    if node.sky_type != "HOSEK_WILKIE":
        return sky, (1.0, 1.0, 1.0)
    elevation, _rotation = _sun_place(node)
    return sky, brightness_over_preetham(node.turbidity, elevation, node.ground_albedo)


def _sky_of(node: Any, warn: Callable[[str], None]) -> Sky:
    match node.sky_type:
        case "PREETHAM":
            return _preetham(node, node.turbidity)
        case "NISHITA" | "SINGLE_SCATTERING":
            return basicrt.SingleScatteringSky(**_sun_and_air(node))
        case "MULTIPLE_SCATTERING":
            return basicrt.MultipleScatteringSky(**_sun_and_air(node))
        case "HOSEK_WILKIE":
            warn("Hosek / Wilkie is not supported: Preetham's sky instead, as bright")
            return _preetham(node, max(node.turbidity, CLEAREST))
        case other:
            title = node.bl_rna.properties["sky_type"].enum_items[other].name
            warn(f"{title} is not supported: Preetham's sky instead")
            return _preetham(node, node.turbidity)


def _preetham(node: Any, turbidity: float) -> basicrt.PreethamSky:
    elevation, rotation = _sun_place(node)
    return basicrt.PreethamSky(sun_elevation=elevation, sun_rotation=rotation, turbidity=turbidity)


def _sun_place(node: Any) -> tuple[float, float]:
    """Elevation and rotation of the sun, radians."""
    x, y, z = node.sun_direction
    return math.asin(min(max(z, -1.0), 1.0)), math.atan2(x, y)


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
