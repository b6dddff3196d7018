# SPDX-License-Identifier: GPL-3.0-or-later
"""AOV Output nodes: what a material writes into passes of the view layer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import basicrt

from .graph import Groups
from .node_view import NodeView, Translation


def _nodes(tree: Any, groups: Groups = ()) -> Iterator[tuple[Any, Groups]]:
    """Those of a tree and of the groups in it, each with the group nodes that lead to it."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.bl_idname == "ShaderNodeOutputAOV":
            yield node, groups
        elif node.type == "GROUP" and node.node_tree is not None:
            yield from _nodes(node.node_tree, (*groups, node))


def translate(translation: Translation, tree: Any) -> None:
    """Add those whose name the view layer has."""
    numbers = translation.textures.aovs
    for node, groups in _nodes(tree) if numbers else ():
        number = numbers.get(node.aov_name)
        if number is None:
            continue
        view = NodeView(node, groups, translation)
        view.add(
            basicrt.AovShader(
                number=number,
                color=view.any_color("Color"),
                value=view.varying_number("Value", -math.inf),
            )
        )
