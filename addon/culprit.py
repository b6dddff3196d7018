# SPDX-License-Identifier: GPL-3.0-or-later
"""What a warning is about, found by its text: warnings outlive the data that they name."""

from __future__ import annotations

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

    Names may hold anything, so that what there is is looked for in the text, not the text taken apart.
    """
    for kind, names in _names():
        found = [name for name in names if text.startswith(f'{kind} "{name}": ')]
        if found:
            name = max(found, key=len)
            return Culprit(kind, name, _node_in(text[len(f'{kind} "{name}": ') :], kind, name))
    return None


def _names() -> Iterator[tuple[str, list[str]]]:
    data = bpy.data
    yield "object", [b_object.name for b_object in data.objects]
    yield "material", [material.name for material in data.materials]
    yield "light", [*(light.name for light in data.lights), *_objects_named("LIGHT")]
    yield "camera", _objects_named("CAMERA")
    yield "world", [world.name for world in data.worlds]


def _objects_named(kind: str) -> list[str]:
    return [b_object.name for b_object in bpy.data.objects if b_object.type == kind]


def _node_in(message: str, kind: str, name: str) -> str | None:
    """The node that the rest of a warning begins with."""
    tree = tree_of(kind, name)
    if tree is None:
        return None
    names = [node for node in names_in(tree) if message.startswith(f'node "{node}"')]
    return max(names, key=len, default=None)


def tree_of(kind: str, name: str) -> Any:
    """The nodes of a material, light or world; None where there are none."""
    tables: dict[str, Any] = {
        "material": bpy.data.materials,
        "light": bpy.data.lights,
        "world": bpy.data.worlds,
    }
    owner = tables[kind].get(name) if kind in tables else None
    return owner.node_tree if owner else None


def names_in(tree: Any) -> Iterator[str]:
    """Those of a tree's nodes and of its groups' nodes, as warnings have them."""
    for node in tree.nodes:
        yield node.name
        if getattr(node, "node_tree", None):
            yield from names_in(node.node_tree)
