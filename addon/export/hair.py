# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair: Blender's curves, and the strands of particle systems."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

import basicrt

from ..nodes import MeshData, Source
from . import round_attributes
from .hashed import random_numbers

Floats = NDArray[np.float32]

_RADIUS = 0.005  # metres, where Blender has none


def form(b_scene: Any) -> str:
    """What curves look like, by Cycles' setting where it is there."""
    b_settings = getattr(b_scene, "cycles_curves", None)
    shape = "RIBBONS" if b_settings is None else str(b_settings.shape)
    return "ribbon" if shape == "RIBBONS" else "round"


def is_linear(b_scene: Any) -> bool:
    """Whether Cycles would draw straight lines between the points."""
    b_settings = getattr(b_scene, "cycles_curves", None)
    return b_settings is not None and b_settings.shape == "THICK_LINEAR"


def convert(
    b_curves: Any, shape_form: str, asked: Collection[MeshData] = ()
) -> basicrt.Curves | None:
    """Of bpy.types.Curves, None where there are no points.

    Every kind of curve is taken for one that goes through its points, Catmull and Rom's.
    """
    points = round_attributes.read(b_curves, "position", 3)
    if points is None or len(points) == 0:
        return None
    offsets = np.empty(len(b_curves.curves), np.int32)
    b_curves.curves.foreach_get("first_point_index", offsets)
    radii = round_attributes.read(b_curves, "radius", 1)
    if radii is None:
        radii = np.full(len(points), _RADIUS, np.float32)
    uvs = round_attributes.read(b_curves, "surface_uv_coordinate", 2)
    if uvs is None or len(uvs) != len(offsets):
        uvs = np.zeros((len(offsets), 2), np.float32)
    return basicrt.Curves(
        points,
        np.maximum(radii, 0.0),
        offsets,
        form=shape_form,
        randoms=random_numbers(len(offsets)),
        uvs=uvs,
        attributes=round_attributes.convert(b_curves, asked),
    )


def is_all_catmull_rom(b_curves: Any) -> bool:
    """Whether no curve is of another kind, which would be drawn as one."""
    b_types = b_curves.attributes.get("curve_type")
    if b_types is None:
        return True
    kinds = np.zeros(len(b_types.data), np.int8 if b_types.data_type == "INT8" else np.int32)
    b_types.data.foreach_get("value", kinds)
    return not kinds.any()


@dataclass(frozen=True)
class System:
    """A particle system that shows strands of hair."""

    index: int  # in the object's particle systems
    slot: int  # of the object's materials
    pointer: int  # tells it apart during one export


def systems(b_object: Any, is_render: bool) -> list[System]:
    """Those of an evaluated object."""
    found = []
    b_systems = list(b_object.particle_systems)
    for b_modifier in b_object.modifiers if b_systems else ():
        if b_modifier.type != "PARTICLE_SYSTEM":
            continue
        is_shown = b_modifier.show_render if is_render else b_modifier.show_viewport
        b_system = b_modifier.particle_system
        settings = b_system.settings
        if is_shown and settings.type == "HAIR" and settings.render_type == "PATH":
            index = next(i for i, one in enumerate(b_systems) if one.name == b_system.name)
            found.append(System(index, settings.material - 1, b_system.as_pointer()))
    return found


def convert_system(
    b_object: Any, index: int, shape_form: str, is_render: bool
) -> basicrt.Curves | None:
    """The strands of an evaluated object's particle system in the object's space, None without any.

    Where strands have children, those are shown alone, as in Cycles.
    """
    b_system = b_object.particle_systems[index]
    settings = b_system.settings
    parents, children = len(b_system.particles), len(b_system.child_particles)
    if not is_render:
        children = children * settings.display_percentage // 100
    has_children = settings.child_type != "NONE" and children > 0
    first = parents if has_children else 0
    steps = (1 << (settings.render_step if is_render else settings.display_step)) + 1
    if settings.kink == "SPIRAL":
        steps += settings.kink_extra_steps
    strands = _strands(b_object, b_system, range(first, parents + children), steps)
    if not strands:
        return None
    lengths = [len(strand) for _, strand in strands]
    intercepts = [_along(strand) for _, strand in strands]
    uvs = [_root_uv(b_object, b_system, number) for number, _ in strands]
    return basicrt.Curves(
        np.concatenate([strand for _, strand in strands]),
        np.concatenate([_radii(settings, along) for along in intercepts]),
        np.cumsum([0, *lengths[:-1]]),
        form=shape_form,
        intercepts=np.concatenate(intercepts),
        randoms=random_numbers(len(strands)),
        uvs=np.array(uvs, np.float32),
    )


def asks_for_more(asked: Collection[MeshData]) -> bool:
    """Whether materials want of a particle system what it doesn't give: anything but its roots' uv."""
    return any(data != MeshData(Source.UV, "") for data in asked)


def _strands(b_object: Any, b_system: Any, numbers: range, steps: int) -> list[tuple[int, Floats]]:
    """Each strand's number and its points, (N, 3), those that coincide once."""
    to_object: Matrix = b_object.matrix_world.inverted_safe()
    rotation, translation = np.array(to_object)[:3, :3], np.array(to_object)[:3, 3]
    found = []
    for number in numbers:
        places = np.array(
            [b_system.co_hair(b_object, particle_no=number, step=step) for step in range(steps)]
        )
        points = (places @ rotation.T + translation).astype(np.float32)
        is_apart = np.any(points[1:] != points[:-1], axis=1)
        points = points[np.concatenate([[True], is_apart])]
        if len(points) > 1 and np.isfinite(points).all():
            found.append((number, points))
    return found


def _along(points: Floats) -> Floats:
    """(N,): from 0 at the root to 1 at the tip."""
    steps = np.linalg.norm(np.diff(points.astype(np.float64), axis=0), axis=1)
    lengths = np.concatenate([[0.0], np.cumsum(steps)])
    along: Floats = (lengths / lengths[-1]).astype(np.float32)
    return along


def _radii(settings: Any, along: Floats) -> Floats:
    """(N,): between the root's and the tip's by the strand's shape."""
    share = 1.0 - along.astype(np.float64)
    if settings.shape < 0.0:
        share = share ** (1.0 + settings.shape)
    elif settings.shape > 0.0:
        share = share ** (1.0 / max(1.0 - settings.shape, 1e-6))
    root, tip = settings.root_radius, settings.tip_radius
    radii: Floats = (settings.radius_scale * 0.5 * (share * (root - tip) + tip)).astype(np.float32)
    if settings.use_close_tip:
        radii[-1] = 0.0
    return radii


def _root_uv(b_object: Any, b_system: Any, number: int) -> tuple[float, float]:
    """Of the UV map that is active for rendering, where the strand grows; 0 without one."""
    layers = getattr(b_object.data, "uv_layers", ())
    layer = next((i for i, one in enumerate(layers) if one.active_render), None)
    if layer is None or not b_system.particles:
        return 0.0, 0.0
    b_modifier = next(
        one
        for one in b_object.modifiers
        if one.type == "PARTICLE_SYSTEM" and one.particle_system.name == b_system.name
    )
    b_particle = b_system.particles[min(number, len(b_system.particles) - 1)]
    u, v = b_system.uv_on_emitter(b_modifier, particle=b_particle, particle_no=number, uv_no=layer)
    return float(u), float(v)
