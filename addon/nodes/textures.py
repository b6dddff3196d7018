# SPDX-License-Identifier: GPL-3.0-or-later
"""The texture nodes: each function makes a texture of one."""

from __future__ import annotations

from typing import Any

import numpy as np

import basicrt

from .coordinate_nodes import surface, texture_vector
from .coordinates import Coordinates, coordinates_at
from .images import MISSING, ConvertedImage
from .mesh_data import MeshData, Source
from .node_view import NodeView, texture
from .operations import Operands, Value, operation

INTERPOLATIONS = {"Linear": "linear", "Closest": "closest", "Cubic": "cubic", "Smart": "cubic"}
_EXTENSIONS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}


@texture("ShaderNodeTexImage")
def image_texture(view: NodeView) -> int:
    """A picture over the mesh's UV map."""
    node: Any = view.node
    store = view.translation.textures
    converted = store.image(node.image, view.warn)
    if converted is None:
        return store.add("missing", lambda: basicrt.ConstantTexture(color=MISSING))
    return _image_texture(view, converted, _uv_transform(view))


def _image_texture(view: NodeView, converted: ConvertedImage, matrix: np.ndarray) -> int:
    """The texture of an image that has been converted."""
    node: Any = view.node
    store = view.translation.textures
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
    if coordinates.source != "constant":
        view.translation.mesh_data.add(MeshData(Source.UV, ""))
    return np.asarray(coordinates.matrix, np.float32)


@operation("ShaderNodeTexEnvironment")
def environment_lookup(of: Operands, _output: str) -> Value:
    """A picture over directions."""
    store = of.view.translation.textures
    converted = store.image(of.node.image, of.view.warn)
    if converted is None:
        return Value("color", MISSING)
    interpolation = INTERPOLATIONS[of.node.interpolation]
    texture = store.add(
        (converted.key, interpolation),
        lambda: basicrt.ImageTexture(converted.image, interpolation=interpolation),
    )
    vector = (
        of.vector("Vector") if of.is_linked("Vector") else surface(of, "vector", "position").data
    )
    made = basicrt.TextureOperation(
        texture=texture, vector=vector, projection=of.node.projection.lower()
    )
    return of.add("color", made)


@operation("ShaderNodeTexImage")
def image_lookup(of: Operands, output: str) -> Value:
    """A picture over any coordinates."""
    store = of.view.translation.textures
    converted = store.image(of.node.image, of.view.warn)
    if converted is None:
        return Value("color", MISSING) if output == "Color" else Value("number", 1.0)
    texture = _image_texture(of.view, converted, np.eye(4, dtype=np.float32))
    made = basicrt.TextureOperation(
        texture=texture,
        vector=texture_vector(of, "uv"),
        alpha=output == "Alpha",
        projection=of.node.projection.lower(),
        blend=of.node.projection_blend,
    )
    return of.add("color" if output == "Color" else "number", made)
