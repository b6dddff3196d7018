# SPDX-License-Identifier: GPL-3.0-or-later
"""What of the machine a render may use: threads and memory, as scenes, preferences and the command line say."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..preferences import preferences
from ..report import ExportError
from .command_line import Overrides

if TYPE_CHECKING:
    import basicrt

GIGABYTE = 2.0**30


def thread_count(b_scene: bpy.types.Scene, overrides: Overrides) -> int:
    """How many threads there are to be; 0 is one for each processor.

    What the command line says (ours, or Blender's -t, which makes every scene's mode read FIXED), a
    scene's fixed number, the preferences' number, and else one for each processor.
    """
    if overrides.threads is not None:
        return overrides.threads
    render: Any = b_scene.render
    preferred = preferences().threads
    is_chosen = render.threads_mode == "FIXED" or preferred == 0
    return int(render.threads) if is_chosen else preferred


def check_memory(memory: basicrt.SceneMemory, overrides: Overrides, *, is_built: bool) -> None:
    """Raises ExportError where a scene needs more than is allowed: at least so much, where its trees are not built."""
    limit = preferences().memory_limit
    place = "Edit > Preferences > Add-ons > BasicRT > Memory Limit"
    if overrides.memory_limit is not None:
        limit, place = overrides.memory_limit, "--basicrt-memory-limit"
    if limit == 0 or memory.total <= limit * GIGABYTE:
        return
    raise ExportError(
        f"the scene needs {'' if is_built else 'at least '}{gigabytes(memory.total)} of memory "
        f"({parts_of(memory)}), and {place} allows {limit:.6g} GB: raise that (0 is no limit), "
        "or make the scene smaller"
    )


def gigabytes(size: int) -> str:
    """Of bytes, as Blender counts them, with three digits that mean something."""
    return f"{size / GIGABYTE:.3g} GB"


def parts_of(memory: basicrt.SceneMemory) -> str:
    """What takes how much, the most first."""
    names = ("shapes", "instances", "images", "trees", "picture")
    parts = sorted(((getattr(memory, name), name) for name in names), reverse=True)
    return ", ".join(f"{name} {gigabytes(size)}" for size, name in parts if size > 0)
