# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export > BasicRT Scene: a JSON file that renders to the bytes that Blender gets."""

from pathlib import Path

import bpy
import numpy as np
import pytest

import basicrt
from support.blender import new_scene, render

ROOT = Path(__file__).resolve().parents[2]
SCENES = sorted((ROOT / "scenes" / "blender").glob("*.blend"))


@pytest.mark.parametrize("blend", SCENES, ids=lambda path: path.stem)
def test_exported_scene_renders_to_the_same_bytes(blend: Path, tmp_path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene = bpy.context.scene
    assert scene.render.engine == "BASICRT"
    scene.render.resolution_percentage = 20
    scene.basicrt.samples = 2
    expected = render(tmp_path)
    path = tmp_path / "scene.json"
    assert bpy.ops.basicrt.export_scene(filepath=str(path)) == {"FINISHED"}
    rendered = basicrt.render(basicrt.load_scene(str(path)))["Combined"]
    np.testing.assert_array_equal(rendered, expected)
    assert expected[..., :3].max() > 0.1


def test_export_leaves_settings_as_they_were(tmp_path: Path) -> None:
    scene = new_scene(8, 8)
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.use_compositing, scene.render.use_sequencer = True, False
    bpy.ops.basicrt.export_scene(filepath=str(tmp_path / "scene.json"))
    assert (scene.render.use_compositing, scene.render.use_sequencer) == (True, False)


def test_export_that_fails_says_why_and_leaves_no_file(tmp_path: Path) -> None:
    scene = new_scene(8, 8)
    scene.camera = None
    path = tmp_path / "scene.json"
    with pytest.raises(RuntimeError, match=r"(?i)no camera"):
        bpy.ops.basicrt.export_scene(filepath=str(path))
    assert not path.exists()


def test_export_into_a_folder_that_is_not_there(tmp_path: Path) -> None:
    scene = new_scene(8, 8)
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    with pytest.raises(RuntimeError, match="nowhere"):
        bpy.ops.basicrt.export_scene(filepath=str(tmp_path / "nowhere" / "scene.json"))


def test_export_needs_this_engine() -> None:
    scene = new_scene(8, 8)
    scene.render.engine = "BLENDER_WORKBENCH"
    assert not bpy.ops.basicrt.export_scene.poll()
