# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes whose output is a constant."""

from __future__ import annotations

from typing import Any

from .node_view import Color, NodeView, value


@value("ShaderNodeRGB")
def rgb(view: NodeView) -> Color:
    """The colour that the node shows."""
    output: Any = view.node.outputs[0]
    red, green, blue, _alpha = output.default_value
    return float(red), float(green), float(blue)


@value("ShaderNodeValue")
def number(view: NodeView) -> float:
    """The number that the node shows."""
    output: Any = view.node.outputs[0]
    return float(output.default_value)
