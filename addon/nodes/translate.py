# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole node trees: a material's surface and volume, and the light that a lamp gives off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

import basicrt

from .. import compat
from ..report import Report
from . import aov_output, coordinate_nodes, math_nodes, pattern_nodes, shaders, textures, volumes
from .displacement import displacement_normal, displacement_offset
from .graph import Place, find_socket, trace
from .images import Textures
from .node_view import Color, LampObject, NodeView, Translation, scaled, unit

# Imported to fill the tables of functions.
assert coordinate_nodes
assert math_nodes
assert pattern_nodes
assert shaders
assert textures
assert volumes


@dataclass(frozen=True)
class Emission:
    """What the nodes of a lamp make of its light: a factor, or a material that says it place by place."""

    radiance: Color = (1.0, 1.0, 1.0)
    material: basicrt.Material | None = None


def _library(b_id: bpy.types.ID) -> Any:
    """The file that a datablock is linked from; None for this one."""
    b_original: Any = b_id.original
    return b_original.library


def output_place(tree: bpy.types.ShaderNodeTree, identifier: str) -> Place | None:
    """An input of the output node that counts for a path tracer."""
    output = tree.get_output_node("CYCLES")
    socket = find_socket(output.inputs, identifier) if output else None
    return Place(socket, ()) if socket else None


def is_linked(tree: bpy.types.ShaderNodeTree, identifier: str) -> bool:
    """Whether something arrives at an input of the output node."""
    place = output_place(tree, identifier)
    return place is not None and trace(place).socket.is_output


def translate_surface(
    b_material: bpy.types.Material, report: Report, store: Textures
) -> basicrt.Material:
    """A material's surface and volume, with a warning for each thing that is not as in Blender.

    Its textures are added to `store`.
    """
    material = basicrt.Material(name=b_material.name)
    with compat.inlined_nodes(b_material) as tree:
        if tree is None:
            red, green, blue, _alpha = b_material.diffuse_color
            color = unit((float(red), float(green), float(blue)))
            material.surface = material.add(basicrt.DiffuseShader(color=color, twosided=True))
            return material
        item = f'material "{b_material.name}"'
        translation = Translation(item, report, material, store, library=_library(b_material))
        displacement = output_place(tree, "Displacement")
        if displacement is not None:
            _displace(translation, displacement, b_material)
        place = output_place(tree, "Surface")
        if place is not None:
            material.surface = translation.shader_at(place)
        if _has_bumps(material) and not compat.corrects_bumps(b_material):
            translation.warn("Bump Map Correction can't be switched off")
        fill(translation, tree)
        aov_output.translate(translation, tree)
        b_original: Any = b_material.original
        store.mesh_data[b_original.session_uid] = frozenset(translation.mesh_data)
        store.object_data[b_original.session_uid] = frozenset(translation.object_data)
    return material


def _has_bumps(material: basicrt.Material) -> bool:
    bumps = (basicrt.BumpOperation, basicrt.NormalMapOperation)
    return any(isinstance(operation, bumps) for operation in material.operations)


def _displace(translation: Translation, place: Place, b_material: bpy.types.Material) -> None:
    """Moves the surface, or gives shaders the normal that it would have, or both: as the material says."""
    method = getattr(b_material, "displacement_method", "BUMP")
    if method != "BUMP":
        offset = displacement_offset(place, translation)
        if offset is not None:
            keeps_normals = method == "BOTH"
            shader = basicrt.DisplacementShader(offset=offset, keep_normals=keeps_normals)
            translation.material.add(shader)
    if method != "DISPLACEMENT":
        normal = displacement_normal(place, translation, method == "BOTH")
        if normal is not None:
            translation.normal = normal
    translation.values.clear()  # the height knows the surface as it is, all else what it looks like


def fill(surface: Translation, tree: bpy.types.ShaderNodeTree) -> None:
    """Fills the material with the volume of its nodes, where they have one.

    A volume that is linked leaves a surface that isn't as a mere boundary, whatever comes of it.
    """
    place = output_place(tree, "Volume")
    if place is None or not is_linked(tree, "Volume"):
        return
    material = surface.material
    translation = Translation(
        surface.item, surface.report, material, surface.textures, is_volume=True
    )
    material.volume = translation.shader_at(place)
    if material.volume is None:
        material.volume = material.add(basicrt.VolumeShader())


def emission_of(
    b_light: bpy.types.Light, report: Report, store: Textures, lamp: LampObject
) -> Emission | None:
    """What the nodes of a lamp give off; None where they are not in use.

    Its textures are added to `store`.
    """
    with compat.inlined_nodes(b_light) as tree:
        if tree is None:
            return None
        item = f'light "{b_light.name}"'
        material = basicrt.Material(name=b_light.name)
        translation = Translation(
            item, report, material, store, lamp=lamp, library=_library(b_light)
        )
        place = output_place(tree, "Surface")
        if place is None:
            return _DARK
        constant = _constant_emission(translation, place)
        if constant is not None:
            return constant
        material.surface = translation.shader_at(place)
        return Emission(material=material) if material.surface is not None else _DARK


_DARK = Emission((0.0, 0.0, 0.0))


def _constant_emission(translation: Translation, place: Place) -> Emission | None:
    """Of an Emission node alone that is the same everywhere, else None."""
    source = trace(place)
    if not source.socket.is_output or source.socket.node is None:
        return _DARK
    view = NodeView(source.socket.node, source.groups, translation)
    if view.bl_idname != "ShaderNodeEmission":
        return None
    color, strength = view.varying_light("Color"), view.varying_number("Strength")
    is_constant = isinstance(color, tuple) and isinstance(strength, float)
    return Emission(scaled(color, strength)) if is_constant else None  # type: ignore[arg-type]
