# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a mesh sticks out at its vertices: Blender's Pointiness."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .vectors import unit

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def measure(b_mesh: Any) -> NDArray[np.float32]:
    """(V,): the angle between normal and edges over half a turn, 0.5 where it is flat, more on ridges.

    Vertices at the same place count as one; then each is the mean of itself and its neighbours.
    """
    count = len(b_mesh.vertices)
    positions = _read(b_mesh.attributes["position"].data, "vector", count, 3)
    normals = _read(b_mesh.vertex_normals, "vector", count, 3)
    places, place = np.unique(positions, axis=0, return_inverse=True)
    place = place.reshape(-1)
    ends = np.empty(2 * len(b_mesh.edges), np.int32)
    b_mesh.edges.foreach_get("vertices", ends)
    edges = _unique_edges(place[ends.reshape(-1, 2)])

    along = unit(places[edges[:, 1]] - places[edges[:, 0]])
    neighbours = np.bincount(edges.reshape(-1), minlength=len(places))[:, None]
    sums = _gather(edges, along, -along, len(places))
    mean = np.divide(sums, neighbours, out=np.zeros_like(sums), where=neighbours > 0)
    turned = np.zeros((len(places), 3))
    np.add.at(turned, place, normals)
    cosines = np.sum(unit(turned) * mean, axis=1, keepdims=True)
    raw = np.where(neighbours > 0, np.arccos(np.clip(cosines, -1.0, 1.0)) / np.pi, 0.0)
    blurred = (raw + _gather(edges, raw[edges[:, 1]], raw[edges[:, 0]], len(places))) / (
        neighbours + 1
    )
    pointiness: NDArray[np.float32] = blurred[place, 0].astype(np.float32)
    return pointiness


def _read(source: Any, member: str, count: int, width: int) -> Floats:
    numbers = np.empty(count * width, np.float32)
    source.foreach_get(member, numbers)
    return numbers.reshape(count, width).astype(np.float64)


def _unique_edges(edges: Integers) -> Integers:
    """Without those between vertices at one place, and each but once."""
    apart = np.sort(edges[edges[:, 0] != edges[:, 1]], axis=1)
    unique: Integers = np.unique(apart, axis=0)
    return unique


def _gather(edges: Integers, to_first: Floats, to_second: Floats, count: int) -> Floats:
    """(count, N): what edges' ends are given, added up."""
    sums = np.zeros((count, to_first.shape[1]))
    np.add.at(sums, edges[:, 0], to_first)
    np.add.at(sums, edges[:, 1], to_second)
    return sums
