# SPDX-License-Identifier: GPL-3.0-or-later
"""The texture nodes: each function makes a texture of one."""

from __future__ import annotations

from typing import Any

import numpy as np

import basicrt

from .coordinate_nodes import surface, texture_vector
from .coordinates import Coordinates, coordinates_at
from .images import MISSING, ConvertedImage, is_tiled
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
    converted = store.image(node.image, node.image_user, view.warn)
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
    converted = store.image(of.node.image, of.node.image_user, of.view.warn)
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
    if is_tiled(of.node):
        return _tiled_lookup(of, output)
    store = of.view.translation.textures
    converted = store.image(of.node.image, of.node.image_user, of.view.warn)
    if converted is None:
        return Value("color", MISSING) if output == "Color" else Value("number", 1.0)
    return _lookup(of, converted, texture_vector(of, "uv"), output)


def _lookup(of: Operands, converted: ConvertedImage, vector: Any, output: str) -> Value:
    made = basicrt.TextureOperation(
        texture=_image_texture(of.view, converted, np.eye(4, dtype=np.float32)),
        vector=vector,
        alpha=output == "Alpha",
        projection=of.node.projection.lower(),
        blend=of.node.projection_blend,
    )
    return of.add("color" if output == "Color" else "number", made)


def _tiled_lookup(of: Operands, output: str) -> Value:
    """The picture of the tile that the coordinates are in; magenta where there is none."""

    def number(operation: str, a: Any, b: Any = 0.0, c: Any = 0.0) -> Any:
        return of.add("number", basicrt.MathOperation(operation=operation, a=a, b=b, c=c)).data

    if of.node.projection != "FLAT":
        of.view.warn(f"{of.node.projection} projection of UDIM tiles is not supported: drawn flat")
    vector = texture_vector(of, "uv")
    x, y = (
        of.add("number", basicrt.ComponentOperation(value=vector, component=name)).data
        for name in ("x", "y")
    )
    across, up = number("trunc", x), number("trunc", y)
    inside = of.add(
        "vector",
        basicrt.CombineOperation(x=number("subtract", x, across), y=number("subtract", y, up)),
    ).data
    is_color = output == "Color"
    kind = "color" if is_color else "number"
    result = Value(kind, MISSING if is_color else (1.0, 1.0, 1.0))
    tiles = of.view.translation.textures.tiles(of.node.image, of.view.warn)
    for tile, converted in tiles.items():
        if converted is None:
            continue
        here = number(
            "multiply",
            number("compare", across, float((tile - 1001) % 10), 0.5),
            number("compare", up, float((tile - 1001) // 10), 0.5),
        )
        looked_up = _lookup(of, converted, inside, output).data
        result = of.add(kind, basicrt.MixOperation(factor=here, a=result.data, b=looked_up))
    return result
