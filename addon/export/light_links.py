# SPDX-License-Identifier: GPL-3.0-or-later
"""Light linking and shadow linking: which lights light an object, and which objects dim a light."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy

from ..report import Report
from .identity import uid

_SETS = 64  # that the core has; number 0 is of objects that no collection names
_CHOICES_OF_BLOCKERS = 24  # that lights may make


@dataclass
class _Linking:
    """The objects that lights' collections name, in sets of those that are named alike."""

    set_of: dict[int, int] = field(default_factory=dict)  # by the object's number
    # The sets that a light's collection lets in, by the collection's number; None: all.
    chosen: dict[int, list[int] | None] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.set_of or self.chosen)


@dataclass
class LightLinks:
    """Whom the lights of a scene light, and what dims them."""

    _receivers: _Linking = field(default_factory=_Linking)
    _blockers: _Linking = field(default_factory=_Linking)

    def apply(self, converted: Any, b_object: Any) -> None:
        """Tell a lamp of the core about the links of an object."""
        lit, blockers = self._lit_by(b_object)
        converted.lit_sets = None if lit is None else list(lit)
        converted.blocker_sets = None if blockers is None else list(blockers)

    def of_instance(self, b_object: Any, b_parent: Any) -> dict[str, Any]:
        """Those of an object that `b_parent` may have placed, by the core's names; none where nothing is linked."""
        if not (self._receivers or self._blockers):
            return {}
        lit, blockers = self._lit_by(b_object)
        return {
            "lit_sets": lit,
            "blocker_sets": blockers,
            "receiver_set": _set_of(self._receivers, b_object, b_parent),
            "blocker_set": _set_of(self._blockers, b_object, b_parent),
        }

    def _lit_by(self, b_object: Any) -> tuple[Any, Any]:
        """The sets that an object lights and those that dim it."""
        b_links = b_object.original.light_linking
        lit = _chosen(self._receivers, b_links.receiver_collection)
        return lit, _chosen(self._blockers, b_links.blocker_collection)


def read(b_scene: Any, report: Report) -> LightLinks:
    """All links between objects. What the core has no room for is reported."""
    b_objects: list[Any] = list(bpy.data.objects)  # what is only placed by others, too
    links = [b_object.light_linking for b_object in b_objects]
    item = f'scene "{b_scene.name}"'
    receivers = _linking([one.receiver_collection for one in links], item, report)
    blockers = _linking([one.blocker_collection for one in links], item, report)
    choices: list[list[int] | None] = []
    for number, sets in blockers.chosen.items():
        if sets is None or sets in choices:
            continue
        if len(choices) < _CHOICES_OF_BLOCKERS:
            choices.append(sets)
            continue
        blockers.chosen[number] = None
        most = f"there are {_CHOICES_OF_BLOCKERS} different shadow links at the most"
        report.warn(item, f"{most}: all objects dim some of its lights")
    return LightLinks(receivers, blockers)


def _linking(b_collections: list[Any], item: str, report: Report) -> _Linking:
    """By the collections of all lights, some of which may be None."""
    named: dict[int, dict[int, bool]] = {}  # by object: whether each collection lets it in
    used = {uid(one): one for one in b_collections if one is not None}
    for number, b_collection in used.items():
        for b_object, is_included in _members(b_collection):
            named.setdefault(uid(b_object), {})[number] = is_included

    linking = _Linking()
    sets: dict[frozenset[tuple[int, bool]], int] = {}
    for number, states in named.items():
        index = sets.setdefault(frozenset(states.items()), len(sets) + 1)
        if index < _SETS:
            linking.set_of[number] = index
    if len(sets) >= _SETS:
        most = f"its objects can be linked to lights in {_SETS - 1} ways at the most, there are"
        report.warn(item, f"{most} {len(sets)}: some objects are taken for unlinked")
    for number in used:
        linking.chosen[number] = _let_in(number, sets)
    return linking


def _let_in(collection: int, sets: dict[frozenset[tuple[int, bool]], int]) -> list[int] | None:
    """The sets that a collection lets in: those it includes, or all if it includes none, but those it excludes."""
    states = {index: dict(of_set).get(collection) for of_set, index in sets.items()}
    includes = any(state is True for state in states.values())
    excludes = any(state is False for state in states.values())
    if not (includes or excludes):
        return None
    kept = [index for index in range(_SETS) if states.get(index) is not False]
    return [index for index in kept if states.get(index) is True] if includes else kept


def _members(b_collection: Any) -> Iterator[tuple[Any, bool]]:
    """Objects of a light's collection and whether it includes or excludes them: the last word counts."""
    children = b_collection.collection_children
    for b_child, b_state in zip(b_collection.children, children, strict=True):
        is_included = b_state.light_linking.link_state == "INCLUDE"
        for b_object in _inner_objects(b_child):
            yield b_object, is_included
    objects = b_collection.collection_objects
    for b_object, b_state in zip(b_collection.objects, objects, strict=True):
        yield b_object, b_state.light_linking.link_state == "INCLUDE"


def _inner_objects(b_collection: Any) -> Iterator[Any]:
    for b_child in b_collection.children:
        yield from _inner_objects(b_child)
    yield from b_collection.objects


def _chosen(linking: _Linking, b_collection: Any) -> tuple[int, ...] | None:
    sets = None if b_collection is None else linking.chosen.get(uid(b_collection))
    return None if sets is None else tuple(sets)


def _set_of(linking: _Linking, b_object: Any, b_parent: Any) -> int:
    """That of what placed the object, if it is in one."""
    of_parent = linking.set_of.get(uid(b_parent), 0) if b_parent is not None else 0
    return of_parent or linking.set_of.get(uid(b_object), 0)
