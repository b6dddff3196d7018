# SPDX-License-Identifier: GPL-3.0-or-later
"""What the instances and lights of one update have from the view layer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy

from ..export import light_groups
from ..export.light_links import LightLinks
from ..report import Report


@dataclass
class Layer:
    """Of one update: it holds Blender's data."""

    b_evaluated: Any
    b_original: Any
    b_scene: Any
    is_render: bool
    groups: dict[str, int]  # of lights
    links: LightLinks
    has_holdouts: bool  # whether some collection is one
    has_indirect: bool  # whether some collection is seen indirectly alone


def read_layer(depsgraph: bpy.types.Depsgraph, links: LightLinks, report: Report) -> Layer:
    """The view layer of a dependency graph."""
    b_original: Any = depsgraph.view_layer
    b_collections = list(layer_collections(b_original))
    return Layer(
        b_evaluated=depsgraph.view_layer_eval,
        b_original=b_original,
        b_scene=depsgraph.scene_eval,
        is_render=depsgraph.mode == "RENDER",
        groups=light_groups.numbers(b_original, report),
        links=links,
        has_holdouts=any(one.holdout for one in b_collections),
        has_indirect=any(one.indirect_only for one in b_collections),
    )


def layer_collections(b_view_layer: Any) -> Iterator[Any]:
    """Those of a view layer, each before its children."""
    waiting = [b_view_layer.layer_collection]
    while waiting:
        b_layer = waiting.pop()
        yield b_layer
        waiting.extend(b_layer.children)
