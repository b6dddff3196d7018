# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip installs into a clean profile of this Blender, and its own wheel renders."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

from support.extension import find_extension

INSTALL_AND_RENDER = """
import sys, pathlib
import bpy

extension, picture = sys.argv[1:]
bpy.ops.extensions.package_install_files(
    filepath=extension, repo="user_default", enable_on_install=True
)
assert "bl_ext.user_default.basicrt" in bpy.context.preferences.addons, "not enabled"

chosen = bpy.context.preferences.addons["bl_ext.user_default.basicrt"].preferences
chosen.threads, chosen.isa, chosen.log_level = 1, "SCALAR", "INFO"

scene = bpy.context.scene
scene.render.threads_mode = "AUTO"
scene.render.engine = "BASICRT"
scene.basicrt.samples = 4
scene.render.resolution_x, scene.render.resolution_y = 48, 32
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)

pixels = bpy.data.images.load(picture).pixels[:]
assert len(pixels) == 48 * 32 * 4
assert max(pixels) > 0.01, "the picture is black"
import basicrt
print("rendered with", basicrt.__file__)
assert basicrt.chosen_kernel() == "scalar", "the preferences don't count"
assert bpy.ops.basicrt.self_test() == {"FINISHED"}
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.basicrt")
assert not hasattr(bpy.types.Scene, "basicrt"), "something of the add-on stayed behind"
print("done")
"""


def packages_without_ours(folder: Path) -> Path:
    """Links to everything installed here except `basicrt`, so that only the zip's can be imported."""
    for package in Path(sysconfig.get_path("purelib")).iterdir():
        if not package.name.startswith("basicrt") and package.suffix != ".pth":
            (folder / package.name).symlink_to(package)
    return folder


def test_zip_installs_into_a_clean_profile_and_renders(tmp_path: Path) -> None:
    extension = find_extension()
    profile, packages = tmp_path / "profile", tmp_path / "packages"
    profile.mkdir()
    packages.mkdir()
    picture = tmp_path / "picture.exr"
    python = getattr(sys, "_base_executable", sys.executable)
    result = subprocess.run(
        [python, "-S", "-c", INSTALL_AND_RENDER, str(extension), str(picture)],
        env={
            **os.environ,
            "BLENDER_USER_RESOURCES": str(profile),
            "PYTHONPATH": str(packages_without_ours(packages)),
        },
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert "done" in result.stdout, result.stdout + result.stderr
    assert "threads: 1, scalar" in result.stderr, "the preferences don't count"
    assert f"rendered with {profile}" in result.stdout, "another basicrt than the zip's was used"
    assert result.returncode == 0, f"leaving Blender failed: {result.stdout + result.stderr}"
