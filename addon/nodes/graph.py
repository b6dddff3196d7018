# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows links through reroutes, muted nodes and groups, as if none of them were there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy

# The group nodes that one has stepped into, outermost first.
Groups = tuple[bpy.types.Node, ...]


@dataclass(frozen=True)
class Place:
    """A socket, and the group nodes that lead to the tree it is in."""

    socket: bpy.types.NodeSocket
    groups: Groups


def find_socket(
    sockets: bpy.types.bpy_prop_collection[Any], identifier: str
) -> bpy.types.NodeSocket | None:
    """By identifier: the displayed names change from one Blender version to the next."""
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def _link_into(socket: bpy.types.NodeSocket) -> bpy.types.NodeLink | None:
    """The link that feeds an input, if one does."""
    links = socket.links if socket.is_linked else ()
    return next((link for link in links or () if link.is_valid and not link.is_muted), None)


def _step(place: Place, link: bpy.types.NodeLink) -> Place | None:
    """The input that stands for a link's origin when its node only hands values on, else None."""
    node: Any = link.from_node
    output: Any = link.from_socket
    groups = place.groups
    source: Any = None
    if node.mute:
        source = next((i.from_socket for i in node.internal_links if i.to_socket == output), None)
    if node.type == "REROUTE":
        source = node.inputs[0]
    elif node.type == "GROUP" and node.node_tree is not None:
        for inner in node.node_tree.nodes:
            if inner.type == "GROUP_OUTPUT" and inner.is_active_output:
                source, groups = find_socket(inner.inputs, output.identifier), (*groups, node)
                break
    elif node.type == "GROUP_INPUT" and groups:
        source, groups = find_socket(groups[-1].inputs, output.identifier), groups[:-1]
    return Place(source, groups) if source is not None else None


def trace(place: Place) -> Place:
    """Where an input's value comes from: a node's output, or the unlinked input that holds it."""
    while (link := _link_into(place.socket)) is not None:
        before = _step(place, link)
        if before is None:
            is_passed_on = getattr(link.from_node, "mute", False)
            output: Any = link.from_socket
            return place if is_passed_on else Place(output, place.groups)
        place = before
    return place
