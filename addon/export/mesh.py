# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated Blender meshes to triangles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import basicrt

from ..nodes import MeshData
from . import attributes

Floats = NDArray[np.float32]
Integers = NDArray[np.int32]


def key(b_mesh: bpy.types.Mesh) -> int:
    """What tells evaluated meshes apart during one export; objects that share data share it."""
    return b_mesh.as_pointer()


@dataclass(frozen=True)
class Topology:
    """What must stay the same while a mesh deforms."""

    vertex_count: int
    corner_vertices: Integers  # (L,) of the mesh's corners
    triangle_corners: Integers  # (3T,) of each triangle, among the mesh's corners


@dataclass(frozen=True)
class Moment:
    """Where the vertices are at one time: (V, 3), and (T, 3, 3) normals or None."""

    positions: Floats
    corner_normals: Floats | None


def topology(b_mesh: bpy.types.Mesh) -> Topology:
    """Of a mesh that has been converted."""
    return Topology(
        len(b_mesh.vertices), _attribute(b_mesh, ".corner_vert", "value", 1), _corners(b_mesh)
    )


def moment(b_mesh: bpy.types.Mesh, first: Topology) -> Moment | None:
    """Where a mesh's vertices are now, None where it isn't the same mesh any more.

    Triangles stay as they were first: Blender may cut polygons otherwise now.
    """
    is_same = len(b_mesh.vertices) == first.vertex_count and np.array_equal(
        _attribute(b_mesh, ".corner_vert", "value", 1), first.corner_vertices
    )
    if not is_same:
        return None
    return Moment(
        _attribute(b_mesh, "position", "vector", 3),
        _corner_normals(b_mesh, first.triangle_corners),
    )


def deforming(still: basicrt.Mesh, moments: Sequence[Moment]) -> basicrt.Mesh | None:
    """A mesh that goes through these moments, None where not all of them have normals or none has.

    Its attributes, tangents among them, stay those of `still`.
    """
    normals = [moment.corner_normals for moment in moments if moment.corner_normals is not None]
    if len(normals) not in (0, len(moments)):
        return None
    return basicrt.Mesh(
        moments[0].positions,
        still.triangles,
        corner_normals=normals[0] if normals else None,
        motion_positions=np.stack([moment.positions for moment in moments[1:]]),
        motion_corner_normals=np.stack(normals[1:]) if normals else None,
        **_unmoved(still),
    )


def between_frames(still: basicrt.Mesh, before: Floats, after: Floats) -> basicrt.Mesh:
    """The same mesh, which knows its (V, 3) positions of one frame before and one frame after."""
    return basicrt.Mesh(
        still.positions,
        still.triangles,
        corner_normals=still.corner_normals,
        adjacent_positions=np.stack([before, after]),
        **_unmoved(still),
    )


def _unmoved(still: basicrt.Mesh) -> dict[str, Any]:
    """What is the same at all times."""
    return {
        "uvs": still.uvs,
        "material_slots": still.material_slots,
        "texture_space": still.texture_space,
        "attributes": still.attributes,
    }


def convert_object(
    b_object: bpy.types.Object, b_mesh: bpy.types.Mesh, asked: Iterable[MeshData] = ()
) -> basicrt.Mesh | None:
    """convert() of an evaluated object's mesh, in edit mode too, where its arrays are empty."""
    if not b_mesh.is_editmode:
        return convert(b_mesh, asked)
    try:
        return convert(b_object.to_mesh(), asked)
    finally:
        b_object.to_mesh_clear()


def convert(b_mesh: bpy.types.Mesh, asked: Iterable[MeshData] = ()) -> basicrt.Mesh | None:
    """Triangulated copy of an evaluated mesh, None where it has no faces.

    positions (V, 3) float32, object space, metres; triangles (T, 3) int32; corner normals (T, 3, 3)
    float32, none where every face is flat; uvs (T, 3, 2) float32 of the layer that is active for
    rendering; material slots (T,) int32; the attributes that are asked for. Holds no reference to
    `b_mesh`. Raises basicrt.SceneError for numbers that are not finite.
    """
    corners = _corners(b_mesh)
    if corners.size == 0:
        return None
    triangles = attributes.Triangles(
        positions=_attribute(b_mesh, "position", "vector", 3),
        vertices=_attribute(b_mesh, ".corner_vert", "value", 1)[corners].reshape(-1, 3),
        corners=corners,
        corner_normals=_corner_normals(b_mesh, corners),
    )
    asked = frozenset(asked)
    return basicrt.Mesh(
        triangles.positions,
        triangles.vertices,
        corner_normals=triangles.corner_normals,
        uvs=attributes.active_uvs(b_mesh, triangles, asked),
        material_slots=_material_slots(b_mesh),
        texture_space=_texture_space(b_mesh),
        attributes=attributes.convert(b_mesh, triangles, asked),
    )


def _texture_space(b_mesh: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Where generated coordinates are 0, and how far from there they are 1."""
    location, size = b_mesh.texspace_location, b_mesh.texspace_size
    return tuple(location - size), tuple(2.0 * size)


def _corners(b_mesh: bpy.types.Mesh) -> Integers:
    """(3T,): of each triangle, among the mesh's corners."""
    b_mesh.calc_loop_triangles()
    corners = np.empty(len(b_mesh.loop_triangles) * 3, np.int32)
    b_mesh.loop_triangles.foreach_get("loops", corners)
    return corners


def _attribute(b_mesh: bpy.types.Mesh, name: str, member: str, width: int) -> NDArray[Any]:
    """A mesh attribute as (N, width), or (N,) where the width is 1: float32 or int32."""
    attribute: Any = b_mesh.attributes[name]
    return _read(attribute.data, member, width, np.int32 if member == "value" else np.float32)


def _read(collection: Any, member: str, width: int, dtype: type) -> NDArray[Any]:
    """One member of each item."""
    values: NDArray[Any] = np.empty(len(collection) * width, dtype)
    collection.foreach_get(member, values)
    return values if width == 1 else values.reshape(-1, width)


def _corner_normals(b_mesh: bpy.types.Mesh, corners: Integers) -> Floats | None:
    """(T, 3, 3), or None for a mesh that is flat all over."""
    if b_mesh.normals_domain == "FACE":
        return None
    normals: Floats = _read(b_mesh.corner_normals, "vector", 3, np.float32)
    return normals[corners].reshape(-1, 3, 3)


def _material_slots(b_mesh: bpy.types.Mesh) -> Integers | None:
    """(T,), or None where every face has the first slot: Blender leaves the attribute out then."""
    if "material_index" not in b_mesh.attributes:
        return None
    faces: Integers = _read(b_mesh.loop_triangle_polygons, "value", 1, np.int32)
    slots: Integers = _attribute(b_mesh, "material_index", "value", 1)[faces]
    return np.maximum(slots, 0)
