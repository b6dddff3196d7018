# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's point clouds."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

import basicrt

from ..nodes import MeshData
from . import round_attributes
from .hashed import random_numbers

_RADIUS = 0.01  # metres, where Blender has none


def convert(b_points: Any, asked: Collection[MeshData] = ()) -> basicrt.PointCloud | None:
    """Of bpy.types.PointCloud, None where there are no points."""
    positions = round_attributes.read(b_points, "position", 3)
    if positions is None or len(positions) == 0:
        return None
    radii = round_attributes.read(b_points, "radius", 1)
    if radii is None:
        radii = np.full(len(positions), _RADIUS, np.float32)
    return basicrt.PointCloud(
        positions,
        np.maximum(radii, 0.0),
        randoms=random_numbers(len(positions)),
        attributes=round_attributes.convert(b_points, asked),
    )
