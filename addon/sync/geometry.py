# SPDX-License-Identifier: GPL-3.0-or-later
"""The geometry of objects, and of hair on them, as shapes of the core."""

from __future__ import annotations

from typing import Any

import basicrt

from ..export import attributes, hair, mesh, points
from ..nodes import MeshData
from ..report import ExportError, Report
from .layer import Layer
from .shapes import Geometry


def convert(
    b_object: Any,
    asked: frozenset[MeshData],
    system: hair.System | None,
    layer: Layer,
    report: Report,
) -> Geometry | None:
    """An evaluated object's, or of the hair of one of its particle systems; None where there is nothing of it."""
    b_data, item = b_object.data, f'object "{b_object.name}"'
    try:
        if system is not None or b_object.type == "CURVES":
            return _curves(b_object, asked, system, layer, report)
        if b_object.type == "POINTCLOUD":
            return points.convert(b_data, asked)
        shape = mesh.convert_object(b_object, b_data, asked)
    except basicrt.SceneError as error:
        raise ExportError(f"{item}: {error}") from error
    if shape is not None and attributes.lacks_tangents(b_data, asked):
        report.warn(item, "has no UV map for the tangents that its material asks for")
    return shape


def _curves(
    b_object: Any,
    asked: frozenset[MeshData],
    system: hair.System | None,
    layer: Layer,
    report: Report,
) -> basicrt.Curves | None:
    """Hair, and what of it isn't drawn as Blender has it."""
    item, form = f'object "{b_object.name}"', hair.form(layer.b_scene)
    if hair.is_linear(layer.b_scene):
        report.warn(item, "Linear 3D Curves are drawn as smooth ones")
    if system is not None:
        if hair.asks_for_more(asked):
            report.warn(item, "its hair has no attributes but its roots' UV map")
        return hair.convert_system(b_object, system.index, form, layer.is_render)
    if not hair.is_all_catmull_rom(b_object.data):
        report.warn(item, "its curves are drawn as Catmull-Rom curves through their points")
    return hair.convert(b_object.data, form, asked)
