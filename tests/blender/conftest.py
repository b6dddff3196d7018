# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the add-on of this checkout for all tests, and takes it away before Blender ends."""

import importlib
import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))


@pytest.fixture(scope="session", autouse=True)
def registered_addon() -> Iterator[None]:
    """Blender 4.2 crashes and 4.5 hangs at exit when an engine is still registered.

    The tests in executable/ run without Blender's module: they start Blender themselves.
    """
    if importlib.util.find_spec("bpy") is None:
        yield
        return
    addon = importlib.import_module("addon")
    addon.register()
    yield
    addon.unregister()


@pytest.fixture
def scene() -> Any:
    """A plane under an even sky, 8 by 8 pixels."""
    from support.blender import add_camera, add_plane, new_scene, set_world

    made = new_scene(8, 8, 4)
    add_plane()
    set_world((0.5, 0.5, 0.5))
    add_camera()
    return made
