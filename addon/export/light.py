# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lamps: watts and strengths become radiometric units."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

import basicrt

from .. import compat
from ..nodes import LampObject, Textures, emission_of
from ..report import Report

Color = tuple[float, float, float]
Light = basicrt.PointLight | basicrt.SpotLight | basicrt.SunLight | basicrt.AreaLight


def convert(
    b_object: bpy.types.Object, matrix: Matrix, random: float, report: Report, textures: Textures
) -> tuple[Light, basicrt.Material | None] | None:
    """The lamp of an evaluated object placed by `matrix`; None where it can't shine.

    With a material where its light varies, for the caller to put into the scene and to name in the lamp. `random` is
    what the Object Info node says.
    """
    b_light: Any = b_object.data
    item = f'light "{b_object.name}"'
    if compat.is_portal(b_light):
        report.warn(
            item, "a portal gives no light and only guides Cycles' sampling: it is left out"
        )
        return None
    strength = compat.light_strength(b_light)
    red, green, blue, alpha = b_object.color
    lamp = LampObject(b_light.type, (red, green, blue), alpha, b_object.pass_index, random)
    emission = emission_of(b_light, report, textures, lamp)
    material = None
    if emission is not None:
        strength = _times(strength, emission.radiance)
        material = emission.material
    strength = _positive(strength)
    light = _CONVERTERS[b_light.type](b_light, matrix, strength)
    if light is None:
        report.warn(item, "has no size, and so no light")
        return None
    light.camera_visible = b_object.visible_camera
    light.diffuse_visible = b_object.visible_diffuse
    light.glossy_visible = b_object.visible_glossy
    light.transmission_visible = b_object.visible_transmission
    light.volume_visible = b_object.visible_volume_scatter
    light.casts_shadows = b_light.use_shadow
    light.max_bounces = compat.light_max_bounces(b_light)
    if material is not None:
        light.object_transform = _object_transform(matrix)
    return light, material


def _object_transform(matrix: Matrix) -> np.ndarray:
    """What the lamp's nodes take for the object's; without its scale where that leaves no way back."""
    full = np.array(matrix, np.float32)
    if np.linalg.det(full[:3, :3]) != 0.0:
        return full
    location, rotation, _scale = matrix.decompose()
    return np.array(Matrix.LocRotScale(location, rotation, None), np.float32)


def _intensity(b_light: Any, strength: Color) -> Color:
    """W / sr. Blender spreads a lamp's watts over the sphere; the cone of a spot only cuts it."""
    if compat.is_light_normalized(b_light):
        return _scaled(strength, 1.0 / (4.0 * math.pi))
    radius = b_light.shadow_soft_size
    # Unnormalised, the radiance of the lamp's surface is strength / pi whatever its size.
    return _scaled(strength, radius * radius if radius > 0.0 else 0.25)


def _point(b_light: Any, matrix: Matrix, strength: Color) -> Light:
    position: Any = matrix.translation
    return basicrt.PointLight(
        position=tuple(position),
        intensity=_intensity(b_light, strength),
        radius=b_light.shadow_soft_size,
        soft=b_light.use_soft_falloff,
    )


def _spot(b_light: Any, matrix: Matrix, strength: Color) -> Light:
    return basicrt.SpotLight(
        transform=np.array(matrix, np.float32),
        intensity=_intensity(b_light, strength),
        radius=b_light.shadow_soft_size,
        soft=b_light.use_soft_falloff,
        angle=b_light.spot_size,
        blend=b_light.spot_blend,
    )


def _sun(b_light: Any, matrix: Matrix, strength: Color) -> Light:
    direction: Any = -matrix.col[2].to_3d().normalized()
    angle = b_light.angle
    if not compat.is_light_normalized(b_light) and angle > 0.0:
        # Unnormalised, the strength is the radiance of the disc.
        strength = _scaled(strength, math.pi * math.sin(0.5 * angle) ** 2)
    return basicrt.SunLight(direction=tuple(direction), irradiance=strength, angle=angle)


def _area(b_light: Any, matrix: Matrix, strength: Color) -> Light | None:
    is_ellipse = b_light.shape in ("DISK", "ELLIPSE")
    size_x = b_light.size
    size_y = b_light.size_y if b_light.shape in ("RECTANGLE", "ELLIPSE") else size_x
    axis_x, axis_y, axis_z = (matrix.col[i].to_3d() for i in range(3))
    area = axis_x.length * size_x * axis_y.length * size_y * (math.pi / 4 if is_ellipse else 1.0)
    if not area > 0.0 or axis_z.length == 0.0:
        return None
    if compat.is_light_normalized(b_light):
        strength = _scaled(strength, 1.0 / area)
    placed = matrix @ Matrix.Diagonal((size_x, size_y, 1.0 / axis_z.length, 1.0))
    return basicrt.AreaLight(
        transform=np.array(placed, np.float32),
        radiance=_scaled(strength, 1.0 / math.pi),
        ellipse=is_ellipse,
        spread=b_light.spread,
    )


_CONVERTERS = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}


def _scaled(color: Color, factor: float) -> Color:
    return color[0] * factor, color[1] * factor, color[2] * factor


def _times(a: Color, b: Color) -> Color:
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]


def _positive(color: Color) -> Color:
    return max(color[0], 0.0), max(color[1], 0.0), max(color[2], 0.0)
