# SPDX-License-Identifier: GPL-3.0-or-later
"""Which kinds of rays see an object: Blender's Ray Visibility."""

from __future__ import annotations

import bpy

import basicrt

_KINDS = {
    "visible_camera": basicrt.RayKind.CAMERA,
    "visible_diffuse": basicrt.RayKind.DIFFUSE,
    "visible_glossy": basicrt.RayKind.GLOSSY,
    "visible_transmission": basicrt.RayKind.TRANSMISSION,
    "visible_volume_scatter": basicrt.RayKind.VOLUME,
    "visible_shadow": basicrt.RayKind.SHADOW,
}


def object_visibility(b_object: bpy.types.Object) -> basicrt.RayKind:
    """The kinds of rays that see an object, from its own switches."""
    visibility = basicrt.RayKind.ALL
    for name, kind in _KINDS.items():
        if not getattr(b_object, name):
            visibility &= ~kind
    return visibility
