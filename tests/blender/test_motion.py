# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur: keys over the shutter's time, and the frame as it was afterwards."""

import math
from typing import Any

import bpy
import numpy as np
import pytest
from addon.export import motion

import basicrt
from support.blender import (
    add_camera,
    add_mesh,
    add_plane,
    collect_warnings,
    export_in_render,
    new_scene,
    set_linear_keys,
)


@pytest.fixture(autouse=True)
def scene() -> Any:
    """Frame 10, a shutter of one frame."""
    made = new_scene(samples=1)
    add_camera()
    made.render.use_motion_blur = True
    made.render.motion_blur_shutter = 1.0
    made.frame_set(10)
    return made


def animate(made: Any, path: str, begin: Any, end: Any, frames: tuple[int, int] = (0, 20)) -> None:
    """Linear from one frame to another."""
    for frame, value in zip(frames, (begin, end), strict=True):
        setattr(made, path, value)
        made.keyframe_insert(path, frame=frame)
    set_linear_keys(made)


def keys_of(placed: Any) -> np.ndarray:
    """(N, 4, 4), the first at time 0."""
    return np.array([placed.transform, *placed.motion_transforms])


def add_shape_key(made: Any, vertex: int, co: Any) -> Any:
    """A shape key that takes a vertex there and goes from 0 at frame 0 to 1 at frame 20."""
    made.shape_key_add(name="Basis")
    block = made.shape_key_add(name="Moved")
    block.data[vertex].co = co
    for frame, value in ((0, 0.0), (20, 1.0)):
        block.value = value
        block.keyframe_insert("value", frame=frame)
    set_linear_keys(made.data.shape_keys)
    return block


@pytest.mark.parametrize(
    ("position", "begin", "end"), [("START", 10, 11), ("CENTER", 9.5, 10.5), ("END", 9, 10)]
)
def test_an_object_has_keys_over_the_shutter(
    position: str, begin: float, end: float, scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    animate(add_plane(), "location", (0, 0, 0), (20, 0, 0))
    scene.render.motion_blur_position = position
    keys = keys_of(export_in_render(monkeypatch).instances[0])
    assert keys[:, 0, 3] == pytest.approx([begin, (begin + end) / 2, end])
    assert scene.frame_current_final == 10


def test_what_stands_still_has_no_keys(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    add_plane()
    exported = export_in_render(monkeypatch)
    assert not exported.instances[0].motion_transforms
    assert exported.camera is not None
    assert not exported.camera.motion_transforms
    assert exported.settings.shutter_curve == []


def test_without_motion_blur_nothing_moves(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    animate(add_plane(), "location", (0, 0, 0), (20, 0, 0))
    scene.render.use_motion_blur = False
    instance = export_in_render(monkeypatch).instances[0]
    assert instance.transform[0, 3] == pytest.approx(10)
    assert not instance.motion_transforms
    scene.render.use_motion_blur = True
    bpy.context.view_layer.use_motion_blur = False
    assert not export_in_render(monkeypatch).instances[0].motion_transforms


def test_a_camera_moves(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    animate(scene.camera, "location", (0, 0, 5), (0, 20, 5))
    camera = export_in_render(monkeypatch).camera
    assert keys_of(camera)[:, 1, 3] == pytest.approx([9.5, 10, 10.5])


def test_a_turning_object_has_keys_close_together(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = add_plane()
    made.scale = (2, 3, 1)
    animate(made, "rotation_euler", (0, 0, 0), (0, 0, 20 * math.pi / 2))
    keys = keys_of(export_in_render(monkeypatch).instances[0])
    assert len(keys) > 30
    angles = np.linspace(9.5, 10.5, len(keys)) * math.pi / 2
    assert keys[:, 0, 0] == pytest.approx(2 * np.cos(angles), abs=1e-4)
    assert keys[:, 1, 1] == pytest.approx(3 * np.cos(angles), abs=1e-4)
    middles = (keys[:-1] + keys[1:]) / 2
    scales = np.linalg.norm(middles[:, :3, 0], axis=1)
    assert scales == pytest.approx(2, rel=1e-3), "linear in between it keeps its size"


def test_a_mesh_deforms(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    made = add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    made.data.shade_smooth()
    add_shape_key(made, 2, (0, 1, 20))
    exported = export_in_render(monkeypatch)
    shape = exported.shapes[0]
    assert isinstance(shape, basicrt.Mesh)
    keys = [shape.positions, *shape.motion_positions]
    assert [key[2, 2] for key in keys] == pytest.approx([9.5, 10, 10.5])
    assert [key[1, 0] for key in keys] == pytest.approx([1, 1, 1])
    assert len(shape.motion_corner_normals) == 2
    assert not exported.instances[0].motion_transforms


def test_a_mesh_that_becomes_another_stands_still(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = add_plane(name="Growing")
    array = made.modifiers.new("Array", "ARRAY")
    for frame, count in ((10, 2), (11, 3)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    weld = made.modifiers.new("Wave", "WAVE")  # deforms with time
    weld.height = 0.1
    scene.render.motion_blur_shutter = 2.0
    warnings = collect_warnings(monkeypatch)
    exported = export_in_render(monkeypatch)
    shape = exported.shapes[0]
    assert isinstance(shape, basicrt.Mesh)
    assert len(shape.positions) == 8
    assert not shape.motion_positions
    assert warnings() == (
        'object "Growing": its mesh becomes another one while the shutter is open: it stands still',
    )


def test_an_object_that_appears_stands_still(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    made = add_plane(name="New")
    animate(made, "location", (0, 0, 0), (20, 0, 0))
    for frame, hidden in ((9, True), (10, False)):
        made.hide_render = hidden
        made.keyframe_insert("hide_render", frame=frame)
    warnings = collect_warnings(monkeypatch)
    instance = export_in_render(monkeypatch).instances[0]
    assert instance.transform[0, 3] == pytest.approx(10)
    assert not instance.motion_transforms
    assert warnings() == (
        'object "New": appears or disappears while the shutter is open: it stands still',
    )


def test_a_lens_that_changes_is_reported(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    animate(scene.camera.data, "ortho_scale", 5.0, 10.0)
    warnings = collect_warnings(monkeypatch)
    export_in_render(monkeypatch)
    assert warnings() == ('camera "Camera": changes of its lens are not blurred',)


def test_the_shutter_s_curve_arrives(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    curve = scene.render.motion_blur_shutter_curve
    curve.initialize()
    points = curve.curves[0].points
    points[0].location, points[1].location, points[2].location = (0, 0), (0.5, 1), (1, 0)
    for point in points:
        point.handle_type = "VECTOR"
    curve.update()
    numbers = export_in_render(monkeypatch).settings.shutter_curve
    assert numbers == pytest.approx(1 - np.abs(np.linspace(-1, 1, len(numbers))), abs=0.02)


def test_instances_of_a_collection_move_with_it(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    inner = add_plane()
    collection = bpy.data.collections.new("Group")
    scene.collection.objects.unlink(inner)
    collection.objects.link(inner)
    outer = bpy.data.objects.new("Outer", None)
    outer.instance_type, outer.instance_collection = "COLLECTION", collection
    scene.collection.objects.link(outer)
    animate(outer, "location", (0, 0, 0), (20, 0, 0))
    exported = export_in_render(monkeypatch)
    assert len(exported.instances) == 1
    assert keys_of(exported.instances[0])[:, 0, 3] == pytest.approx([9.5, 10, 10.5])


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="Cycles' settings are there in all")
def test_cycles_settings_of_an_object_count(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    made = add_plane()
    animate(made, "location", (0, 0, 0), (20, 0, 0))
    made.cycles.motion_steps = 3
    assert len(keys_of(export_in_render(monkeypatch).instances[0])) == 9
    made.cycles.use_motion_blur = False
    assert not export_in_render(monkeypatch).instances[0].motion_transforms


def test_keys_between_keep_mirrors_and_shear() -> None:
    mirrored = np.diag([-1.0, 2, 1, 1])
    mirrored[0, 1] = 0.3
    turn = np.eye(4)
    turn[:2, :2] = [[0, -1], [1, 0]]
    turned = turn @ mirrored
    turned[:3, 3] = 1, 2, 3
    keys = motion.object_keys([mirrored, turned])
    assert len(keys) == 31
    assert keys[0] == pytest.approx(mirrored)
    assert keys[-1] == pytest.approx(turned)
    assert np.linalg.det(keys[:, :3, :3]) == pytest.approx(np.linalg.det(mirrored), rel=1e-4)
    assert keys[15][:3, 3] == pytest.approx([0.5, 1, 1.5])
