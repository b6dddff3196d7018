# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's cameras: lens, sensor fit, shift and pixel aspect become a window."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

import basicrt

from ..report import Report


@dataclass(frozen=True)
class Window:
    """The rectangle that the picture shows, on the plane at distance 1 or in metres."""

    lower: tuple[float, float]
    upper: tuple[float, float]


def resolution(b_render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Width and height in pixels, by Blender's integer arithmetic."""
    percentage = b_render.resolution_percentage
    return b_render.resolution_x * percentage // 100, b_render.resolution_y * percentage // 100


def window(b_camera: bpy.types.Camera, b_render: bpy.types.RenderSettings) -> Window:
    """What a camera shows: the sensor's side that is fitted to the picture sets the scale."""
    width, height = resolution(b_render)
    x, y = width * b_render.pixel_aspect_x, height * b_render.pixel_aspect_y
    fit = b_camera.sensor_fit
    is_horizontal = fit == "HORIZONTAL" or (fit == "AUTO" and x >= y)
    if b_camera.type == "ORTHO":
        size = b_camera.ortho_scale
    else:
        sensor = b_camera.sensor_height if fit == "VERTICAL" else b_camera.sensor_width
        size = sensor / b_camera.lens
    pixel = size / (x if is_horizontal else y)
    half_x, half_y = 0.5 * x * pixel, 0.5 * y * pixel
    center_x, center_y = b_camera.shift_x * size, b_camera.shift_y * size
    return Window((center_x - half_x, center_y - half_y), (center_x + half_x, center_y + half_y))


def convert(
    b_object: bpy.types.Object, b_render: bpy.types.RenderSettings, report: Report
) -> basicrt.PerspectiveCamera | basicrt.OrthographicCamera:
    """The camera of an evaluated camera object; its scale does not count."""
    b_camera = b_object.data
    assert isinstance(b_camera, bpy.types.Camera)
    item = f'camera "{b_object.name}"'
    if b_camera.type not in ("PERSP", "ORTHO"):
        report.warn(item, f"type {b_camera.type} is not supported: drawn in perspective")
    if b_camera.dof is not None and b_camera.dof.use_dof:
        report.warn(item, "depth of field is not supported: everything is in focus")
    shown = window(b_camera, b_render)
    make = basicrt.OrthographicCamera if b_camera.type == "ORTHO" else basicrt.PerspectiveCamera
    return make(
        transform=np.array(b_object.matrix_world.normalized(), np.float32),
        window_min=shown.lower,
        window_max=shown.upper,
        clip_near=b_camera.clip_start,
        clip_far=b_camera.clip_end,
    )
