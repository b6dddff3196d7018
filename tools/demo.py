# SPDX-License-Identifier: GPL-3.0-or-later
"""`make demo`: renders scenes/blender/cornell_glass.blend with BasicRT inside Blender's own Python module."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import bootstrap
from build_wheel import install_wheel
from project import ROOT, ToolError, relative, run, say

SCENE = ROOT / "scenes" / "blender" / "cornell_glass.blend"

# Blender's own view transform turns the scene-linear picture into one for the screen.
DEVELOP = """
import sys
import bpy
scene_file, linear, developed = sys.argv[1:]
bpy.ops.wm.open_mainfile(filepath=scene_file, load_ui=False)
settings = bpy.context.scene.render.image_settings
if bpy.app.version >= (5, 0):
    settings.media_type = "IMAGE"
settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGBA", "8"
bpy.data.images.load(linear).save_render(developed, scene=bpy.context.scene)
"""


def render(python: Path, picture: Path) -> None:
    """Write the picture as OpenEXR, and beside it as PNG."""
    start = time.monotonic()
    run([python.parent / "basicrt", "render", SCENE, "-o", picture])
    say(f"wrote {relative(picture)} in {time.monotonic() - start:.1f} s")
    developed = picture.with_suffix(".png")
    run([python, "-c", DEVELOP, SCENE, picture, developed], quiet=True)
    say(f"wrote {relative(developed)}")


def main() -> int:
    """Set up Blender, render, and say where the pictures are."""
    try:
        bootstrap.ensure_system()
        blender = bootstrap.demo_blender()
        python = install_wheel(f"bpy-{blender}")
        (ROOT / "out").mkdir(exist_ok=True)
        say(f"rendering {relative(SCENE)} in Blender {blender} with engine BASICRT")
        render(python, ROOT / "out" / "cornell_glass.exr")
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
