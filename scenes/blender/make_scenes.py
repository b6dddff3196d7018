# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the .blend files beside this script, so that a change to a scene can be read here.

    python scenes/blender/make_scenes.py [NAME ...]

with a Python that has Blender's module of version 4.2 (`pip install bpy==4.2.*`): files of a newer Blender do
not open in 4.2. Each scene is a module here with a function `build()`; `stage.py` holds what they share.
"""

from __future__ import annotations

import importlib
import shutil
import sys
import tempfile
from pathlib import Path

import bpy

FOLDER = Path(__file__).resolve().parent
SCENES = ("cornell_glass", "materials", "lights", "instances")


def register_addon() -> object:
    """The add-on of this checkout, so that its settings are saved in the files."""
    sys.path.insert(0, str(FOLDER.parent.parent))
    addon = importlib.import_module("addon")
    addon.register()
    return addon


def make(name: str) -> None:
    """Build one scene from nothing and save it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    scene = bpy.context.scene
    scene.render.engine = "BASICRT"
    importlib.import_module(name).build(scene)
    path = FOLDER / f"{name}.blend"
    with tempfile.TemporaryDirectory() as folder:
        # A file remembers where it was saved, which is nobody's business: not in this checkout.
        saved = Path(folder) / path.name
        bpy.ops.wm.save_as_mainfile(filepath=str(saved), compress=True)
        shutil.copyfile(saved, path)
    print(f"wrote {path} ({path.stat().st_size // 1024} KiB)")


def main(names: list[str]) -> None:
    """Make the named scenes, or all of them."""
    if bpy.app.version[:2] != (4, 2):
        sys.exit(
            f"needs Blender 4.2, this is {bpy.app.version_string}: newer files do not open in it"
        )
    sys.path.insert(0, str(FOLDER))
    addon = register_addon()
    try:
        for name in names or SCENES:
            make(name)
    finally:
        addon.unregister()  # type: ignore[attr-defined]


if __name__ == "__main__":
    main(sys.argv[1:])
