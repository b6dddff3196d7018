# SPDX-License-Identifier: GPL-3.0-or-later
"""AOVs: passes that materials write. Blender's have names in each view layer, the core's are numbered from 1 on."""

from __future__ import annotations

from typing import Any

import bpy

import basicrt

from ..report import Report

_PREFIXES = {"COLOR": "AOV Color ", "VALUE": "AOV Value "}
_LIMIT = sum(info.name.startswith(_PREFIXES["COLOR"]) for info in basicrt.passes())


def _valid(b_view_layer: Any) -> list[Any]:
    return [aov for aov in b_view_layer.aovs if aov.is_valid]


def numbers(b_view_layer: bpy.types.ViewLayer, report: Report | None = None) -> dict[str, int]:
    """Each one's number by its name. Those that the core has no numbers left for are reported."""
    names = [aov.name for aov in _valid(b_view_layer)]
    for name in names[_LIMIT:] if report is not None else ():
        assert report is not None
        item = f'view layer "{b_view_layer.name}"'
        report.warn(item, f'there are {_LIMIT} AOVs at the most: "{name}" is left out')
    return {name: number for number, name in enumerate(names[:_LIMIT], 1)}


def pass_names(b_view_layer: bpy.types.ViewLayer) -> dict[str, str]:
    """Blender's names of the core's passes of AOVs."""
    return {
        f"{_PREFIXES[aov.type]}{number:02}": aov.name
        for number, aov in enumerate(_valid(b_view_layer)[:_LIMIT], 1)
    }
