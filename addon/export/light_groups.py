# SPDX-License-Identifier: GPL-3.0-or-later
"""Light groups: Blender's have names in each view layer, the core's are numbered from 1 on."""

from __future__ import annotations

from typing import Any

import bpy

import basicrt

from ..report import Report

_PREFIX = "Light Group "
_LIMIT = sum(info.name.startswith(_PREFIX) for info in basicrt.passes())


def numbers(b_view_layer: bpy.types.ViewLayer, report: Report | None = None) -> dict[str, int]:
    """Each group's number by its name. Those that the core has no numbers left for are reported."""
    names = [group.name for group in b_view_layer.lightgroups]
    for name in names[_LIMIT:] if report is not None else ():
        assert report is not None
        item = f'view layer "{b_view_layer.name}"'
        report.warn(item, f'there are {_LIMIT} light groups at the most: "{name}" is left out')
    return {name: number for number, name in enumerate(names[:_LIMIT], 1)}


def number_of(owner: bpy.types.Object | bpy.types.World | None, groups: dict[str, int]) -> int:
    """That of the group that an object or a world is in; 0 is none."""
    data: Any = owner
    return groups.get(data.lightgroup, 0) if owner is not None else 0


def pass_names(b_view_layer: bpy.types.ViewLayer) -> dict[str, str]:
    """Blender's names of the core's passes of light groups."""
    groups = numbers(b_view_layer)
    return {f"{_PREFIX}{number:02}": f"Combined_{name}" for name, number in groups.items()}
