# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a texture is looked up: a kind of coordinate, and the affine transform that Mapping nodes make of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Euler
from numpy.typing import NDArray

from .graph import Place, find_socket, trace
from .node_view import NodeView

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Coordinates:
    """`source` is a Texture Coordinate node's output (UV, Generated, ...); "default" is what an
    unlinked socket of the texture means, "constant" the same place everywhere."""

    source: str
    matrix: Matrix  # (4, 4), of points


def coordinates_at(view: NodeView, identifier: str = "Vector") -> Coordinates | None:
    """What arrives at a vector input; None, with a warning, where that can't be evaluated."""
    socket = find_socket(view.node.inputs, identifier)
    if socket is None:
        return Coordinates("default", np.eye(4))
    source = trace(Place(socket, view.groups))
    if not source.socket.is_output:
        return Coordinates("default", np.eye(4))
    node: Any = source.socket.node
    origin = NodeView(node, source.groups, view.translation)
    if origin.bl_idname == "ShaderNodeUVMap" and not node.from_instancer:
        return Coordinates("UV", np.eye(4))
    if origin.bl_idname == "ShaderNodeTexCoord" and not node.from_instancer:
        if source.socket.identifier == "Object" and node.object is not None:
            view.warn(f"{identifier} is linked to an object's coordinates, which are not supported")
            return None
        return Coordinates(source.socket.identifier, np.eye(4))
    if origin.bl_idname == "ShaderNodeMapping":
        return _mapped(origin)
    view.warn(f"{identifier} is linked to {origin.title}, which is not supported: left out")
    return None


def _mapped(view: NodeView) -> Coordinates | None:
    """What a Mapping node puts out."""
    before = coordinates_at(view)
    if before is None:
        return None
    if before.source == "default":  # an unlinked Mapping maps its own vector
        point = np.eye(4)
        point[:3, :3] = 0.0
        point[:3, 3] = view.vector("Vector")
        before = Coordinates("constant", point)
    node: Any = view.node
    if node.vector_type == "NORMAL":
        view.warn("the type Normal is not supported: left out")
        return before
    return Coordinates(before.source, _mapping_matrix(view) @ before.matrix)


def _mapping_matrix(view: NodeView) -> Matrix:
    """What a Mapping node does, as (4, 4)."""
    node: Any = view.node
    kind = node.vector_type
    scale = np.array(view.vector("Scale"))
    rotation: Matrix = np.array(Euler(view.vector("Rotation"), "XYZ").to_matrix(), np.float64)
    matrix = np.eye(4)
    if kind == "TEXTURE":
        inverse_scale = np.divide(1.0, scale, out=np.zeros(3), where=scale != 0.0)
        matrix[:3, :3] = inverse_scale[:, None] * rotation.T
        matrix[:3, 3] = -matrix[:3, :3] @ np.array(view.vector("Location"))
        return matrix
    matrix[:3, :3] = rotation * scale
    if kind == "POINT":
        matrix[:3, 3] = view.vector("Location")
    return matrix
