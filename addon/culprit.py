# SPDX-License-Identifier: GPL-3.0-or-later
"""What a warning is about, found by its text: warnings outlive the data that they name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy


@dataclass(frozen=True)
class Culprit:
    """What a warning names, among what is in the file now."""

    kind: str  # "object", "material", "light", "camera" or "world"
    name: str
    node: str | None = None


def find_culprit(text: str) -> Culprit | None:
    """What `object "Cube": ...` or `material "Glass": node "Noise Texture": ...` is about; None for other things.

    Names may hold anything: the longest that there is counts. Panels ask whenever they are drawn, so that nothing
    here goes over all objects.
    """
    kind, _, rest = text.partition(' "')
    for end in reversed([found.start() for found in re.finditer('": ', rest)]):
        name = rest[:end]
        if _is_there(kind, name):
            return Culprit(kind, name, _node_in(rest[end + 3 :], kind, name))
    return None


def _is_there(kind: str, name: str) -> bool:
    b_object: Any = bpy.data.objects.get(name)
    is_object = b_object is not None and kind in ("object", b_object.type.lower())
    return is_object or _owner_of_nodes(kind, name) is not None


def _node_in(message: str, kind: str, name: str) -> str | None:
    """The node that the rest of a warning begins with."""
    tree = tree_of(kind, name)
    if tree is None:
        return None
    names = [node for node in names_in(tree) if message.startswith(f'node "{node}"')]
    return max(names, key=len, default=None)


def _owner_of_nodes(kind: str, name: str) -> Any:
    tables: dict[str, Any] = {
        "material": bpy.data.materials,
        "light": bpy.data.lights,
        "world": bpy.data.worlds,
    }
    return tables[kind].get(name) if kind in tables else None


def tree_of(kind: str, name: str) -> Any:
    """The nodes of a material, light or world; None where there are none."""
    owner = _owner_of_nodes(kind, name)
    return owner.node_tree if owner else None


def names_in(tree: Any) -> Iterator[str]:
    """Those of a tree's nodes and of its groups' nodes, as warnings have them."""
    for node in tree.nodes:
        yield node.name
        if getattr(node, "node_tree", None):
            yield from names_in(node.node_tree)
