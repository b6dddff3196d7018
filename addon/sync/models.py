# SPDX-License-Identifier: GPL-3.0-or-later
"""What instances of the same object have in common: all but where they are, and a few numbers of their own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import basicrt

from .. import compat
from ..export import hair, light_groups, mesh, object_properties, visibility
from ..export.identity import random_number, uid
from ..export.motion import Doubles
from ..nodes import ObjectData, Textures
from ..report import ExportError, Report
from . import geometry
from .changes import Changes
from .layer import Layer
from .shapes import Shapes
from .slots import Materials, Slots

# Kinds of objects that Blender would draw and BasicRT doesn't. (Curves, text and the like come as
# meshes too.)
_UNSUPPORTED = {"VOLUME": "volumes"}
_SUPPORTED = ("MESH", "CURVES", "POINTCLOUD")


@dataclass(slots=True)
class Model:
    """An object, or hair on it, that may be placed many times."""

    kind: basicrt.Instance  # shared with objects that differ in names and places alone
    name: str
    asset_name: str
    shape: int  # in Scene.shapes
    asked: frozenset[ObjectData]  # by its materials, of each instance


@dataclass(slots=True)
class Placement:
    """One instance of a model."""

    model: Model
    transform: Doubles  # (4, 4)
    random: float
    properties: dict[str, Any]

    def instance(self) -> basicrt.Instance:
        """The instance, until the next of the same kind is asked for."""
        model = self.model
        made = model.kind
        made.name, made.asset_name = model.name, model.asset_name
        made.transform, made.random = self.transform, self.random
        if model.asked:
            made.properties = self.properties
        return made


class Models:
    """Those of one update, each made when it is first placed; shapes and materials are kept longer."""

    def __init__(
        self,
        scene: basicrt.Scene,
        names: dict[str, list[str]],
        report: Report,
        textures: Textures,
    ) -> None:
        self.shapes = Shapes(scene, names["shapes"])
        self.materials = Materials(scene, names["materials"], report, textures)
        self._report = report
        # By the numbers of the object and of what places it, the mesh's key and the number of the hair.
        self._models: dict[tuple[int, int, int, int], Model | None] = {}
        self._kinds: dict[Any, basicrt.Instance] = {}  # by all that is in them

    def begin(self, layer: Layer, changes: Changes, present: set[int] | None) -> None:
        """Forget what has changed, and the shapes of objects that are not present any more."""
        self._layer = layer
        self._models.clear()
        self._kinds.clear()
        self.materials.begin()
        if changes.shapes:
            self.shapes.forget(changes.shapes, present)

    def place(
        self, b_instance: Any, owners: tuple[int, int], system: hair.System | None = None
    ) -> Placement | None:
        """One placed object, or hair on it; None where there is nothing to see.

        `owners` are the numbers of the object and of what places it, or 0.
        """
        b_object = b_instance.object
        b_data = b_object.data
        data_key = mesh.key(b_data) if b_data is not None else 0
        key = (*owners, data_key, -1 if system is None else system.index)
        if key in self._models:
            model = self._models[key]
        else:
            b_parent = b_instance.parent if b_instance.is_instance else None
            model = self._model(b_object, b_parent, owners, data_key, system)
            self._models[key] = model
        if model is None:
            return None
        b_matrix = b_instance.matrix_world
        transform = np.array(b_matrix, np.float64)
        determinant = b_matrix.determinant()
        is_odd = determinant == 0.0 or not math.isfinite(determinant)
        if is_odd and self._is_flat(b_object, transform):
            return None
        properties: dict[str, Any] = {}
        if model.asked:
            properties = object_properties.convert(b_instance, model.asked, self._report)
        return Placement(model, transform, random_number(b_instance), properties)

    def _is_flat(self, b_object: Any, transform: Doubles) -> bool:
        """Whether nothing is left of an object. Raises ExportError where it isn't known where it is."""
        if not np.isfinite(transform).all():
            raise ExportError(f'object "{b_object.name}": its transform is not finite')
        is_flat = bool(np.linalg.det(transform[:3, :3].astype(np.float32)) == 0.0)
        if is_flat:
            self._warn(b_object, "scaled to nothing along an axis: left out")
        return is_flat

    def _model(
        self,
        b_object: Any,
        b_parent: Any,
        owners: tuple[int, int],
        data_key: int,
        system: hair.System | None,
    ) -> Model | None:
        """None where there is nothing to see of it anywhere."""
        layer, b_data = self._layer, b_object.data
        if b_object.type in _UNSUPPORTED:
            self._warn(b_object, f"{_UNSUPPORTED[b_object.type]} are not supported: left out")
        if compat.has_adaptive_subdivision(b_object, layer.b_scene):
            self._warn(b_object, "Adaptive Subdivision is not supported: its levels count")
        if b_data is None or not (b_object.type in _SUPPORTED or system):
            return None
        slots = self.materials.slots(b_object, b_data, layer.b_evaluated.material_override)
        shape = self._shape_of(b_object, owners, data_key, slots, system)
        if shape is None:
            return None
        materials = slots.materials
        if system is not None:
            materials = materials[min(system.slot, len(materials) - 1) :][:1]
        name, b_root = b_object.name, b_parent or b_object
        kind = self._kind(b_object, b_parent, shape, materials)
        return Model(kind, name, _asset_name(b_root), shape, slots.asked_of_object)

    def _kind(
        self, b_object: Any, b_parent: Any, shape: int, materials: list[int | None]
    ) -> basicrt.Instance:
        """An instance that lacks its name and place."""
        layer, b_root = self._layer, b_parent or b_object
        red, green, blue, alpha = b_object.color
        values = {
            "shape": shape,
            "materials": tuple(materials),
            "light_group": light_groups.number_of(b_object, layer.groups),
            "visibility": _visibility(b_object, b_parent, layer),
            "color": (red, green, blue),
            "alpha": alpha,
            "holdout": _is_holdout(b_object, b_root, layer),
            "shadow_catcher": b_object.is_shadow_catcher or b_root.is_shadow_catcher,
            "shadow_terminator_offset": compat.shadow_terminator_offset(b_object),
            "shadow_terminator_shading_offset": compat.shadow_terminator_shading_offset(b_object),
            "pass_index": b_object.pass_index,
            **layer.links.of_instance(b_object, b_parent),
        }
        key = tuple(values.values())
        if key not in self._kinds:
            self._kinds[key] = basicrt.Instance(**values)
        return self._kinds[key]

    def _shape_of(
        self,
        b_object: Any,
        owners: tuple[int, int],
        data_key: int,
        slots: Slots,
        system: hair.System | None,
    ) -> int | None:
        """The index of a geometry's shape, None where there is nothing of it."""
        form = hair.form(self._layer.b_scene) if system or b_object.type == "CURVES" else ""
        number = data_key if system is None else system.pointer
        key = (hash((number, form)) if form else number, slots.asked)
        if key not in self.shapes:
            shape = geometry.convert(b_object, slots.asked, system, self._layer, self._report)
            self.shapes.add(key, shape, f'object "{b_object.name}"')
        b_original = b_object.original.data
        objects = owners if owners[1] else owners[:1]
        return self.shapes.index(key, objects, [uid(b_original)] if b_original is not None else [])

    def _warn(self, b_object: Any, message: str) -> None:
        self._report.warn(f'object "{b_object.name}"', message)


def _asset_name(b_root: Any) -> str:
    """What an object is part of: its topmost parent, or that of what instances it."""
    while b_root.parent is not None:
        b_root = b_root.parent
    return str(b_root.name)


def _is_holdout(b_object: Any, b_root: Any, layer: Layer) -> bool:
    """Whether it is a hole in the picture: itself, what instances it, or a collection of it."""
    if b_object.is_holdout or b_root.is_holdout:
        return True
    return layer.has_holdouts and bool(b_root.original.holdout_get(view_layer=layer.b_original))


def _visibility(b_object: Any, b_parent: Any, layer: Layer) -> int:
    """Which rays see an instance: those that may see both the object and what instances it."""
    kinds = int(visibility.object_visibility(b_object))
    if b_parent is not None:
        kinds &= int(visibility.object_visibility(b_parent))
    b_root = b_parent or b_object
    if layer.has_indirect and b_root.original.indirect_only_get(view_layer=layer.b_original):
        kinds &= ~int(basicrt.RayKind.CAMERA)
    return kinds
