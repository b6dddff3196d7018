# SPDX-License-Identifier: GPL-3.0-or-later
"""The texture nodes: each function makes a texture of one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np

import basicrt

from . import ies
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


# What Blender has where there is no photometry.
_NO_PHOTOMETRY = 100.0


@operation("ShaderNodeTexIES")
def ies_lookup(of: Operands, _output: str) -> Value:
    """How much light a luminaire sends in a direction."""
    photometry = _photometry(of)
    strength = of.number("Strength")
    if photometry is None:
        made: Any = basicrt.MathOperation(operation="multiply", a=strength, b=_NO_PHOTOMETRY)
        return of.add("number", made)
    vector: Any
    if of.is_linked("Vector"):
        vector = of.vector("Vector")
    else:
        towards = surface(of, "vector", "incoming").data
        change = basicrt.ChangeSpaceOperation(
            vector=towards, source="world", target="object", quantity="normal"
        )
        vector = of.add("vector", change).data
    made = basicrt.IesOperation(
        vector=vector,
        strength=strength,
        horizontal=photometry.horizontal.astype(np.float32),
        vertical=photometry.vertical.astype(np.float32),
        values=photometry.values.astype(np.float32).ravel(),
    )
    return of.add("number", made)


def _photometry(of: Operands) -> ies.Photometry | None:
    """That of a node's text or file; None, with a warning, where it can't be read."""
    instead = f"the same in all directions instead, {_NO_PHOTOMETRY:g} times the strength"
    if of.node.mode == "INTERNAL":
        if of.node.ies is None:
            of.view.warn(f"has no text: {instead}")
            return None
        source, text = f'text "{of.node.ies.name}"', of.node.ies.as_string()
    elif not of.node.filepath:
        of.view.warn(f"has no file: {instead}")
        return None
    else:
        library = of.node.id_data.library or of.view.translation.library
        path = bpy.path.abspath(of.node.filepath, library=library)
        source = f'file "{path}"'
        try:
            text = Path(path).read_text("utf-8", "replace")
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            of.view.warn(f"{source} can't be read ({reason}): {instead}")
            return None
    try:
        return ies.parse(text)
    except ies.IesError as error:
        of.view.warn(f"{source} is not an IES file ({error}): {instead}")
        return None
