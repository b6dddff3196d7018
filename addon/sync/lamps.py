# SPDX-License-Identifier: GPL-3.0-or-later
"""Placed lamps: the lights of a native scene."""

from __future__ import annotations

from typing import Any

import basicrt

from ..export import light, light_groups
from ..export.identity import random_number
from ..nodes import Textures
from ..report import Report
from .layer import Layer
from .motion import Key
from .shown import Placed


class Lamps:
    """Converts them, and knows which light of the scene each of them is."""

    def __init__(
        self, scene: basicrt.Scene, names: dict[str, list[str]], report: Report, textures: Textures
    ) -> None:
        self._scene = scene
        self._names = names
        self._report = report
        self._textures = textures
        self._lights: dict[Key, int] = {}  # in Scene.lights
        self._materials: dict[Key, int] = {}  # in Scene.materials

    def clear(self) -> None:
        """There are none, but their materials have places."""
        self._scene.lights.clear()
        self._lights.clear()

    def add(self, key: Key, b_instance: Any, layer: Layer) -> None:
        """One more, if it shines."""
        converted = self._convert(key, b_instance, layer)
        if converted is not None:
            self._lights[key] = self._scene.lights.append(converted)

    def touch(self, key: Key, b_object: Any, layer: Layer) -> bool:
        """One that changed; False where it begins to shine, or does not shine any more."""
        if key not in self._lights:
            return False
        converted = self._convert(key, Placed(b_object), layer)
        if converted is not None:
            self._scene.lights[self._lights[key]] = converted
        return converted is not None

    def _convert(self, key: Key, b_instance: Any, layer: Layer) -> Any:
        """None where it doesn't shine."""
        b_object = b_instance.object
        random = random_number(b_instance)
        made = light.convert(
            b_object, b_instance.matrix_world, random, self._report, self._textures
        )
        if made is None:
            return None
        converted, material = made
        converted.light_group = light_groups.number_of(b_object, layer.groups)
        layer.links.apply(converted, b_object)
        if material is not None:
            converted.material = self._put_material(key, b_object, material)
        return converted

    def _put_material(self, key: Key, b_object: Any, material: basicrt.Material) -> int:
        """The index of what a lamp's light varies by, in place of what it was."""
        if key not in self._materials:
            self._names["materials"].append(f'light "{b_object.name}"')
            self._materials[key] = self._scene.materials.append(material)
            return self._materials[key]
        index = self._materials[key]
        self._scene.materials[index] = material
        return index
