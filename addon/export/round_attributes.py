# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays and attributes of Blender's curves and point clouds."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..nodes import MeshData, Part, Source
from .attributes import Converted, values_of

Floats = NDArray[np.float32]

_DOMAINS = {"POINT": "vertex", "CURVE": "face"}


def read(b_data: Any, name: str, width: int) -> Floats | None:
    """(N, width), or (N,) where the width is 1, of an attribute of floats; None where it isn't there."""
    b_attribute = b_data.attributes.get(name)
    members = {1: ("FLOAT", "value"), 2: ("FLOAT2", "vector"), 3: ("FLOAT_VECTOR", "vector")}
    data_type, member = members[width]
    if b_attribute is None or b_attribute.data_type != data_type:
        return None
    values: Floats = np.zeros(len(b_attribute.data) * width, np.float32)
    b_attribute.data.foreach_get(member, values)
    values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
    return values if width == 1 else values.reshape(-1, width)


def convert(b_data: Any, asked: Collection[MeshData]) -> list[Converted]:
    """Those that materials ask for."""
    found = []
    for data in sorted(asked):
        b_attribute = b_data.attributes.get(data.name) if data.name else None
        has_part = data.part in (Part.VECTOR, Part.MEAN, Part.ALPHA)
        if b_attribute is None or data.source == Source.UV or not has_part:
            continue
        values = values_of(b_attribute, data.part)
        if values is not None and b_attribute.domain in _DOMAINS:
            found.append((data.exported_name, _DOMAINS[b_attribute.domain], values))
    return found
