# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes of meshes that materials ask for: Blender's own, and the tangents of UV maps."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..nodes import MeshData, Part, Source
from . import pointiness
from .vectors import unit

Floats = NDArray[np.float32]
Integers = NDArray[np.int32]
# Its name, its domain in the core, and (N, 3) values.
Converted = tuple[str, str, Floats]

# What holds the numbers of one item, by Blender's type, and how many there are.
_MEMBERS = {
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT2": ("vector", 2),
    "INT32_2D": ("value", 2),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),  # as Blender gives them: linear
}
_DOMAINS = {"POINT": "vertex", "CORNER": "corner", "FACE": "face"}


@dataclass(frozen=True)
class Triangles:
    """A mesh cut into triangles."""

    positions: Floats  # (V, 3)
    vertices: Integers  # (T, 3)
    corners: Integers  # (3T,) among the mesh's corners
    corner_normals: Floats | None  # (T, 3, 3), None where it is flat


def convert(
    b_mesh: bpy.types.Mesh, triangles: Triangles, asked: Collection[MeshData]
) -> list[Converted]:
    """Those that the mesh has."""
    found = [_convert_one(b_mesh, triangles, data) for data in sorted(asked)]
    return [one for one in found if one is not None]


def lacks_tangents(b_mesh: bpy.types.Mesh, asked: Collection[MeshData]) -> bool:
    """Whether it has no UV map of which Blender makes up another one to take tangents from."""
    data = MeshData(Source.UV, "", Part.TANGENT)
    return data in asked and _uv_layer(b_mesh, "") is None


def active_uvs(
    b_mesh: bpy.types.Mesh, triangles: Triangles, asked: Collection[MeshData]
) -> Floats | None:
    """(T, 3, 2) of the map that is active for rendering.

    Where there is none: zeros for materials that ask, as in Blender, and else None.
    """
    layer = _uv_layer(b_mesh, "")
    if layer is not None:
        return _corner_uvs(layer, triangles)
    if MeshData(Source.UV, "") in asked:
        return np.zeros((len(triangles.vertices), 3, 2), np.float32)
    return None


def _convert_one(b_mesh: bpy.types.Mesh, triangles: Triangles, data: MeshData) -> Converted | None:
    if data.part in (Part.TANGENT, Part.TANGENT_SIGN):
        return _convert_tangents(b_mesh, triangles, data)
    if data.part == Part.ISLAND:
        return data.exported_name, "vertex", _island_numbers(triangles)
    if data.part == Part.POINTINESS:
        return (
            data.exported_name,
            "vertex",
            np.repeat(pointiness.measure(b_mesh)[:, None], 3, axis=1),
        )
    b_attribute = _find(b_mesh, data)
    if b_attribute is None or b_attribute.domain not in _DOMAINS:
        return None
    values = values_of(b_attribute, data.part)
    if values is None:
        return None
    if b_attribute.domain == "CORNER":
        values = values[triangles.corners]
    elif b_attribute.domain == "FACE":
        values = values[_faces(b_mesh)]
    return data.exported_name, _DOMAINS[b_attribute.domain], values


def values_of(b_attribute: Any, part: Part) -> Floats | None:
    """(N, 3) of one of Blender's attributes, None where there are none or they are no numbers."""
    if b_attribute.data_type not in _MEMBERS or len(b_attribute.data) == 0:
        return None
    member, width = _MEMBERS[b_attribute.data_type]
    numbers: NDArray[Any] = np.empty(len(b_attribute.data) * width, _storage(b_attribute))
    b_attribute.data.foreach_get(member, numbers)
    values = _part(numbers.reshape(-1, width).astype(np.float32), part)
    return None if values is None else _finite(values)


def _find(b_mesh: Any, data: MeshData) -> Any:
    """Blender's attribute, None where there is none."""
    name = data.name
    if not name and data.source == Source.COLOR:
        index = b_mesh.color_attributes.render_color_index
        colors = b_mesh.color_attributes
        return colors[index] if 0 <= index < len(colors) else None
    if not name and data.source == Source.UV:
        layer = _uv_layer(b_mesh, "")
        name = layer.name if layer else ""
    return b_mesh.attributes.get(name)


def _storage(b_attribute: Any) -> type:
    """Of the numbers that foreach_get() fills in fastest."""
    if b_attribute.data_type == "BOOLEAN":
        return np.bool_
    return np.int32 if b_attribute.data_type.startswith("INT") else np.float32


def _part(values: Floats, part: Part) -> Floats | None:
    """(N, 3) of values with any number of components: one is there thrice, and two have a zero after them."""
    width = values.shape[1]
    if part == Part.ALPHA:
        return np.repeat(values[:, 3:], 3, axis=1) if width == 4 else None
    if part == Part.MEAN:
        first = values[:, :1] if width < 3 else values[:, :3].mean(axis=1, keepdims=True)
        return np.repeat(first, 3, axis=1)
    if width == 1:
        return np.repeat(values, 3, axis=1)
    return np.pad(values, ((0, 0), (0, 1))) if width == 2 else values[:, :3]


def _finite(values: Floats) -> Floats:
    """Without infinities and NaNs, which become 0."""
    return np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)


def _faces(b_mesh: Any) -> Integers:
    """(T,): the polygon of each triangle."""
    faces = np.empty(len(b_mesh.loop_triangles), np.int32)
    b_mesh.loop_triangle_polygons.foreach_get("value", faces)
    return faces


def _island_numbers(triangles: Triangles) -> Floats:
    """(V, 3): a random number, thrice, for all vertices that triangles connect."""
    islands = np.arange(len(triangles.positions))
    first, *others = triangles.vertices.T
    while True:
        before = islands.copy()
        for other in others:
            least = np.minimum(islands[first], islands[other])
            np.minimum.at(islands, first, least)
            np.minimum.at(islands, other, least)
        islands = islands[islands]
        if np.array_equal(before, islands):
            break
    random = np.random.default_rng(0).random(len(islands), dtype=np.float32)
    return np.repeat(random[islands][:, None], 3, axis=1)


# ---- UV maps -------------------------------------------------------------------------------------


def _uv_layer(b_mesh: Any, name: str) -> Any:
    """A UV map by name, or the one that is active for rendering; None where there is none."""
    if name:
        return b_mesh.uv_layers.get(name)
    return next((layer for layer in b_mesh.uv_layers if layer.active_render), None)


def _corner_uvs(layer: Any, triangles: Triangles) -> Floats:
    """(T, 3, 2)"""
    uvs = np.empty(len(layer.uv) * 2, np.float32)
    layer.uv.foreach_get("vector", uvs)
    return uvs.reshape(-1, 2)[triangles.corners].reshape(-1, 3, 2)


def _convert_tangents(
    b_mesh: bpy.types.Mesh, triangles: Triangles, data: MeshData
) -> Converted | None:
    layer = _uv_layer(b_mesh, data.name)
    if layer is None:
        return None
    tangents, signs = make_tangents(triangles, _corner_uvs(layer, triangles))
    if data.part == Part.TANGENT:
        return data.exported_name, "corner", tangents.reshape(-1, 3)
    return data.exported_name, "face", np.repeat(signs[:, None], 3, axis=1)


def make_tangents(triangles: Triangles, uvs: Floats) -> tuple[Floats, Floats]:
    """(T, 3, 3) unit tangents along u in object space, and (T,) signs, -1 where uvs are mirrored.

    Corners that share a vertex, a normal, uvs and a sign share a tangent: the mean of the triangles',
    each weighted by its angle there, in the plane across the normal (Mikkelsen 2008, "Simulation of
    Wrinkled Surfaces Revisited").
    """
    places = triangles.positions[triangles.vertices].astype(np.float64)
    edges, uv_edges = places[:, 1:] - places[:, :1], uvs[:, 1:].astype(np.float64) - uvs[:, :1]
    area = uv_edges[:, 0, 0] * uv_edges[:, 1, 1] - uv_edges[:, 0, 1] * uv_edges[:, 1, 0]
    signs = np.where(area < 0.0, -1.0, 1.0)
    along = (edges[:, 0] * uv_edges[:, 1, 1:] - edges[:, 1] * uv_edges[:, 0, 1:]) * signs[:, None]

    if triangles.corner_normals is None:
        normals = np.repeat(unit(np.cross(edges[:, 0], edges[:, 1]))[:, None], 3, axis=1)
    else:
        normals = triangles.corner_normals.astype(np.float64)
    flat = unit(_across(along[:, None], normals))
    weighted = flat * _angles(places, normals)[..., None]

    keys = np.concatenate(
        [
            triangles.vertices.reshape(-1, 1).astype(np.float64),
            normals.astype(np.float32).reshape(-1, 3),
            uvs.reshape(-1, 2),
            np.repeat(signs, 3)[:, None],
        ],
        axis=1,
    )
    group = _group_rows(keys)
    sums = np.zeros((group.max() + 1, 3))
    np.add.at(sums, group, weighted.reshape(-1, 3))
    tangents = unit(sums)[group].reshape(-1, 3, 3)
    return tangents.astype(np.float32), signs.astype(np.float32)


def _group_rows(rows: NDArray[np.float64]) -> NDArray[np.int64]:
    """(N,): a number for each row, the same for equal ones.

    By hashes of 64 bits: sorting whole rows takes ten times as long.
    """
    hashes = np.zeros(len(rows), np.uint64)
    for column in (rows + 0.0).view(np.uint64).T:  # there is but one zero
        hashes = (hashes ^ column) * np.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> np.uint64(29)
    group: NDArray[np.int64] = np.unique(hashes, return_inverse=True)[1]
    return group


def _across(vectors: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Without their share along normals of unit length."""
    along: NDArray[np.float64] = np.sum(vectors * normals, axis=-1, keepdims=True)
    return vectors - normals * along


def _angles(places: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """(T, 3): of each triangle's corners, as seen along the corners' normals."""
    after = unit(_across(np.roll(places, -1, axis=1) - places, normals))
    before = unit(_across(np.roll(places, 1, axis=1) - places, normals))
    cosines: NDArray[np.float64] = np.sum(after * before, axis=-1)
    return np.arccos(np.clip(cosines, -1.0, 1.0))
