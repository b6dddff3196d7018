# SPDX-License-Identifier: GPL-3.0-or-later
"""Value nodes as operations of a material: each function adds those of one node's output."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import basicrt

from .. import compat
from .graph import Place, find_socket, trace

if TYPE_CHECKING:
    from .node_view import NodeView, Translation

Number = float | basicrt.OperationRef
Vector = tuple[float, float, float] | basicrt.OperationRef


@dataclass(frozen=True)
class Value:
    """What arrives at a socket: "number", "color" or "vector", constant or an operation's."""

    kind: str
    data: float | tuple[float, float, float] | basicrt.OperationRef


OperationFunction = Callable[["Operands", str], "Value | None"]
# bl_idname -> the function that adds the operations of a node's output, by its identifier.
OPERATIONS: dict[str, OperationFunction] = {}

_KINDS = {"VALUE": "number", "INT": "number", "BOOLEAN": "number", "RGBA": "color"}


def operation(*bl_idnames: str) -> Callable[[OperationFunction], OperationFunction]:
    """Decorates the function that adds these nodes' operations."""

    def register(function: OperationFunction) -> OperationFunction:
        OPERATIONS.update(dict.fromkeys(bl_idnames, function))
        return function

    return register


@dataclass(frozen=True)
class Operands:
    """A value node in the making: its inputs as what operations take."""

    view: NodeView

    @property
    def node(self) -> Any:
        """The Blender node."""
        return self.view.node

    def add(self, kind: str, made: Any) -> Value:
        """Append an operation."""
        return Value(kind, self.view.translation.material.add_operation(made))

    def number(self, identifier: str, missing: float = 0.0) -> Number:
        """An input as a number; `missing` where this Blender's node has no such input."""
        value = self.value(identifier)
        return missing if value is None else as_number(self.view.translation, value)

    def vector(self, identifier: str, missing: float = 0.0) -> Vector:
        """An input as three numbers."""
        value = self.value(identifier)
        return (missing, missing, missing) if value is None else as_vector(value)

    def grey(self, identifier: str, missing: float = 0.0) -> Vector:
        """An input as a number, thrice."""
        number = self.number(identifier, missing)
        return (number, number, number) if isinstance(number, float) else number

    def is_linked(self, identifier: str) -> bool:
        """Whether something arrives at an input."""
        socket = find_socket(self.node.inputs, identifier)
        return socket is not None and trace(Place(socket, self.view.groups)).socket.is_output

    def value(self, identifier: str) -> Value | None:
        """What arrives at an input, None where there is no such input."""
        socket = find_socket(self.node.inputs, identifier)
        return None if socket is None else value_at(self.view, Place(socket, self.view.groups))


def value_at(view: NodeView, place: Place) -> Value:
    """The value at an input; its own, with a warning, where the link can't be evaluated."""
    source = trace(place)
    if source.socket.is_output:
        found = output_value(view.translation, source)
        if found is not None:
            return found
        view.warn(
            f"{place.socket.name} is linked to {_title(view, source)}, which is not supported: "
            "its own value is used"
        )
        source = place
    return _own_value(source.socket)


def _title(view: NodeView, source: Place) -> str:
    node: Any = source.socket.node
    return type(view)(node, source.groups, view.translation).title


def output_value(translation: Translation, source: Place) -> Value | None:
    """The value of a node's output, None where that is not supported."""
    from .node_view import NodeView

    node: Any = source.socket.node
    address = (*(n.as_pointer() for n in (*source.groups, node)), source.socket.identifier)
    if address not in translation.values:
        function = OPERATIONS.get(node.bl_idname)
        view = NodeView(node, source.groups, translation)
        try:
            found = function(Operands(view), source.socket.identifier) if function else None
        except basicrt.SceneError:  # a setting that only a newer Blender has
            found = None
        translation.values[address] = found
    return translation.values[address]


def _own_value(socket: Any) -> Value:
    data = raw_value(socket)
    is_number = isinstance(data, float)
    return Value("number" if is_number else _KINDS.get(socket.type, "vector"), data)


def raw_value(socket: Any) -> float | tuple[float, float, float]:
    """A socket's constant, a colour without its alpha; 0 for one without, as a shader's."""
    raw = getattr(socket, "default_value", 0.0)
    if isinstance(raw, (int, float)):
        return _finite(raw)
    return _finite(raw[0]), _finite(raw[1]), _finite(raw[2])


def _finite(number: float) -> float:
    """The number, 0 where it is none: constants that Blender computed may be infinite or NaN."""
    return float(number) if math.isfinite(number) else 0.0


def as_number(translation: Translation, value: Value) -> Number:
    """As Blender converts: the luminance of a colour, the mean of a vector."""
    if isinstance(value.data, float):
        return value.data
    if isinstance(value.data, tuple):
        red, green, blue = value.data
        if value.kind == "vector":
            return (red + green + blue) / 3.0
        weights = compat.luminance_weights()
        return weights[0] * red + weights[1] * green + weights[2] * blue
    if value.kind == "number":
        return value.data
    made: Any
    if value.kind == "color":
        weights = compat.luminance_weights()
        made = basicrt.VectorMathOperation("dot_product", value.data, weights)
    else:
        made = basicrt.ComponentOperation(value=value.data, component="average")
    return translation.material.add_operation(made)


def as_vector(value: Value) -> Vector:
    """As Blender converts: a number is grey."""
    if isinstance(value.data, float):
        return value.data, value.data, value.data
    return value.data
