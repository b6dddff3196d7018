# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement: how far surfaces are moved, and the normals that bumps in their place have."""

from __future__ import annotations

from typing import Any

import basicrt

from .. import compat
from .coordinate_nodes import mesh_data, surface
from .graph import Place, trace
from .mesh_data import MeshData, Part, Source
from .node_view import Translation
from .operations import Operands, Value, as_vector, operation, output_value


@operation("ShaderNodeDisplacement")
def displacement(of: Operands, _output: str) -> Value:
    """An offset along the normal, world space."""
    height = _height(of)
    normal = of.vector("Normal") if of.is_linked("Normal") else _normal(of)
    if of.node.space != "OBJECT":
        return _scaled(of, normal, height)
    in_object = _in_space(of, normal, "object", "normal")
    return _offset_in_world(of, _scaled(of, in_object, height).data)


@operation("ShaderNodeVectorDisplacement")
def vector_displacement(of: Operands, _output: str) -> Value:
    """An offset by a colour's three numbers, world space."""
    middle = of.grey("Midlevel")
    from_middle = _vector_math(of, "subtract", of.vector("Vector"), middle)
    offset = _scaled(of, from_middle, of.number("Scale")).data
    if of.node.space == "WORLD":
        return Value("vector", offset)
    if of.node.space == "TANGENT":
        offset = _along_tangents(of, offset)
    return _offset_in_world(of, offset)


def _along_tangents(of: Operands, offset: Any) -> Any:
    """In object space: the second number goes along the normal, the others along the active UV map's axes.

    Of heights these are left out: along the surface they raise nothing, but as they turn from place to
    place they would seem to, as bumps look at the height beside a place along the normal of that place.
    """
    normal = _in_space(of, _normal(of), "object", "normal")
    if of.view.translation.is_height:
        return _scaled(of, normal, _component(of, offset, "y")).data
    tangent = mesh_data(of, "vector", MeshData(Source.UV, "", Part.TANGENT)).data
    sign = mesh_data(of, "number", MeshData(Source.UV, "", Part.TANGENT_SIGN)).data
    across = _vector_math(of, "normalize", _vector_math(of, "cross_product", normal, tangent))
    total: Any = (0.0, 0.0, 0.0)
    axes = (tangent, normal, _scaled(of, across, sign).data)
    for axis, component in zip(axes, "xyz", strict=True):
        along = _scaled(of, axis, _component(of, offset, component)).data
        total = _vector_math(of, "add", total, along)
    return total


def _component(of: Operands, vector: Any, component: str) -> Any:
    made = basicrt.ComponentOperation(value=vector, component=component)
    return of.add("number", made).data


def _normal(of: Operands) -> Any:
    return surface(of, "vector", "normal").data


def _height(of: Operands) -> Any:
    above = _math(of, "subtract", of.number("Height"), of.number("Midlevel"))
    return _math(of, "multiply", above, of.number("Scale"))


def _math(of: Operands, name: str, a: Any, b: Any) -> Any:
    return of.add("number", basicrt.MathOperation(operation=name, a=a, b=b)).data


def _vector_math(of: Operands, name: str, a: Any, b: Any = (0.0, 0.0, 0.0)) -> Any:
    return of.add("vector", basicrt.VectorMathOperation(operation=name, a=a, b=b)).data


def _scaled(of: Operands, vector: Any, factor: Any) -> Value:
    return of.add("vector", basicrt.VectorMathOperation(operation="scale", a=vector, scale=factor))


def _in_space(of: Operands, vector: Any, target: str, quantity: str) -> Any:
    made = basicrt.ChangeSpaceOperation(
        vector=vector,
        source="world" if target == "object" else "object",
        target=target,
        quantity=quantity,
    )
    return of.add("vector", made).data


def _offset_in_world(of: Operands, offset: Any) -> Value:
    return Value("vector", _in_space(of, offset, "world", "vector"))


def displacement_offset(place: Place, translation: Translation) -> Any:
    """How far whatever is linked to an output's Displacement moves the surface; None for nothing."""
    source = trace(place)
    if not source.socket.is_output:
        return None
    value = output_value(translation, source)
    if value is None:
        node: Any = source.socket.node
        translation.warn(f"displacement by {node.bl_label} is not supported and left out")
        return None
    return as_vector(value)


def displacement_normal(
    place: Place, translation: Translation, is_displaced: bool
) -> basicrt.OperationRef | None:
    """The normal of a surface that is displaced by what is linked to an output's Displacement.

    The surface as it was counts, where it really `is_displaced`. None where nothing is linked.
    """
    translation.values.clear()
    translation.is_height = True
    offset = displacement_offset(place, translation)
    translation.is_height = False
    if offset is None:
        return None
    add = translation.material.add_operation
    normal = add(basicrt.SurfaceOperation(value="normal"))
    height = basicrt.VectorMathOperation(operation="dot_product", a=offset, b=normal)
    return add(
        basicrt.BumpOperation(
            height=add(height),
            distance=1.0,
            filter_width=compat.bump_filter_width(),
            undisplaced=is_displaced,
        )
    )
