# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of objects that Attribute nodes read."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..nodes import ObjectData, Surroundings
from ..report import Report

Vector = tuple[float, float, float]


def convert(b_instance: Any, asked: Iterable[ObjectData], report: Report) -> dict[str, Vector]:
    """What a placed object, its data or what instances it has of the properties, by the names in the core.

    With a warning for those that Geometry Nodes may have given to instances.
    """
    converted = {}
    for one in asked:
        owners = _owners(b_instance, of_instancer=one.of_instancer)
        found = Surroundings(owners=owners).attribute(one.name)
        if found is not None:
            converted[one.exported_name] = _numbers(found, is_alpha=one.is_alpha)
        elif one.of_instancer and _is_by_nodes(b_instance):
            report.warn(
                f'object "{b_instance.parent.name}"',
                f'the attribute "{one.name}" of its instances is not known: 0 instead',
            )
    return converted


def _is_by_nodes(b_instance: Any) -> bool:
    """Whether Geometry Nodes may have made an instance."""
    if not b_instance.is_instance or b_instance.parent is None:
        return False
    return any(b_modifier.type == "NODES" for b_modifier in b_instance.parent.modifiers)


def _owners(b_instance: Any, *, of_instancer: bool) -> tuple[Any, ...]:
    """Where to look, in Blender's order."""
    b_object = b_instance.object
    owners = [b_object, b_object.data]
    if of_instancer and b_instance.is_instance:
        b_system = b_instance.particle_system
        owners = [b_system.settings if b_system else None, b_instance.parent, *owners]
    return tuple(owner for owner in owners if owner is not None)


def _numbers(found: float | tuple[float, ...], *, is_alpha: bool) -> Vector:
    """Three numbers: a single one thrice. An alpha that isn't there is 1."""
    if isinstance(found, float):
        return (1.0, 1.0, 1.0) if is_alpha else (found, found, found)
    red, green, blue, *rest = found
    alpha = rest[0] if rest else 1.0
    return (alpha, alpha, alpha) if is_alpha else (red, green, blue)
