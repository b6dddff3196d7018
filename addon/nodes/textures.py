# SPDX-License-Identifier: GPL-3.0-or-later
"""The texture nodes: each function makes a texture of one."""

from __future__ import annotations

from typing import Any

import numpy as np

import basicrt

from .coordinates import Coordinates, coordinates_at
from .images import MISSING
from .node_view import NodeView, texture

INTERPOLATIONS = {"Linear": "linear", "Closest": "closest", "Cubic": "cubic", "Smart": "cubic"}
_EXTENSIONS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}


@texture("ShaderNodeTexImage")
def image_texture(view: NodeView) -> int:
    """A picture over the mesh's UV map."""
    node: Any = view.node
    if node.projection != "FLAT":
        view.warn(f"projection {node.projection} is not supported: drawn flat")
    store = view.translation.textures
    converted = store.image(node.image, view.warn)
    if converted is None:
        return store.add("missing", lambda: basicrt.ConstantTexture(color=MISSING))
    matrix = _uv_transform(view)
    values: dict[str, Any] = {
        "interpolation": INTERPOLATIONS[node.interpolation],
        "extension": _EXTENSIONS[node.extension],
        "divide_by_alpha": converted.is_associated and node.outputs["Alpha"].is_linked,
    }
    key = (converted.key, *values.values(), matrix.tobytes())
    return store.add(
        key, lambda: basicrt.ImageTexture(converted.image, uv_transform=matrix, **values)
    )


def _uv_transform(view: NodeView) -> np.ndarray:
    """(4, 4) of the mesh's uv coordinates, as points with z = 0."""
    coordinates = coordinates_at(view) or Coordinates("default", np.eye(4))
    if coordinates.source not in ("default", "UV", "constant"):
        view.warn(f"{coordinates.source} coordinates are not supported: the UV map is used")
    if coordinates.uv_map:
        view.translation.uv_maps.add(coordinates.uv_map)
    return np.asarray(coordinates.matrix, np.float32)
