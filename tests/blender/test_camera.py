# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's window is Blender's own camera frame, whatever the fit, shift, aspect and border."""

import bpy
import numpy as np
import pytest
from addon.export import camera
from addon.export.settings import border
from addon.report import Report
from mathutils import Matrix

import basicrt
from support.blender import add_camera, export, new_scene, place


def frame_window(made: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """The window from Blender's view_frame: corners in camera space."""
    corners = np.array(made.data.view_frame(scene=bpy.context.scene))
    if made.data.type == "PERSP":
        corners = corners / -corners[:, 2:]
    return corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("size", [(320, 180), (180, 320), (200, 200)])
@pytest.mark.parametrize("pixel_aspect", [(1.0, 1.0), (2.0, 1.0), (1.0, 1.5)])
def test_window_is_blenders_frame(
    kind: str, fit: str, size: tuple[int, int], pixel_aspect: tuple[float, float]
) -> None:
    scene = new_scene(*size)
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = pixel_aspect
    made = add_camera(
        kind=kind,
        sensor_fit=fit,
        sensor_width=30,
        sensor_height=20,
        lens=42,
        ortho_scale=3,
        shift_x=0.13,
        shift_y=-0.21,
    )
    shown = camera.window(made.data, scene.render)
    lower, upper = frame_window(made)
    np.testing.assert_allclose(shown.lower, lower, rtol=2e-6)
    np.testing.assert_allclose(shown.upper, upper, rtol=2e-6)


def test_window_agrees_with_blenders_projection_matrix() -> None:
    scene = new_scene(300, 200)
    made = add_camera(kind="PERSP", shift_x=0.2, shift_y=0.1, lens=35)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    inverse = np.array(made.calc_matrix_camera(depsgraph, x=300, y=200).inverted())
    for corner, sign in (
        (camera.window(made.data, scene.render).lower, -1),
        (camera.window(made.data, scene.render).upper, 1),
    ):
        point = inverse @ (sign, sign, -1, 1)
        point = point[:3] / point[3]
        np.testing.assert_allclose(corner, point[:2] / -point[2], rtol=1e-5)


def test_resolution_percentage_rounds_down() -> None:
    scene = new_scene(333, 111)
    scene.render.resolution_percentage = 50
    assert camera.resolution(scene.render) == (166, 55)


def test_camera_keeps_its_place_but_not_its_scale() -> None:
    new_scene()
    made = add_camera((1, 2, 3), (0.3, 0.5, 0.7), clip_start=0.25, clip_end=75)
    made.scale = (2, 3, 4)
    exported = export().camera
    assert isinstance(exported, basicrt.OrthographicCamera)
    expected = Matrix.LocRotScale((1, 2, 3), made.rotation_euler, None)
    np.testing.assert_allclose(exported.transform, np.array(expected), atol=1e-6)
    assert (exported.clip_near, exported.clip_far) == pytest.approx((0.25, 75))


def test_perspective_camera_is_exported_as_one() -> None:
    new_scene()
    add_camera(kind="PERSP")
    assert isinstance(export().camera, basicrt.PerspectiveCamera)


def test_follows_parents_and_constraints() -> None:
    new_scene()
    made = add_camera((0, 0, 1))
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location = (5, 0, 0)
    made.parent = parent
    np.testing.assert_allclose(np.array(export().camera.transform)[:3, 3], (5, 0, 1))


@pytest.mark.skipif(bpy.app.version < (4, 5, 0), reason="custom cameras came later")
def test_cameras_that_are_shaders_are_reported() -> None:
    new_scene()
    add_camera(kind="CUSTOM")
    report = Report()
    assert isinstance(export(report).camera, basicrt.PerspectiveCamera)
    assert report.warnings == (
        'camera "Camera": type CUSTOM is not supported: drawn in perspective',
    )


def test_every_panorama_of_this_blender_is_supported() -> None:
    new_scene()
    made = add_camera(kind="PANO")
    report = Report()
    for item in type(made.data).bl_rna.properties["panorama_type"].enum_items:
        made.data.panorama_type = item.identifier
        assert not isinstance(export(report).camera, basicrt.PerspectiveCamera), item.identifier
    assert report.warnings == ()


@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("size", [(24, 16), (16, 24)])
def test_panorama_with_a_sensor_shows_all_of_it(fit: str, size: tuple[int, int]) -> None:
    scene = new_scene(*size)
    scene.render.pixel_aspect_x = 2
    sensor = {"sensor_fit": fit, "sensor_width": 30, "sensor_height": 20}
    made = add_camera(kind="PANO", panorama_type="FISHEYE_EQUISOLID", **sensor)
    exported = export().camera
    made.data.type, made.data.lens = "PERSP", 1
    lower, upper = frame_window(made)
    np.testing.assert_allclose(exported.window_min, lower, rtol=2e-6)
    np.testing.assert_allclose(exported.window_max, upper, rtol=2e-6)


def test_panoramas_shift_by_parts_of_width_and_height() -> None:
    new_scene(24, 16)
    add_camera(kind="PANO", panorama_type="EQUIRECTANGULAR", shift_x=0.25, shift_y=-0.5)
    exported = export().camera
    np.testing.assert_allclose(exported.window_min, (-np.pi / 2, -np.pi), rtol=1e-6)
    np.testing.assert_allclose(exported.window_max, (3 * np.pi / 2, 0), atol=1e-6)


@pytest.mark.parametrize(("kind", "radius"), [("PERSP", 0.0125), ("ORTHO", 0.25), ("PANO", 0.0125)])
def test_aperture_is_that_of_the_f_stop(kind: str, radius: float) -> None:
    new_scene()
    made = add_camera(kind=kind, lens=50)
    assert export().camera.aperture_radius == 0
    dof = made.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_distance = True, 2, 3.5
    dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 5, 0.25, 1.5
    exported = export().camera
    assert exported.aperture_radius == pytest.approx(radius)
    assert exported.aperture_blades == 5
    lens = (exported.aperture_rotation, exported.aperture_ratio, exported.focus_distance)
    assert lens == pytest.approx((0.25, 1.5, 3.5))


def test_focus_object_is_in_the_plane_of_focus() -> None:
    new_scene()
    made = add_camera((0, 0, 5), (0.5, 0, 0), kind="PERSP")
    target = place(None, (7, 0, 0), name="Target")
    made.data.dof.use_dof, made.data.dof.focus_object = True, target
    # Along the view, whatever lies to the side.
    assert export().camera.focus_distance == pytest.approx(5 * np.cos(0.5), rel=1e-5)


def test_focus_bone_is_in_the_plane_of_focus() -> None:
    new_scene()
    made = add_camera((0, 0, 5), kind="PERSP")
    armature = bpy.data.armatures.new("Armature")
    owner = place(armature, (0, 0, 1))
    bpy.context.view_layer.objects.active = owner
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 2), (0, 0, 3)
    bpy.ops.object.mode_set(mode="OBJECT")
    dof = made.data.dof
    dof.use_dof, dof.focus_object, dof.focus_subtarget = True, owner, "Bone"
    assert export().camera.focus_distance == pytest.approx(2, rel=1e-5)


def test_border_is_the_whole_picture_unless_used() -> None:
    scene = new_scene(97, 65)
    scene.render.border_min_x, scene.render.border_max_x = 0.131, 0.777
    scene.render.border_min_y, scene.render.border_max_y = 0.21, 0.9
    whole = border(scene.render)
    assert (whole.x, whole.y, whole.width, whole.height) == (0, 0, 97, 65)
    scene.render.use_border = True
    part = border(scene.render)
    assert (part.x, part.y, part.width, part.height) == (12, 13, 63, 45)
