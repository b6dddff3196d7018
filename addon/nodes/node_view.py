# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender node as the translating functions see it: inputs by identifier, as numbers or shaders."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy

import basicrt

from .. import compat
from ..report import Report
from .graph import Groups, Place, find_socket, trace
from .images import Textures, is_tiled
from .mesh_data import MeshData, ObjectData
from .operations import OPERATIONS, Value, as_vector, output_value, raw_value, value_at
from .operations import as_number as number_of

Color = tuple[float, float, float]
NodeIndex = int | None
ShaderFunction = Callable[["NodeView"], NodeIndex]
TextureFunction = Callable[["NodeView"], int]

# bl_idname -> the function that translates such a node.
SHADERS: dict[str, ShaderFunction] = {}
# bl_idname -> the function that gives the index of such a node's texture in the scene.
TEXTURES: dict[str, TextureFunction] = {}


def shader(*bl_idnames: str) -> Callable[[ShaderFunction], ShaderFunction]:
    """Decorates the function that translates these nodes."""

    def register(function: ShaderFunction) -> ShaderFunction:
        SHADERS.update(dict.fromkeys(bl_idnames, function))
        return function

    return register


def texture(*bl_idnames: str) -> Callable[[TextureFunction], TextureFunction]:
    """Decorates the function that makes these nodes' texture."""

    def register(function: TextureFunction) -> TextureFunction:
        TEXTURES.update(dict.fromkeys(bl_idnames, function))
        return function

    return register


@dataclass(frozen=True)
class LampObject:
    """What a lamp's nodes may ask of the object that it is."""

    kind: str  # as Blender calls it: POINT, SUN, SPOT or AREA
    color: Color = (1.0, 1.0, 1.0)
    alpha: float = 1.0
    pass_index: int = 0
    random: float = 0.0


@dataclass
class Translation:
    """A material in the making."""

    item: str  # what warnings name: `material "Glass"`
    report: Report
    material: basicrt.Material
    textures: Textures
    # A volume is the same everywhere: nothing in it may vary.
    is_volume: bool = False
    # A world is seen from its middle: its nodes read directions.
    is_world: bool = False
    # A lamp's nodes see places on the lamp.
    lamp: LampObject | None = None
    library: Any = None  # the file that it is linked from
    # Of a displacement only by how much it raises the surface counts: bumps are made of it.
    is_height: bool = False
    # What shaders have that nothing is linked to: zero is the surface's own, as it is.
    normal: Color | basicrt.OperationRef = (0.0, 0.0, 0.0)
    # What it asks for of meshes.
    mesh_data: set[MeshData] = field(default_factory=set)
    object_data: set[ObjectData] = field(default_factory=set)  # and of objects
    # Nodes that are done: one node may feed several others.
    done: dict[tuple[int, ...], NodeIndex] = field(default_factory=dict)
    # The same for the outputs of value nodes.
    values: dict[tuple[Any, ...], Value | None] = field(default_factory=dict)

    def warn(self, message: str) -> None:
        """Tell of something that is not as in Blender."""
        self.report.warn(self.item, message)

    def shader_at(self, place: Place) -> NodeIndex:
        """The shader that arrives at an input."""
        source = trace(place)
        if not source.socket.is_output:
            return None
        node: Any = source.socket.node
        address = tuple(n.as_pointer() for n in (*source.groups, node))
        if address not in self.done:
            self.done[address] = self._translate(NodeView(node, source.groups, self), place)
        return self.done[address]

    def _translate(self, view: NodeView, place: Place) -> NodeIndex:
        """The shader that a node makes; a colour shines, as Blender has it."""
        if self.lamp is not None and view.bl_idname in SHADERS.keys() - _LAMP_SHADERS:
            self.warn(f"{view.title} is not supported: black instead")
            return None
        if view.bl_idname in SHADERS:
            return SHADERS[view.bl_idname](view)
        if view.bl_idname in TEXTURES and not self.is_volume and is_over_uv(view):
            reference = basicrt.TextureRef(TEXTURES[view.bl_idname](view))
            return view.add(basicrt.EmissionShader(radiance=reference))
        if view.bl_idname in OPERATIONS:
            value = output_value(self, trace(place)) if self.is_volume else value_at(view, place)
            radiance = None if value is None else as_vector(value)
            if isinstance(radiance, tuple):
                return view.add(basicrt.EmissionShader(radiance=positive(radiance)))
            if radiance is not None and not self.is_volume:
                return view.add(basicrt.EmissionShader(radiance=radiance))
        if self.is_volume:
            self.warn(f"{view.title} is not supported in a volume and left out")
            return None
        self.warn(f"{view.title} is not supported: drawn as diffuse grey")
        return view.add(basicrt.DiffuseShader(color=(0.8, 0.8, 0.8), twosided=True))


# Others don't shine.
_LAMP_SHADERS = {
    "ShaderNodeEmission",
    "ShaderNodeBsdfPrincipled",
    "ShaderNodeMixShader",
    "ShaderNodeAddShader",
}


@dataclass(frozen=True)
class NodeView:
    """One node of a tree that is being translated."""

    node: bpy.types.Node
    groups: Groups
    translation: Translation

    @property
    def bl_idname(self) -> str:
        """The node's kind."""
        return self.node.bl_idname

    @property
    def title(self) -> str:
        """How warnings call it."""
        return f'node "{compat.node_name(self.node)}"'

    def warn(self, message: str) -> None:
        """Tell of something about this node that is not as in Blender."""
        self.translation.warn(f"{self.title}: {message}")

    def add(self, made: Any) -> int:
        """Append a shader to the material."""
        return int(self.translation.material.add(made))

    def number(self, identifier: str, lowest: float = 0.0, highest: float = math.inf) -> float:
        """The value of an input, within limits beyond which Blender's own renderers don't go."""
        return min(max(as_number(self._value(identifier)), lowest), highest)

    def vector(self, identifier: str) -> Color:
        """The three numbers of an input."""
        return as_color(self._value(identifier))

    def share(self, identifier: str) -> float | basicrt.TextureRef | basicrt.OperationRef:
        """A number in [0, 1] that may vary."""
        return self.varying_number(identifier, 0.0, 1.0)

    def varying_number(
        self, identifier: str, lowest: float = 0.0, highest: float = math.inf
    ) -> float | basicrt.TextureRef | basicrt.OperationRef:
        """number(), or what varies."""
        reference = self._varying_at(identifier, is_share=True)
        return self.number(identifier, lowest, highest) if reference is None else reference

    def normal(self, identifier: str = "Normal") -> Color | basicrt.OperationRef:
        """A normal in world space; zero is the surface's own."""
        if self._output_at(identifier) is None:
            return self.translation.normal
        found: Any = self._varying_at(identifier)
        if found is None:
            self.ignore(**{identifier.replace(" ", "_"): None})
            return self.translation.normal
        normal: Color | basicrt.OperationRef = found
        return normal

    def color(self, identifier: str) -> Color | basicrt.TextureRef | basicrt.OperationRef:
        """A colour that reflects or lets through: each channel in [0, 1]."""
        reference = self._varying_at(identifier)
        if reference is not None:
            return reference
        color = as_color(self._value(identifier))
        if max(color) > 1.0:
            self.warn(f"{identifier} reflects more light than it receives: limited to 1")
        return unit(color)

    def any_color(self, identifier: str) -> Color | basicrt.TextureRef | basicrt.OperationRef:
        """Three numbers that may vary, whatever they are."""
        reference = self._varying_at(identifier)
        return self.vector(identifier) if reference is None else reference

    def light(self, identifier: str) -> Color:
        """A colour that shines: at least 0."""
        return positive(as_color(self._value(identifier)))

    def varying_light(self, identifier: str) -> Color | basicrt.TextureRef | basicrt.OperationRef:
        """light(), or what varies."""
        reference = self._varying_at(identifier)
        return self.light(identifier) if reference is None else reference

    def radiance(
        self, color: str, strength: str
    ) -> tuple[
        Color | basicrt.TextureRef | basicrt.OperationRef,
        float | basicrt.TextureRef | basicrt.OperationRef,
    ]:
        """A colour that shines and may vary, and what multiplies it: 1 where both are constant."""
        factor = self.varying_number(strength)
        reference = self._varying_at(color)
        if reference is not None:
            return reference, factor
        if not isinstance(factor, float):
            return self.light(color), factor
        return scaled(self.light(color), factor), 1.0

    def is_linked(self, identifier: str) -> bool:
        """Whether anything feeds an input."""
        return self._output_at(identifier) is not None

    def shader(self, identifier: str) -> NodeIndex:
        """The shader at an input, None where nothing is linked."""
        socket = find_socket(self.node.inputs, identifier)
        return self.translation.shader_at(Place(socket, self.groups)) if socket else None

    def ignore(self, **neutral: float | Color | None) -> None:
        """Warn of inputs that have an effect here but not in BasicRT.

        Underscores stand for spaces; None means that only a link has an effect. An input that this
        Blender's node doesn't have is passed over.
        """
        for name, harmless in neutral.items():
            identifier = name.replace("_", " ")
            socket = find_socket(self.node.inputs, identifier)
            if socket is None:
                continue
            source = trace(Place(socket, self.groups)).socket
            if source.is_output or (harmless is not None and raw_value(source) != harmless):
                self.warn(f"{identifier} is not supported and left out")

    def _output_at(self, identifier: str) -> Place | None:
        """The output that feeds an input, None where nothing does or there is no such input."""
        socket = find_socket(self.node.inputs, identifier)
        source = trace(Place(socket, self.groups)) if socket else None
        return source if source and source.socket.is_output else None

    def _varying_at(
        self, identifier: str, is_share: bool = False
    ) -> basicrt.TextureRef | basicrt.OperationRef | None:
        """What varies and is linked to an input, None where nothing is or may be."""
        texture = self._texture_at(identifier, is_share)
        if texture is not None or self.translation.is_volume:
            return texture
        source = self._output_at(identifier)
        value = output_value(self.translation, source) if source else None
        if value is None:
            return None
        data = number_of(self.translation, value) if is_share else as_vector(value)
        return data if isinstance(data, basicrt.OperationRef) else None

    def _texture_at(self, identifier: str, is_share: bool = False) -> basicrt.TextureRef | None:
        """The texture that is linked to an input, None where none is or may be."""
        if self.translation.is_volume:
            return None
        source = self._output_at(identifier)
        node: Any = source.socket.node if source else None
        if source is None or node.bl_idname not in TEXTURES:
            return None
        is_alpha = source.socket.identifier == "Alpha"
        if is_alpha and not is_share:
            return None
        view = NodeView(node, source.groups, self.translation)
        if not is_over_uv(view):
            return None
        return basicrt.TextureRef(TEXTURES[node.bl_idname](view), alpha=is_alpha)

    def _value(self, identifier: str) -> float | Color:
        """An input's constant value; its own, with a warning, where the link can't be evaluated."""
        socket = find_socket(self.node.inputs, identifier)
        if socket is None:
            raise KeyError(f"{self.bl_idname} has no input {identifier}")
        source = trace(Place(socket, self.groups))
        if not source.socket.is_output:
            return raw_value(source.socket)
        node: Any = source.socket.node
        found = output_value(self.translation, source)
        if found is not None and not isinstance(found.data, basicrt.OperationRef):
            return found.data
        self.warn(
            f'{identifier} is linked to "{compat.node_name(node)}", which is not supported: its own value is used'
        )
        return raw_value(socket)


def is_over_uv(view: NodeView) -> bool:
    """Whether a texture is looked up by uv coordinates, moved by constants at most."""
    node: Any = view.node
    if getattr(node, "projection", "FLAT") != "FLAT" or is_tiled(node):
        return False
    socket = find_socket(node.inputs, "Vector")
    source = trace(Place(socket, view.groups)) if socket else None
    if source is None or not source.socket.is_output:
        return True
    origin = NodeView(source.socket.node, source.groups, view.translation)  # type: ignore[arg-type]
    if origin.bl_idname == "ShaderNodeUVMap":
        return not origin.node.uv_map and not origin.node.from_instancer  # type: ignore[attr-defined]
    if origin.bl_idname == "ShaderNodeTexCoord":
        return source.socket.identifier == "UV" and not origin.node.from_instancer  # type: ignore[attr-defined]
    if origin.bl_idname != "ShaderNodeMapping" or origin.node.vector_type == "NORMAL":  # type: ignore[attr-defined]
        return False
    moves = (find_socket(origin.node.inputs, name) for name in ("Location", "Rotation", "Scale"))
    is_constant = not any(trace(Place(s, origin.groups)).socket.is_output for s in moves if s)
    return is_constant and is_over_uv(origin)


def as_number(value: float | Color) -> float:
    """As Blender converts a colour to a number: its luminance (Rec. 709)."""
    if isinstance(value, float):
        return value
    return 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2]


def as_color(value: float | Color) -> Color:
    """As Blender converts a number to a colour: grey."""
    return (value, value, value) if isinstance(value, float) else value


def positive(color: Color) -> Color:
    """Without negative channels."""
    return max(color[0], 0.0), max(color[1], 0.0), max(color[2], 0.0)


def unit(color: Color) -> Color:
    """With each channel in [0, 1]."""
    red, green, blue = positive(color)
    return min(red, 1.0), min(green, 1.0), min(blue, 1.0)


def scaled(color: Color, factor: float) -> Color:
    """The colour times a number."""
    return color[0] * factor, color[1] * factor, color[2] * factor
