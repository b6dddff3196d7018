# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's cameras: lens, sensor fit, shift, pixel aspect and depth of field."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

import basicrt

from ..report import Report

Camera = (
    basicrt.PerspectiveCamera
    | basicrt.OrthographicCamera
    | basicrt.EquirectangularCamera
    | basicrt.FisheyeEquidistantCamera
    | basicrt.FisheyeEquisolidCamera
    | basicrt.FisheyePolynomialCamera
    | basicrt.CubemapFaceCamera
    | basicrt.CylindricalCamera
)


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
    if b_camera.type == "ORTHO":
        return _fitted_window(b_camera, b_render, b_camera.ortho_scale)
    return _fitted_window(b_camera, b_render, _sensor(b_camera) / b_camera.lens)


def _sensor(b_camera: bpy.types.Camera) -> float:
    """The side of the sensor that is fitted, mm."""
    is_vertical = b_camera.sensor_fit == "VERTICAL"
    return b_camera.sensor_height if is_vertical else b_camera.sensor_width


def _fitted_window(
    b_camera: bpy.types.Camera, b_render: bpy.types.RenderSettings, size: float
) -> Window:
    """The window whose fitted side is `size` wide or high."""
    width, height = resolution(b_render)
    x, y = width * b_render.pixel_aspect_x, height * b_render.pixel_aspect_y
    fit = b_camera.sensor_fit
    is_horizontal = fit == "HORIZONTAL" or (fit == "AUTO" and x >= y)
    pixel = size / (x if is_horizontal else y)
    half_x, half_y = 0.5 * x * pixel, 0.5 * y * pixel
    center_x, center_y = b_camera.shift_x * size, b_camera.shift_y * size
    return Window((center_x - half_x, center_y - half_y), (center_x + half_x, center_y + half_y))


def _shifted(b_camera: bpy.types.Camera, lower: Any, upper: Any) -> dict[str, Any]:
    """A panorama's window: shifts are in parts of its width and height, pixel aspect doesn't count."""
    low, high = np.array(lower, float), np.array(upper, float)
    shift = np.array((b_camera.shift_x, b_camera.shift_y)) * (high - low)
    return {"window_min": tuple(low + shift), "window_max": tuple(high + shift)}


def _shifted_sensor(
    b_camera: bpy.types.Camera, b_render: bpy.types.RenderSettings
) -> dict[str, Any]:
    """The window of a panorama that has a sensor, mm."""
    whole = _fitted_window(b_camera, b_render, _sensor(b_camera))
    half_x = 0.5 * (whole.upper[0] - whole.lower[0])
    half_y = 0.5 * (whole.upper[1] - whole.lower[1])
    return _shifted(b_camera, (-half_x, -half_y), (half_x, half_y))


def _equirectangular(b_camera: Any, _b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    shown = _shifted(
        b_camera,
        (b_camera.longitude_min, b_camera.latitude_min),
        (b_camera.longitude_max, b_camera.latitude_max),
    )
    return basicrt.EquirectangularCamera, shown


def _equidistant(b_camera: Any, _b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    half = b_camera.fisheye_fov / 2
    shown = _shifted(b_camera, (-half, -half), (half, half))
    return basicrt.FisheyeEquidistantCamera, {"fov": b_camera.fisheye_fov, **shown}


def _equisolid(b_camera: Any, b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    lens = {"fov": b_camera.fisheye_fov, "focal_length": b_camera.fisheye_lens}
    return basicrt.FisheyeEquisolidCamera, {**lens, **_shifted_sensor(b_camera, b_render)}


def _polynomial(b_camera: Any, b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    """Blender's polynomial is the angle's negative."""
    lens = {f"k{i}": -getattr(b_camera, f"fisheye_polynomial_k{i}") for i in range(5)}
    shown = _shifted_sensor(b_camera, b_render)
    return basicrt.FisheyePolynomialCamera, {"fov": b_camera.fisheye_fov, **lens, **shown}


def _mirror_ball(b_camera: Any, _b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    """A ball of radius 1 seen from afar shows equal solid angles in equal areas."""
    lens = {"fov": 2 * math.pi, "focal_length": 0.5}
    return basicrt.FisheyeEquisolidCamera, {**lens, **_shifted(b_camera, (-1, -1), (1, 1))}


def _cubemap_face(b_camera: Any, _b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    half = math.pi / 4
    return basicrt.CubemapFaceCamera, _shifted(b_camera, (-half, -half), (half, half))


def _cylindrical(b_camera: Any, _b_render: Any) -> tuple[type[Camera], dict[str, Any]]:
    radius = b_camera.central_cylindrical_radius
    shown = _shifted(
        b_camera,
        (
            b_camera.central_cylindrical_range_u_min,
            b_camera.central_cylindrical_range_v_min / radius,
        ),
        (
            b_camera.central_cylindrical_range_u_max,
            b_camera.central_cylindrical_range_v_max / radius,
        ),
    )
    return basicrt.CylindricalCamera, shown


# What becomes of each panorama_type: a class, and its window and lens.
_PANORAMAS: dict[str, Callable[[Any, Any], tuple[type[Camera], dict[str, Any]]]] = {
    "EQUIRECTANGULAR": _equirectangular,
    "EQUIANGULAR_CUBEMAP_FACE": _cubemap_face,
    "MIRRORBALL": _mirror_ball,
    "FISHEYE_EQUIDISTANT": _equidistant,
    "FISHEYE_EQUISOLID": _equisolid,
    "FISHEYE_LENS_POLYNOMIAL": _polynomial,
    "CENTRAL_CYLINDRICAL": _cylindrical,
}


def _kind(
    b_camera: Any, b_render: bpy.types.RenderSettings, item: str, report: Report
) -> tuple[type[Camera], dict[str, Any]]:
    """A camera's class and what only that one has."""
    if b_camera.type == "PANO":
        if b_camera.panorama_type in _PANORAMAS:
            return _PANORAMAS[b_camera.panorama_type](b_camera, b_render)
        kind = f"panorama {b_camera.panorama_type}"
        report.warn(item, f"{kind} is not supported: drawn in perspective")
    elif b_camera.type not in ("PERSP", "ORTHO"):
        report.warn(item, f"type {b_camera.type} is not supported: drawn in perspective")
    shown = window(b_camera, b_render)
    is_parallel = b_camera.type == "ORTHO"
    make = basicrt.OrthographicCamera if is_parallel else basicrt.PerspectiveCamera
    return make, {"window_min": shown.lower, "window_max": shown.upper}


def focus_distance(b_object: bpy.types.Object) -> float:
    """How deep along the view the plane in focus lies: as given, or where the focus object is."""
    b_camera: Any = b_object.data
    b_focus = b_camera.dof.focus_object
    if b_focus is None:
        return float(b_camera.dof.focus_distance)
    matrix = b_focus.matrix_world
    if b_focus.pose is not None and b_camera.dof.focus_subtarget:
        b_bone = b_focus.pose.bones.get(b_camera.dof.focus_subtarget)
        if b_bone is not None:
            matrix = matrix @ b_bone.matrix
    b_matrix = b_object.matrix_world.normalized()
    return float(abs((matrix.translation - b_matrix.translation).dot(b_matrix.col[2].to_3d())))


def aperture(b_object: bpy.types.Object) -> dict[str, Any]:
    """The lens that blurs what is out of focus, in metres; nothing where all is sharp."""
    b_camera: Any = b_object.data
    dof = b_camera.dof
    if not dof.use_dof:
        return {}
    # An orthographic camera has no focal length: f-stops are of one metre.
    length = 1.0 if b_camera.type == "ORTHO" else b_camera.lens * 1e-3
    return {
        "aperture_radius": length / (2 * max(dof.aperture_fstop, 1e-5)),
        "aperture_blades": dof.aperture_blades,
        "aperture_rotation": dof.aperture_rotation,
        "aperture_ratio": dof.aperture_ratio,
        "focus_distance": max(focus_distance(b_object), 1e-5),
    }


def transform(b_object: bpy.types.Object) -> NDArray[np.float64]:
    """Camera to world, (4, 4); the object's scale does not count."""
    return np.array(b_object.matrix_world.normalized(), np.float64)


def convert(
    b_object: bpy.types.Object, b_render: bpy.types.RenderSettings, report: Report
) -> Camera:
    """The camera of an evaluated camera object; its scale does not count."""
    b_camera = b_object.data
    assert isinstance(b_camera, bpy.types.Camera)
    make, values = _kind(b_camera, b_render, f'camera "{b_object.name}"', report)
    return make(
        transform=transform(b_object),
        clip_near=b_camera.clip_start,
        clip_far=b_camera.clip_end,
        **aperture(b_object),
        **values,
    )
