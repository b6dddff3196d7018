# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Vector: Cycles' pixel by pixel, and what it takes to know the frames beside this one."""

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import OpenEXR
import pytest
from addon import compat
from addon.sync import motion, scene_sync

import basicrt
from support.blender import (
    add_camera,
    add_mesh,
    add_plane,
    collect_warnings,
    export_in_render,
    new_scene,
    passes_of_both,
    place,
    render_passes,
    set_exr,
)

FRAME = 10


@pytest.fixture(autouse=True)
def scene() -> Any:
    """Frame 10, with the pass and a camera that looks down."""
    made = new_scene(64, 40, samples=1)
    made.basicrt.filter_type, made.basicrt.filter_width = "BLACKMAN_HARRIS", 0.01
    bpy.context.view_layer.use_pass_vector = True
    made.frame_set(FRAME)
    return made


def animate(made: Any, path: str, *values: Any) -> None:
    """One value for the frame before, this one and the one after."""
    for frame, value in zip(range(FRAME - 1, FRAME + 2), values, strict=True):
        setattr(made, path, value)
        made.keyframe_insert(path, frame=frame)


def add_cube(name: str, location: Any) -> Any:
    bpy.ops.mesh.primitive_cube_add(size=1, location=location)
    made = bpy.context.object
    made.name = name
    return made


def add_moving_cube() -> None:
    """Turned, scaled and moved, each frame another way."""
    made = add_cube("Cube", (0, 0, 0))
    animate(made, "location", (-2.3, 0.2, 0.5), (-2, 0, 0.6), (-1.8, -0.3, 0.9))
    animate(made, "rotation_euler", (0, 0, 0), (0.1, 0.2, 0.3), (0.3, 0.5, 0.6))
    animate(made, "scale", (1, 1, 1), (1, 1.2, 1), (1.3, 1, 1))


def add_growing_grid() -> Any:
    """A shape key bends a mesh, whose object moves too."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=1.4)
    made = bpy.context.object
    made.shape_key_add(name="Basis")
    block = made.shape_key_add(name="Bent")
    for point in block.data:
        point.co = point.co.x * 1.5, point.co.y, math.sin(3 * point.co.x)
    animate(block, "value", 0.2, 0.5, 0.9)
    animate(made, "location", (0, -0.2, 0.5), (0.1, 0, 0.5), (0.3, 0.1, 0.5))
    return made


def add_bent_arm() -> None:
    """An armature turns half of a mesh."""
    data = bpy.data.armatures.new("Armature")
    armature = place(data, (2, 0, 0.5), name="Armature")
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    lower = data.edit_bones.new("Lower")
    lower.head, lower.tail = (-0.8, 0, 0), (0, 0, 0)
    upper = data.edit_bones.new("Upper")
    upper.head, upper.tail, upper.parent = (0, 0, 0), (0.8, 0, 0), lower
    bpy.ops.object.mode_set(mode="OBJECT")
    arm = add_mesh(
        [(-0.8, -0.4, 0), (0, -0.4, 0), (0.8, -0.4, 0), (-0.8, 0.4, 0), (0, 0.4, 0), (0.8, 0.4, 0)],
        [(0, 1, 4, 3), (1, 2, 5, 4)],
        name="Arm",
    )
    arm.parent = armature
    for name, vertices in (("Lower", (0, 1, 3, 4)), ("Upper", (2, 5))):
        arm.vertex_groups.new(name=name).add(vertices, 1.0, "REPLACE")
    arm.modifiers.new("Armature", "ARMATURE").object = armature
    bone = armature.pose.bones["Upper"]
    bone.rotation_mode = "XYZ"
    for frame, angle in zip(range(FRAME - 1, FRAME + 2), (0.0, 0.3, 0.7), strict=True):
        bone.rotation_euler = (0, 0, angle)
        bone.keyframe_insert("rotation_euler", frame=frame)


def add_new_cube() -> None:
    """It isn't there in the frame before."""
    made = add_cube("New", (0, 0, 0))
    animate(made, "location", (0, 2, 0.5), (0.2, 1.7, 0.5), (0.5, 1.5, 0.7))
    for frame, hidden in ((FRAME - 1, True), (FRAME, False)):
        made.hide_render = hidden
        made.keyframe_insert("hide_render", frame=frame)


def add_instances() -> None:
    """Of a collection, by an empty that moves."""
    inner = add_cube("Inner", (0, 0, 0))
    collection = bpy.data.collections.new("Group")
    for owner in inner.users_collection:
        owner.objects.unlink(inner)
    collection.objects.link(inner)
    outer = bpy.data.objects.new("Outer", None)
    outer.instance_type, outer.instance_collection = "COLLECTION", collection
    bpy.context.scene.collection.objects.link(outer)
    animate(outer, "location", (-1.9, 1.8, 0.5), (-1.5, 1.7, 0.5), (-1.4, 1.5, 0.2))


def make_all_move() -> None:
    """What moves and deforms, before a floor that doesn't and a background."""
    add_plane(6, 0, name="Floor")
    add_moving_cube()
    add_growing_grid()
    add_bent_arm()
    add_new_cube()
    add_instances()


def add_perspective() -> None:
    """It turns and goes, and its lens zooms, which Cycles 4.2 doesn't know of."""
    made = add_camera((0, -6, 4), (1, 0, 0), kind="PERSP", lens=30)
    animate(made, "location", (0, -6, 4), (0.2, -6, 4), (0.3, -6.3, 4.1))
    animate(made, "rotation_euler", (0.95, 0, 0.05), (1, 0.02, 0), (1.02, 0, -0.1))
    if bpy.app.version >= (4, 3, 0):
        animate(made.data, "lens", 28.0, 30.0, 33.0)


def add_orthographic() -> None:
    """From 4.3 on Cycles takes one that moves for one in perspective."""
    made = add_camera((0, -3, 5), (0.5, 0, 0), ortho_scale=9)
    if bpy.app.version < (4, 3, 0):
        animate(made, "location", (0, -3, 5), (0.3, -3.2, 5), (0.4, -3.3, 5.1))
        animate(made, "rotation_euler", (0.45, 0, 0.1), (0.5, 0, 0), (0.51, 0.05, 0))


def add_fisheye() -> None:
    lens = {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 10.5, "fisheye_fov": math.pi}
    made = add_camera((0, -2, 3), (0.6, 0, 0), kind="PANO", **lens)
    animate(made, "rotation_euler", (0.55, 0, 0.05), (0.6, 0, 0), (0.65, 0.03, 0))


def add_equirectangular() -> None:
    """Not all around: at the seam Cycles goes the longer way."""
    sides = {"longitude_min": -1.4, "longitude_max": 1.4, "latitude_min": -1.0, "latitude_max": 0.8}
    made = add_camera(
        (0, -1, 3), (0.9, 0, 0), kind="PANO", panorama_type="EQUIRECTANGULAR", **sides
    )
    animate(made, "location", (0, -1, 3), (0, -1.2, 3), (0.1, -1.3, 3.1))


mirrored_in_cycles = pytest.mark.skipif(
    bpy.app.version < (4, 3, 0),
    reason="Cycles 4.2 has right and left of fisheyes the wrong way around",
)


@pytest.mark.parametrize(
    "add",
    [
        add_perspective,
        add_orthographic,
        pytest.param(add_fisheye, marks=mirrored_in_cycles),
        add_equirectangular,
    ],
)
def test_vectors_are_cycles(add: Any, scene: Any, tmp_path: Path) -> None:
    make_all_move()
    add()
    bpy.context.view_layer.use_pass_z = True
    both = passes_of_both(scene, tmp_path)
    ours, theirs = (one["Vector"] for one in both)
    assert ours.shape == theirs.shape == (40, 64, 4)
    if add is add_perspective and compat.has_background_vectors():
        # Cycles 5.2 does not divide what is infinitely far by how much of it is ahead.
        is_hit = both[0]["Depth"][..., 0] < 1e6
        assert np.abs(ours[~is_hit]).max() > 1, "the camera turns"
        ours, theirs = ours[is_hit], theirs[is_hit]
    # At edges the one sample of a pixel may see something else.
    difference = np.abs(ours - theirs).max(axis=-1)
    assert np.mean(difference > 2e-3 * (1 + np.abs(theirs).max(axis=-1))) < 0.01
    assert (np.abs(theirs) > 0.3).any(axis=-1).mean() > 0.1, "something moves"
    if not compat.has_background_vectors():
        assert (theirs == 0).all(axis=-1).mean() > 0.02, "the background doesn't"


def test_frames_of_an_animation_have_their_own(scene: Any, tmp_path: Path) -> None:
    """With persistent data, too."""
    made = add_plane(40)
    for frame, x in ((9, 0.0), (10, 1.0), (11, 3.0), (12, 6.0)):
        made.location.x = x
        made.keyframe_insert("location", frame=frame)
    add_camera(ortho_scale=6.4)  # a tenth of a metre for each pixel
    scene.frame_start, scene.frame_end = 10, 11
    scene.render.use_persistent_data = True
    set_exr(scene, is_multilayer=True)
    scene.render.filepath = str(tmp_path / "frame####.exr")
    assert bpy.ops.render.render(animation=True) == {"FINISHED"}
    for frame, expected in ((10, (-10, 0, -20, 0)), (11, (-20, 0, -30, 0))):
        with OpenEXR.File(str(tmp_path / f"frame{frame:04}.exr"), separate_channels=True) as file:
            channels = {
                name.rpartition(".")[2]: channel.pixels
                for part in file.parts
                for name, channel in part.channels.items()
                if ".Vector." in f"{part.name()}.{name}"
            }
        found = [float(np.median(channels[letter])) for letter in "XYZW"]
        assert found == pytest.approx(expected, abs=1e-3)


def note_evaluations(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The frames that exports evaluate from now on."""
    frames: list[float] = []
    set_frame = motion.set_frame

    def note(frame_set: motion.FrameSet, frame: float) -> None:
        frames.append(frame)
        set_frame(frame_set, frame)

    monkeypatch.setattr(scene_sync, "set_frame", note)
    monkeypatch.setattr(motion, "set_frame", note)
    return frames


def test_without_the_pass_no_frame_is_looked_at(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_camera()
    add_moving_cube()
    bpy.context.view_layer.use_pass_vector = False
    frames = note_evaluations(monkeypatch)
    exported = export_in_render(monkeypatch)
    assert frames == []
    assert exported.adjacent_cameras == []
    assert exported.instances[0].adjacent_transforms == []
    bpy.context.view_layer.use_pass_vector = True
    assert len(export_in_render(monkeypatch).instances[0].adjacent_transforms) == 2
    assert frames == [9, 11, 10]
    assert scene.frame_current_final == FRAME


def test_only_what_moves_has_transforms(scene: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    add_camera()
    add_plane(name="Floor")
    grid = add_growing_grid()
    exported = export_in_render(monkeypatch)
    by_name = {one.name: one for one in exported.instances}
    assert by_name["Floor"].adjacent_transforms == []
    places = [one[:3, 3] for one in by_name[grid.name].adjacent_transforms]
    np.testing.assert_allclose(places, [(0, -0.2, 0.5), (0.3, 0.1, 0.5)], atol=1e-6)
    meshes = [one for one in exported.shapes if isinstance(one, basicrt.Mesh)]
    assert sorted(len(one.adjacent_positions) for one in meshes) == [0, 2]
    assert not any(one.motion_positions for one in meshes)


def test_a_mesh_that_becomes_another_moves_as_its_object_does(
    scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_camera()
    made = add_plane(name="Growing")
    array = made.modifiers.new("Array", "ARRAY")
    for frame, count in ((FRAME, 2), (FRAME + 1, 3)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    made.modifiers.new("Wave", "WAVE").height = 0.1  # deforms with time
    animate(made, "location", (0, 0, 0), (1, 0, 0), (2, 0, 0))
    warnings = collect_warnings(monkeypatch)
    exported = export_in_render(monkeypatch)
    assert len(exported.instances[0].adjacent_transforms) == 2
    assert warnings() == (
        'object "Growing": its mesh becomes another one from frame to frame: the pass Vector shows only how the '
        "object moves",
    )


def test_with_motion_blur_there_is_none(
    scene: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    add_camera()
    add_moving_cube()
    scene.render.use_motion_blur = True
    warnings = collect_warnings(monkeypatch)
    assert not render_passes(tmp_path)["ViewLayer.Vector"].any()
    assert warnings() == (
        'view layer "ViewLayer": the pass Vector is 0 where there is motion blur',
    )
    bpy.context.view_layer.use_motion_blur = False
    assert render_passes(tmp_path)["ViewLayer.Vector"].any()
    assert warnings() == ()
