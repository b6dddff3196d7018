# SPDX-License-Identifier: GPL-3.0-or-later
"""A world's nodes: backgrounds, mixed and added, become layers of the environment."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

import basicrt

from .. import compat
from ..report import HeldReport, Report
from .coordinates import Coordinates, coordinates_at
from .graph import Place, find_socket, trace
from .images import MISSING, Textures
from .node_view import Color, NodeView, Translation, as_color, positive, scaled
from .operations import output_value, raw_value
from .sky import convert_sky
from .textures import INTERPOLATIONS
from .translate import fill, output_place

_TEXTURES = ("ShaderNodeTexEnvironment", "ShaderNodeTexSky")
_PROJECTIONS = {"EQUIRECTANGULAR": "equirectangular", "MIRROR_BALL": "mirror_ball"}
# Outputs of Texture Coordinate that are the direction in a world.
_DIRECTIONS = ("default", "Generated", "Object", "constant")
# Which rays see a layer, by the two conditions that it is under.
_BOTH = {
    ("all", "camera"): "camera",
    ("all", "scattered"): "scattered",
    ("camera", "camera"): "camera",
    ("scattered", "scattered"): "scattered",
}


def translate_world(
    b_world: bpy.types.World, report: Report, store: Textures
) -> basicrt.Environment | None:
    """What the nodes of a world show, None where they are not in use.

    With a warning for each thing that is not as in Blender.
    """
    with compat.inlined_nodes(b_world) as tree:
        if tree is None:
            return None
        environment = basicrt.Environment()
        place = output_place(tree, "Surface")
        if place is not None:
            layers = _layers(f'world "{b_world.name}"', report, place, store)
            radiance = np.zeros(3)
            for layer in layers:
                if _is_plain(layer):
                    radiance += layer.radiance
            environment.radiance = radiance
            environment.layers = [layer for layer in layers if not _is_plain(layer)]
    return environment


class _NotLayersError(Exception):
    """The world is a graph that layers can't say."""


def _layers(
    item: str, report: Report, place: Place, store: Textures
) -> list[basicrt.EnvironmentLayer]:
    """The pictures and colours that the nodes add up, or else a picture of what they compute."""
    held = HeldReport()
    translation = Translation(item, held, basicrt.Material(), store, is_world=True)
    try:
        layers = list(_shader_layers(translation, place, 1.0, "all"))
    except _NotLayersError:
        return _drawn_layers(item, report, place, store)
    held.tell(report)
    return layers


def _drawn_layers(
    item: str, report: Report, place: Place, store: Textures
) -> list[basicrt.EnvironmentLayer]:
    """What the camera sees of a graph and what others do, one picture where that is the same."""
    material = basicrt.Material()
    translation = Translation(item, report, material, store, is_world=True)
    material.surface = translation.shader_at(place)
    is_told_apart = any(
        isinstance(operation, basicrt.SurfaceOperation) and operation.value == "is_camera_ray"
        for operation in material.operations
    )
    rays = ("camera", "scattered") if is_told_apart else ("all",)
    return [
        basicrt.EnvironmentLayer(
            image=store.draw(material, is_camera_ray=seen_by != "scattered"), seen_by=seen_by
        )
        for seen_by in rays
    ]


def translate_world_volume(
    b_world: bpy.types.World, report: Report, store: Textures
) -> basicrt.Material | None:
    """A material whose volume is the world's, None where that has none."""
    material = basicrt.Material(name=b_world.name)
    with compat.inlined_nodes(b_world) as tree:
        if tree is not None:
            fill(Translation(f'world "{b_world.name}"', report, material, store), tree)
    return material if material.volume is not None else None


def _is_plain(layer: basicrt.EnvironmentLayer) -> bool:
    """One colour for all rays from everywhere."""
    return layer.image is None and layer.sky is None and layer.seen_by == "all"


def _shader_layers(
    translation: Translation, place: Place, factor: float, seen_by: str
) -> Iterator[basicrt.EnvironmentLayer]:
    """The layers that a shader makes, times a factor, for the rays that see it."""
    source = trace(place)
    if not source.socket.is_output or factor == 0.0:
        return
    node: Any = source.socket.node
    view = NodeView(node, source.groups, translation)
    match view.bl_idname:
        case "ShaderNodeBackground" | "ShaderNodeEmission":
            if not isinstance(view.varying_number("Strength"), float):
                raise _NotLayersError
            strength = factor * view.number("Strength")
            if strength > 0.0:
                yield _color_layer(view, _input(view, "Color"), strength, seen_by)
        case "ShaderNodeAddShader":
            for identifier in ("Shader", "Shader_001"):
                yield from _shader_layers(translation, _input(view, identifier), factor, seen_by)
        case "ShaderNodeMixShader":
            yield from _mixed_layers(view, factor, seen_by)
        case _ if source.socket.type != "SHADER":  # a colour shines, as Blender has it
            yield _color_layer(view, place, factor, seen_by)
        case _:
            translation.warn(f"{view.title} is not supported: black instead")


def _input(view: NodeView, identifier: str) -> Place:
    """An input of a node that has it."""
    socket = find_socket(view.node.inputs, identifier)
    if socket is None:
        raise KeyError(f"{view.bl_idname} has no input {identifier}")
    return Place(socket, view.groups)


def _mixed_layers(
    view: NodeView, factor: float, seen_by: str
) -> Iterator[basicrt.EnvironmentLayer]:
    """Two shaders by a constant, or by whether the ray comes from the camera."""
    first, second = _input(view, "Shader"), _input(view, "Shader_001")
    switch = trace(_input(view, "Fac")).socket
    node: Any = switch.node
    translation = view.translation
    if (
        switch.is_output
        and node.bl_idname == "ShaderNodeLightPath"
        and switch.identifier == "Is Camera Ray"
    ):
        for place, rays in ((first, "scattered"), (second, "camera")):
            if (seen_by, rays) in _BOTH:
                yield from _shader_layers(translation, place, factor, _BOTH[seen_by, rays])
        return
    if not isinstance(view.share("Fac"), float):
        raise _NotLayersError
    share = view.number("Fac", 0, 1)
    yield from _shader_layers(translation, first, factor * (1.0 - share), seen_by)
    yield from _shader_layers(translation, second, factor * share, seen_by)


def _color_layer(
    view: NodeView, place: Place, factor: float, seen_by: str
) -> basicrt.EnvironmentLayer:
    """The layer of a colour that arrives at an input of a background."""
    source = trace(place)
    if not source.socket.is_output:
        return _plain_layer(positive(as_color(raw_value(source.socket))), factor, seen_by)
    node: Any = source.socket.node
    origin = NodeView(node, source.groups, view.translation)
    if origin.bl_idname in _TEXTURES:
        return _textured_layer(origin, factor, seen_by)
    before = _environment_before(origin)
    is_sky = before is not None and before.bl_idname == "ShaderNodeTexSky"
    value = None if is_sky else output_value(view.translation, source)
    if value is not None:
        if isinstance(value.data, basicrt.OperationRef):
            raise _NotLayersError
        return _plain_layer(positive(as_color(value.data)), factor, seen_by)
    if before is not None:
        view.translation.warn(f"{origin.title} is not supported in a world and left out")
        return _textured_layer(before, factor, seen_by)
    view.translation.warn(
        f"{origin.title} is not supported in a world: the socket's own colour is used"
    )
    return _plain_layer(positive(as_color(raw_value(place.socket))), factor, seen_by)


def _plain_layer(color: Color, factor: float, seen_by: str) -> basicrt.EnvironmentLayer:
    return basicrt.EnvironmentLayer(radiance=scaled(color, factor), seen_by=seen_by)


def _environment_before(view: NodeView) -> NodeView | None:
    """The first environment or sky texture that feeds a node, however indirectly."""
    for socket in view.node.inputs:
        source = trace(Place(socket, view.groups))
        if not source.socket.is_output or source.socket.node is None:
            continue
        before = NodeView(source.socket.node, source.groups, view.translation)
        if before.bl_idname in _TEXTURES:
            return before
        deeper = _environment_before(before)
        if deeper is not None:
            return deeper
    return None


def _textured_layer(view: NodeView, factor: float, seen_by: str) -> basicrt.EnvironmentLayer:
    if view.bl_idname == "ShaderNodeTexSky":
        return _sky_layer(view, factor, seen_by)
    return _image_layer(view, factor, seen_by)


def _sky_layer(view: NodeView, factor: float, seen_by: str) -> basicrt.EnvironmentLayer:
    """A Sky Texture."""
    node: Any = view.node
    has_vector = node.sky_type in ("PREETHAM", "HOSEK_WILKIE")
    sky, brightness = convert_sky(node, view.warn)
    return basicrt.EnvironmentLayer(
        radiance=scaled(brightness, factor),
        sky=sky,
        # Blender has no Vector for the skies in which the sun has a disc.
        transform=_direction_matrix(view) if has_vector else np.eye(4),
        seen_by=seen_by,
    )


def _direction_matrix(view: NodeView) -> Any:
    """What a texture's Vector input does to directions."""
    found = coordinates_at(view)
    if found is None and view.bl_idname == "ShaderNodeTexEnvironment":
        raise _NotLayersError
    coordinates = found or Coordinates("default", np.eye(4))
    if coordinates.source not in _DIRECTIONS:
        view.warn(f"{coordinates.source} coordinates are not supported: the direction is used")
    return coordinates.matrix


def _image_layer(view: NodeView, factor: float, seen_by: str) -> basicrt.EnvironmentLayer:
    """An Environment Texture."""
    node: Any = view.node
    converted = view.translation.textures.image(node.image, node.image_user, view.warn)
    if converted is None:
        return _plain_layer(MISSING, factor, seen_by)
    return basicrt.EnvironmentLayer(
        radiance=(factor, factor, factor),
        image=converted.image,
        projection=_PROJECTIONS[node.projection],
        interpolation=INTERPOLATIONS[node.interpolation],
        transform=_direction_matrix(view),
        seen_by=seen_by,
    )
