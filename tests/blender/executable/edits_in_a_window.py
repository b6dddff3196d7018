# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender with a window: edits a scene in a rendered viewport, and asks for a screenshot after each edit.

A screenshot is asked for by a file NAME.want in the folder given after `--`, which says where the viewport is and how
long callbacks took, and is taken when that file is gone.
"""

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
REST_SECONDS = 4.0  # for pictures to come
_seconds: dict[str, float] = {}


def measure(name: str) -> None:
    """Note the longest time that one of the engine's callbacks takes."""
    engines = bpy.types.RenderEngine.__subclasses__()
    engine = next(c for c in engines if getattr(c, "bl_idname", "") == "BASICRT")
    callback = getattr(engine, name)

    def measured(self: Any, context: Any, depsgraph: Any) -> None:
        begin = time.perf_counter()
        callback(self, context, depsgraph)
        _seconds[name] = max(_seconds.get(name, 0.0), time.perf_counter() - begin)

    setattr(engine, name, measured)


def glowing(name: str, color: tuple[float, float, float]) -> Any:
    """A material that shines alike everywhere."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*color, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def prepare() -> Any:
    """A red square before a black world, seen from above without anything drawn over it."""
    bpy.context.preferences.view.show_splash = False
    scene = bpy.context.scene
    for made in list(scene.objects):
        bpy.data.objects.remove(made)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.0
    scene.view_settings.view_transform = "Standard"
    scene.basicrt.preview_samples = 4
    mesh = bpy.data.meshes.new("Square")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(glowing("Red", (1.0, 0.0, 0.0)))
    scene.collection.objects.link(bpy.data.objects.new("Square", mesh))
    scene.render.engine = "BASICRT"
    area = next(a for a in bpy.context.window.screen.areas if a.type == "VIEW_3D")
    space = area.spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    view = space.region_3d
    view.view_perspective, view.view_distance = "ORTHO", 6.0
    view.view_rotation, view.view_location = (1, 0, 0, 0), (0, 0, 0)
    space.shading.type = "RENDERED"
    return area


def edits() -> Iterator[str]:
    """Each edit is followed by the name of its screenshot."""
    area = prepare()
    measure("view_update")
    measure("view_draw")
    space, square = area.spaces.active, bpy.data.objects["Square"]
    yield "red"
    tree = bpy.data.materials["Red"].node_tree
    emission = next(n for n in tree.nodes if n.type == "EMISSION")
    emission.inputs["Color"].default_value = (0, 1, 0, 1)
    yield "green"
    square.location.x = 20
    yield "moved_away"
    square.location.x = 0
    square.data.materials[0] = glowing("Blue", (0.0, 0.0, 1.0))
    yield "blue"
    square.data.materials[0] = glowing("Yellow", (1.0, 1.0, 0.0))  # nothing like its normal
    space.shading.basicrt.render_pass = "Normal"
    yield "normal"
    space.shading.basicrt.render_pass = "Combined"
    space.use_render_border = True
    space.render_border_min_x, space.render_border_max_x = 0.5, 1.0
    space.render_border_min_y, space.render_border_max_y = 0.0, 1.0
    yield "border"
    space.use_render_border = False
    bpy.data.objects.remove(square)
    yield "deleted"


def region() -> Any:
    area = next(
        a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D"
    )
    return next(r for r in area.regions if r.type == "WINDOW")


_edits = edits()
_wanted: list[Path] = []


def step() -> float:
    """Blender's timer."""
    if _wanted:
        if not _wanted[0].exists():
            _wanted.clear()
        return 0.1
    try:
        name = next(_edits)
    except StopIteration:
        (FOLDER / "done").touch()
        bpy.ops.wm.quit_blender()
        return 1.0
    except Exception:
        bpy.ops.wm.quit_blender()
        raise
    bpy.app.timers.register(lambda: ask(name), first_interval=REST_SECONDS)
    return REST_SECONDS + 0.2


def ask(name: str) -> None:
    """Ask for a screenshot."""
    shown, window = region(), bpy.context.window_manager.windows[0]
    place = [window.x + shown.x, window.y + shown.y, shown.width, shown.height]  # from below
    path = FOLDER / f"{name}.want"
    path.with_suffix(".part").write_text(json.dumps({"region": place, "seconds": _seconds}))
    path.with_suffix(".part").rename(path)
    _wanted.append(path)


bpy.app.timers.register(step, first_interval=2.0)
