# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b scene.blend -E BASICRT -f 1`: pictures where it can, and exit status 1 where it cannot."""

from pathlib import Path

import basicrt
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


def test_flags_behind_the_dashes_count_for_every_frame(
    blender: RealBlender, tmp_path: Path
) -> None:
    for name, seed in (("a", "7"), ("b", "7"), ("c", "8")):
        result = blender.run(
            *("-b", SCENE, "--python-expr", SMALL, "-E", "BASICRT"),
            *("-o", tmp_path / f"{name}_####", "-F", "OPEN_EXR", "-f", "1..2", "--"),
            *("--basicrt-samples", "2", "--basicrt-threads", "2", "--basicrt-seed", seed),
        )
        assert result.returncode == 0, result.stdout + result.stderr
    frames = sorted(path.name for path in tmp_path.glob("*.exr"))
    assert frames == [f"{name}_000{number}.exr" for name in "abc" for number in (1, 2)]
    read = basicrt.read_exr
    a, b, c = (read(tmp_path / f"{name}_0001.exr")["Combined"] for name in "abc")
    assert a.tobytes() == b.tobytes()
    assert a.tobytes() != c.tobytes()


def test_a_flag_that_there_is_not_exits_with_1_and_one_line(
    blender: RealBlender, tmp_path: Path
) -> None:
    result = blender.run(
        *("-b", SCENE, "-E", "BASICRT", "-o", tmp_path / "frame_####", "-F", "OPEN_EXR"),
        *("-f", "1..3", "--", "--basicrt-sample", "2"),
    )
    assert result.returncode == 1
    output = result.stdout + result.stderr
    assert output.count("--basicrt-sample: unknown option; did you mean --basicrt-samples?") == 1
    assert not list(tmp_path.glob("frame_*"))
