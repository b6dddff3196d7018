# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender wants to be baked: the pixels of an image with their places on a mesh, and what of them."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import basicrt

from .. import compat

Floats = NDArray[np.float32]


def convert_plan(b_scene: bpy.types.Scene, pass_type: str, pass_filter: int) -> basicrt.BakePlan:
    """Of Blender's kind of bake, and the bits of what it is to contain."""
    b_bake: Any = b_scene.render.bake
    bits = {
        item.identifier: item.value for item in b_bake.bl_rna.properties["pass_filter"].enum_items
    }

    def contains(name: str) -> bool:
        return bool(pass_filter & bits[name])

    return basicrt.BakePlan(
        pass_type.lower(),
        direct=contains("DIRECT"),
        indirect=contains("INDIRECT"),
        color=contains("COLOR"),
        diffuse=contains("DIFFUSE"),
        glossy=contains("GLOSSY"),
        transmission=contains("TRANSMISSION"),
        emission=contains("EMIT"),
        from_camera=b_bake.view_from == "ACTIVE_CAMERA" and b_scene.camera is not None,
    )


def convert_target(b_layer: Any, width: int, height: int, instance: int) -> basicrt.BakeTarget:
    """The pixels of a layer of Blender's bake result, on an instance of the scene.

    Blender's barycentrics are the shares of a triangle's first and second corner.
    """
    pixels = compat.bake_pixels(b_layer, width, height)
    first, second = pixels.barycentrics[..., 0], pixels.barycentrics[..., 1]
    # Of the first and the second corner's share: each to the right and upwards.
    first_change, second_change = pixels.changes[..., 0:2], pixels.changes[..., 2:4]
    changes = np.stack([second_change, -first_change - second_change], axis=-1)
    return basicrt.BakeTarget(
        instance,
        pixels.triangles,
        np.stack([second, 1.0 - first - second], axis=-1),
        changes=np.nan_to_num(changes, posinf=0.0, neginf=0.0),
        seeds=pixels.seeds,
    )


def write_picture(b_layer: Any, picture: Floats) -> None:
    """(height, width, 4), into the result."""
    b_pass = b_layer.passes["Combined"]
    b_pass.rect.foreach_set(np.ascontiguousarray(picture[..., : b_pass.channels]).ravel())
