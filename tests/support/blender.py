# SPDX-License-Identifier: GPL-3.0-or-later
"""Small Blender scenes for tests, their export, and their renders as arrays with row 0 at the bottom."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import OpenEXR
import pytest
from addon.engine import BasicRTRenderEngine
from addon.engine.result import complete_without_pixels
from addon.report import Report
from addon.sync import scene_sync

import basicrt


def new_scene(width: int = 16, height: int = 16, samples: int = 16) -> Any:
    """An empty scene that BasicRT renders, with a black world and no camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "BASICRT"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.basicrt.samples = samples
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    return scene


def place(data: Any, location: Any = (0, 0, 0), rotation: Any = (0, 0, 0), name: str = "") -> Any:
    """An object in the scene; angles in radians."""
    made = bpy.data.objects.new(name or data.name, data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(made)
    return made


def add_camera(
    location: Any = (0, 0, 5), rotation: Any = (0, 0, 0), kind: str = "ORTHO", **values: Any
) -> Any:
    """The scene's camera; looks down unless turned."""
    data = bpy.data.cameras.new("Camera")
    data.type = kind
    for name, value in values.items():
        setattr(data, name, value)
    made = place(data, location, rotation)
    bpy.context.scene.camera = made
    return made


def add_mesh(
    vertices: Any, faces: Any, material: Any = None, name: str = "Mesh", location: Any = (0, 0, 0)
) -> Any:
    """An object with a mesh of one material."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    if material is not None:
        mesh.materials.append(material)
    return place(mesh, location)


def add_plane(size: float = 20, z: float = 0, material: Any = None, name: str = "Plane") -> Any:
    """A horizontal square that faces up."""
    h = size / 2
    corners = [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)]
    return add_mesh(corners, [(0, 1, 2, 3)], material, name, (0, 0, z))


def add_lamp(kind: str, location: Any = (0, 0, 2), rotation: Any = (0, 0, 0), **values: Any) -> Any:
    """A lamp; shines down unless turned."""
    data = bpy.data.lights.new(kind.title(), kind)
    for name, value in values.items():
        setattr(data, name, value)
    return place(data, location, rotation)


def set_world(color: tuple[float, float, float], strength: float = 1.0) -> Any:
    """The same light from everywhere."""
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    background = add_node(tree, "ShaderNodeBackground", Color=color, Strength=strength)
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs[0], output.inputs[0])
    bpy.context.scene.world = world
    return world


def new_image(
    pixels: Any, color_space: str = "Non-Color", is_float: bool = True, name: str = "Picture"
) -> Any:
    """A packed image of (height, width, 4) numbers, row 0 at the bottom."""
    pixels = np.ascontiguousarray(pixels, np.float32)
    height, width, _channels = pixels.shape
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    image.colorspace_settings.name = color_space
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image


def world_tree() -> tuple[Any, Any]:
    """A new world's node tree and its background node."""
    tree = set_world((1, 1, 1)).node_tree
    return tree, next(node for node in tree.nodes if node.type == "BACKGROUND")


def make_cycles_neutral(scene: Any) -> None:
    """Cycles without what changes the expectation, with our bounces, filter and samples."""
    cycles, own = scene.cycles, scene.basicrt
    cycles.device = "CPU"
    cycles.samples = own.samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces, cycles.diffuse_bounces = own.max_bounces, own.diffuse_bounces
    cycles.glossy_bounces = own.glossy_bounces
    cycles.transmission_bounces = own.transmission_bounces
    cycles.volume_bounces = own.volume_bounces
    cycles.transparent_max_bounces = own.transparent_bounces
    cycles.pixel_filter_type, cycles.filter_width = own.filter_type, own.filter_width
    for made in scene.objects:
        has_offsets = hasattr(made, "shadow_terminator_geometry_offset")
        offsets: Any = made if has_offsets else made.cycles  # Cycles' own before 4.3
        offsets.shadow_terminator_geometry_offset = offsets.shadow_terminator_shading_offset = 0


def passes_of_both(scene: Any, folder: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Our passes and Cycles' of a scene with one view layer, without that one's name."""
    make_cycles_neutral(scene)
    pictures = []
    for engine in ("BASICRT", "CYCLES"):
        scene.render.engine = engine
        passes = render_passes(folder)
        pictures.append({name.removeprefix("ViewLayer."): passes[name] for name in passes})
    return pictures[0], pictures[1]


def render_both(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Our picture and Cycles' of the scene, at pixels' centres: for what has no noise."""
    scene = bpy.context.scene
    scene.basicrt.filter_type, scene.basicrt.filter_width = "BLACKMAN_HARRIS", 0.01
    scene.basicrt.samples = 1
    ours = render(folder)
    make_cycles_neutral(scene)
    scene.cycles.filter_width = 0.01
    scene.render.engine = "CYCLES"
    theirs = render(folder)
    scene.render.engine = "BASICRT"
    return ours, theirs


def add_node(tree: Any, bl_idname: str, **values: Any) -> Any:
    """A node with values for inputs, named by identifier with underscores for spaces."""
    node = tree.nodes.new(bl_idname)
    for name, value in values.items():
        identifier = name.replace("_", " ")
        socket = next(s for s in node.inputs if s.identifier == identifier)
        socket.default_value = (*value, 1.0) if socket.type == "RGBA" else value
    return node


def empty_material(name: str = "Material") -> tuple[Any, Any, Any]:
    """A material, its node tree and its output, to which nothing is linked."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def new_material(bl_idname: str, name: str = "Material", **values: Any) -> Any:
    """A material of one shader node."""
    material, tree, output = empty_material(name)
    tree.links.new(add_node(tree, bl_idname, **values).outputs[0], output.inputs["Surface"])
    return material


def set_linear_keys(made: Any) -> None:
    """Between and beyond its keys what is animated changes evenly."""
    for curve in _curves(made):
        curve.extrapolation = "LINEAR"
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def _curves(made: Any) -> list[Any]:
    """The animation curves of a datablock; from 5.0 on they are in bags."""
    if made.animation_data is None:
        return []
    action = made.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    strips = [strip for layer in action.layers for strip in layer.strips]
    return [curve for strip in strips for bag in strip.channelbags for curve in bag.fcurves]


def export(report: Report | None = None) -> basicrt.Scene:
    """The scene as the engine would export it."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = bpy.context.scene.camera
    evaluated = camera.evaluated_get(depsgraph) if camera else None
    return scene_sync.export(depsgraph, evaluated, report or Report()).scene


def export_in_render(monkeypatch: pytest.MonkeyPatch) -> basicrt.Scene:
    """The scene as a real render exports it: with the render's visibility and modifiers."""
    exported = []

    def keep(engine: Any, export: scene_sync.Export, _depsgraph: Any) -> None:
        exported.append(export.scene)
        complete_without_pixels(engine)

    with monkeypatch.context() as patch:
        patch.setattr(BasicRTRenderEngine, "_trace", keep)
        assert bpy.ops.render.render() == {"FINISHED"}
    return exported[-1]


def collect_warnings(monkeypatch: pytest.MonkeyPatch) -> Any:
    """What the next export warns of, once it is over."""
    engines: list[Any] = []
    exporting = BasicRTRenderEngine._export

    def keep(engine: Any, depsgraph: Any) -> None:
        exporting(engine, depsgraph)
        engines.append(tuple(engine.warnings.warnings))

    monkeypatch.setattr(BasicRTRenderEngine, "_export", keep)
    return lambda: engines[-1]


def set_exr(scene: Any, is_multilayer: bool = False) -> None:
    """Write 32-bit OpenEXR."""
    settings = scene.render.image_settings
    if bpy.app.version >= (5, 0, 0):
        settings.media_type = "MULTI_LAYER_IMAGE" if is_multilayer else "IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER" if is_multilayer else "OPEN_EXR"
    settings.color_mode, settings.color_depth = "RGBA", "32"
    scene.render.use_file_extension = False


def render(folder: Path) -> np.ndarray:
    """Blender's render of the scene: (height, width, 4) float32, row 0 at the bottom."""
    scene = bpy.context.scene
    set_exr(scene)
    path = folder / "picture.exr"
    scene.render.filepath = str(path)
    assert bpy.ops.render.render(write_still=True) == {"FINISHED"}
    with OpenEXR.File(str(path)) as file:
        return np.array(file.channels()["RGBA"].pixels[::-1], np.float32)


def render_passes(folder: Path) -> dict[str, np.ndarray]:
    """Every pass of every view layer ("Layer.Pass"), row 0 at the bottom."""
    scene = bpy.context.scene
    set_exr(scene, is_multilayer=True)
    path = folder / "passes.exr"
    scene.render.filepath = str(path)
    assert bpy.ops.render.render(write_still=True) == {"FINISHED"}
    planes: dict[str, dict[str, np.ndarray]] = {}
    with OpenEXR.File(str(path), separate_channels=True) as file:
        # One part in which channels are named Layer.Pass.C, or a part for each pass (from 5.0 on).
        for part in file.parts:
            for name, channel in part.channels.items():
                full = name if name.count(".") >= 2 else f"{part.name()}.{name}"
                stem, _, letter = full.rpartition(".")
                planes.setdefault(stem, {})[letter] = np.array(channel.pixels[::-1])
    order = "UVRGBArgbaXYZW"
    return {
        stem: np.stack([by_letter[c] for c in order if c in by_letter], axis=-1)
        for stem, by_letter in planes.items()
    }
