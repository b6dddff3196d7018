# SPDX-License-Identifier: GPL-3.0-or-later
"""What a 3D viewport shows: its camera, and the rectangle of it that is rendered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

import basicrt

from ..properties.choice import Choice
from ..report import Report
from . import camera, settings
from .settings import Border

Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class Region:
    """A viewport while Blender draws it: what may be asked about where it looks."""

    b_region: Any  # bpy.types.Region
    b_space: Any  # bpy.types.SpaceView3D
    b_data: Any  # bpy.types.RegionView3D

    @property
    def size(self) -> tuple[int, int]:
        """In pixels."""
        return self.b_region.width, self.b_region.height

    @property
    def camera_object(self) -> Any:
        """The camera that is looked through, None where there is none."""
        is_camera_view = self.b_data.view_perspective == "CAMERA"
        b_object = self.b_space.camera if is_camera_view else None
        return b_object if b_object is not None and b_object.type == "CAMERA" else None


def convert_camera(region: Region, depsgraph: bpy.types.Depsgraph, report: Report) -> camera.Camera:
    """The camera that sees what the region shows, whether it looks through one of the scene or not."""
    projection = np.array(region.b_data.window_matrix, np.float64)
    to_world = np.linalg.inv(np.array(region.b_data.view_matrix, np.float64))
    b_camera = region.camera_object
    evaluated = b_camera.evaluated_get(depsgraph) if b_camera is not None else None
    if evaluated is not None and evaluated.data.type == "PANO":
        return _panorama(region, evaluated, depsgraph, report)
    is_parallel = projection[3, 3] == 1.0
    make = _parallel if is_parallel else _perspective
    lens = camera.aperture(evaluated) if evaluated is not None else {}
    return make(projection, to_world, lens)


def _perspective(projection: Doubles, to_world: Doubles, lens: dict[str, Any]) -> camera.Camera:
    """Of OpenGL's matrix: x / -z is scaled and shifted to [-1, 1]."""
    lower = [(-1.0 + projection[i, 2]) / projection[i, i] for i in (0, 1)]
    upper = [(1.0 + projection[i, 2]) / projection[i, i] for i in (0, 1)]
    return basicrt.PerspectiveCamera(
        transform=to_world,
        window_min=tuple(lower),
        window_max=tuple(upper),
        clip_near=max(projection[2, 3] / (projection[2, 2] - 1.0), 1e-6),
        clip_far=projection[2, 3] / (projection[2, 2] + 1.0),
        **lens,
    )


def _parallel(projection: Doubles, to_world: Doubles, lens: dict[str, Any]) -> camera.Camera:
    """The same; a view from nowhere in particular sees what is behind it too, and so is put further back."""
    lower = [(-1.0 - projection[i, 3]) / projection[i, i] for i in (0, 1)]
    upper = [(1.0 - projection[i, 3]) / projection[i, i] for i in (0, 1)]
    near = (1.0 + projection[2, 3]) / projection[2, 2]
    far = (projection[2, 3] - 1.0) / projection[2, 2]
    back = max(-near, 0.0)
    moved = to_world.copy()
    moved[:3, 3] += back * to_world[:3, 2]
    return basicrt.OrthographicCamera(
        transform=moved,
        window_min=tuple(lower),
        window_max=tuple(upper),
        clip_near=near + back,
        clip_far=far + back,
        **lens,
    )


def _panorama(
    region: Region, b_object: Any, depsgraph: bpy.types.Depsgraph, report: Report
) -> camera.Camera:
    """Blender draws the frame of a panorama as if it were flat: what is in that is the picture."""
    b_scene: Any = depsgraph.scene_eval
    made: Any = camera.convert(b_object, b_scene.render, report)
    frame = _frame(region, b_object, b_scene)
    lower, upper = np.array(made.window_min), np.array(made.window_max)
    scale = (upper - lower) / (frame[1] - frame[0])
    made.window_min = tuple(lower - frame[0] * scale)
    made.window_max = tuple(lower + (np.array(region.size) - frame[0]) * scale)
    return made  # type: ignore[no-any-return]


def _frame(region: Region, b_object: Any, b_scene: Any) -> Doubles:
    """(2, 2): lower left and upper right corner of a camera's picture, in pixels of the region."""
    to_world = b_object.matrix_world.normalized()
    corners = [to_world @ corner for corner in b_object.data.view_frame(scene=b_scene)]
    projected = [region.b_data.perspective_matrix @ Vector((*corner, 1.0)) for corner in corners]
    places = np.array([(corner.x / corner.w, corner.y / corner.w) for corner in projected])
    pixels = (0.5 + 0.5 * places) * np.array(region.size)
    return np.array([pixels.min(axis=0), pixels.max(axis=0)])


def border(region: Region, depsgraph: bpy.types.Depsgraph) -> Border:
    """The pixels of the region that are rendered: the render border, that of the view, or all."""
    width, height = region.size
    b_scene: Any = depsgraph.scene_eval
    b_render, b_space, b_camera = b_scene.render, region.b_space, region.camera_object
    corners = np.array([(0.0, 0.0), (width, height)])
    if b_camera is not None and b_render.use_border:
        frame = _frame(region, b_camera.evaluated_get(depsgraph), b_scene)
        corners = _part_of(frame, b_render, "border")
    elif b_camera is None and b_space.use_render_border:
        corners = _part_of(corners, b_space, "render_border")
    lower = np.clip(np.floor(corners[0] + 0.5), 0, [width - 1, height - 1]).astype(int)
    upper = np.clip(np.floor(corners[1] + 0.5), lower + 1, [width, height]).astype(int)
    return Border(int(lower[0]), int(lower[1]), *(int(size) for size in upper - lower))


def _part_of(corners: Doubles, owner: Any, prefix: str) -> Doubles:
    """(2, 2): the corners of the part of a rectangle that a border of Blender's leaves."""
    parts = [[getattr(owner, f"{prefix}_{end}_{axis}") for axis in "xy"] for end in ("min", "max")]
    made: Doubles = corners[0] + np.array(parts) * (corners[1] - corners[0])
    return made


def convert_settings(
    region: Region, depsgraph: bpy.types.Depsgraph, report: Report
) -> basicrt.RenderSettings:
    """The scene's settings with the region's size and border and the samples of viewports."""
    b_scene: Any = depsgraph.scene_eval
    b_view_layer: Any = depsgraph.view_layer_eval
    made = basicrt.RenderSettings()
    settings.convert(b_scene, b_view_layer, made, report)
    made.width, made.height = region.size
    shown = border(region, depsgraph)
    made.border_x, made.border_y = shown.x, shown.y
    made.border_width, made.border_height = shown.width, shown.height
    made.samples = Choice(b_scene).preview_samples or settings.MOST_SAMPLES
    made.adaptive_threshold = made.time_limit = 0
    made.shutter_curve = []
    made.passes = ["Combined"]
    return made


def shown_pass(region: Region) -> str:
    """The pass that the viewport shows."""
    shading: Any = region.b_space.shading
    name: str = shading.basicrt.render_pass
    return name
