# SPDX-License-Identifier: GPL-3.0-or-later
"""The shapes of a native scene: those in use, and the places of those that are not any more."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import basicrt

from ..nodes import MeshData

Geometry = basicrt.Mesh | basicrt.PointCloud | basicrt.Curves
# A geometry's key and what its materials ask for.
ShapeKey = tuple[int, frozenset[MeshData]]


@dataclass
class _Shape:
    index: int | None  # in Scene.shapes; None where the mesh has no faces
    objects: set[int]  # the numbers of those that have it, and of what instances them
    data: set[int]  # the numbers of their data


class Shapes:
    """Converted meshes by their keys, which mean something as long as those that have them don't change."""

    def __init__(self, scene: basicrt.Scene, names: list[str]) -> None:
        self._scene = scene
        self._names = names
        self._shapes: dict[ShapeKey, _Shape] = {}
        self._uses: Counter[int] = Counter()
        self._free: list[int] = []

    def __contains__(self, key: ShapeKey) -> bool:
        return key in self._shapes

    def index(self, key: ShapeKey, objects: Iterable[int], data: Iterable[int]) -> int | None:
        """Of a known shape, which from now on these have too."""
        shape = self._shapes[key]
        shape.objects.update(objects)
        shape.data.update(data)
        return shape.index

    def add(self, key: ShapeKey, shape: Geometry | None, name: str) -> None:
        """A new one; in the place of one that is gone, where there is one."""
        index = None
        if shape is not None and self._free:
            index = self._free.pop()
            self._scene.shapes[index], self._names[index] = shape, name
        elif shape is not None:
            index = self._scene.shapes.append(shape)
            self._names.append(name)
        self._shapes[key] = _Shape(index, set(), set())

    def use(self, index: int) -> None:
        """One more instance has it."""
        self._uses[index] += 1

    def release(self, index: int) -> None:
        """One instance less has it; without any it is gone after sweep()."""
        self._uses[index] -= 1

    def sweep(self) -> None:
        """Do away with those that no instance has any more."""
        gone = {index for index, count in self._uses.items() if count == 0}
        if not gone:
            return
        self._shapes = {key: one for key, one in self._shapes.items() if one.index not in gone}
        for index in sorted(gone, reverse=True):
            del self._uses[index]
            self._scene.shapes[index] = basicrt.Sphere()  # small, and never instanced
            self._free.append(index)

    def forget(self, changed: set[int], present: set[int] | None) -> None:
        """The shapes of these are others now: instances keep the old ones until they get new ones.

        So are those of objects that are no longer present, whose meshes' keys may be others' now.
        """
        for key, one in list(self._shapes.items()):
            is_changed = not changed.isdisjoint(one.objects) or not changed.isdisjoint(one.data)
            if is_changed or (present is not None and not one.objects <= present):
                del self._shapes[key]
