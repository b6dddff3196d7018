# SPDX-License-Identifier: GPL-3.0-or-later
"""`make demo`: renders scenes/blender/cornell_glass.blend with BasicRT inside Blender's own Python module."""

from __future__ import annotations

import sys
import time

import bootstrap
from build_wheel import install_wheel
from project import ROOT, ToolError, relative, run, say

SCENE = ROOT / "scenes" / "blender" / "cornell_glass.blend"


def main() -> int:
    """Set up Blender, render, and say where the pictures are."""
    try:
        bootstrap.ensure_system()
        blender = bootstrap.demo_blender()
        python = install_wheel(f"bpy-{blender}")
        (ROOT / "out").mkdir(exist_ok=True)
        for suffix in ("exr", "png"):
            picture = ROOT / "out" / f"cornell_glass.{suffix}"
            say(f"rendering {relative(SCENE)} in Blender {blender} with engine BASICRT")
            start = time.monotonic()
            run([python.parent / "basicrt", "render", SCENE, "-o", picture])
            say(f"wrote {relative(picture)} in {time.monotonic() - start:.1f} s")
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
