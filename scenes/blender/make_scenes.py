# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the .blend files beside this script, so that a change to a scene can be read here.

    python scenes/blender/make_scenes.py [--folder FOLDER] [NAME ...]

with a Python that has Blender's module of version 4.2 (`pip install bpy==4.2.*`): files of a newer Blender do
not open in 4.2. Each scene is a module here with a function `build()`; `stage.py` holds what they share. With
a folder of your own, of any version, and of the scenes in `families.py` and `graphs.py` too.
"""

from __future__ import annotations

import argparse
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


def build(name: str, scene: bpy.types.Scene) -> None:
    """Fill an empty scene."""
    families = importlib.import_module("graphs").SCENES
    (families[name] if name in families else importlib.import_module(name).build)(scene)


def make(name: str, target: Path) -> None:
    """Build one scene from nothing and save it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    scene = bpy.context.scene
    scene.render.engine = "BASICRT"
    build(name, scene)
    path = target / f"{name}.blend"
    with tempfile.TemporaryDirectory() as folder:
        # A file remembers where it was saved, which is nobody's business: not in this checkout.
        saved = Path(folder) / path.name
        bpy.ops.wm.save_as_mainfile(filepath=str(saved), compress=True)
        shutil.copyfile(saved, path)
    print(f"wrote {path} ({path.stat().st_size // 1024} KiB)")


def main() -> None:
    """Make the named scenes, or all that are kept here."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("name", nargs="*")
    parser.add_argument("--folder", type=Path, default=FOLDER)
    arguments = parser.parse_args()
    if arguments.folder == FOLDER and bpy.app.version[:2] != (4, 2):
        sys.exit(
            f"needs Blender 4.2, this is {bpy.app.version_string}: newer files do not open in it"
        )
    sys.path.insert(0, str(FOLDER))
    addon = register_addon()
    try:
        for name in arguments.name or SCENES:
            make(name, arguments.folder)
    finally:
        addon.unregister()  # type: ignore[attr-defined]


if __name__ == "__main__":
    main()
