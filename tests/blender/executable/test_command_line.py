# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b scene.blend -E BASICRT -f 1`: pictures where it can, and exit status 1 where it cannot."""

from pathlib import Path

from support.extension import ROOT, RealBlender

SCENE = ROOT / "scenes" / "blender" / "cornell_glass.blend"
SMALL = """
import bpy
for scene in bpy.data.scenes:
    scene.render.resolution_percentage = 12
"""
NO_CAMERA = """
import bpy
for scene in bpy.data.scenes:
    scene.camera = None
"""


def test_extension_is_listed(blender: RealBlender) -> None:
    result = blender.run("--command", "extension", "list")
    assert result.returncode == 0
    assert "basicrt" in result.stdout


def test_render_writes_the_frame_and_exits_with_0(blender: RealBlender, tmp_path: Path) -> None:
    result = blender.run(
        *("-b", SCENE, "--python-expr", SMALL, "-E", "BASICRT"),
        *("-o", tmp_path / "frame_####", "-F", "OPEN_EXR", "-f", "1"),
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert (tmp_path / "frame_0001.exr").stat().st_size > 1000


def test_render_without_a_camera_exits_with_1_and_writes_nothing(
    blender: RealBlender, tmp_path: Path
) -> None:
    result = blender.run(
        *("-b", SCENE, "--python-expr", NO_CAMERA, "-E", "BASICRT"),
        *("-o", tmp_path / "frame_####", "-F", "OPEN_EXR", "-f", "1"),
    )
    assert result.returncode == 1, result.stdout + result.stderr
    assert "camera" in (result.stdout + result.stderr).lower()
    assert not list(tmp_path.glob("frame_*"))
