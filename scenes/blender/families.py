# SPDX-License-Identifier: GPL-3.0-or-later
"""A small scene for each family of lights, cameras and paths, to hold the engine against Cycles.

`make_scenes.py NAME --folder FOLDER` writes one as a .blend file; tests build them as they need them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import stage

DOWN = (0, 0, 0)
Build = Callable[[bpy.types.Scene], None]
SCENES: dict[str, Build] = {}


def family(build: Build) -> Build:
    """Lists a scene under its function's name."""
    SCENES[build.__name__] = build
    return build


# ---- what they have in common --------------------------------------------------------------------


def corner(scene: bpy.types.Scene, material: bpy.types.Material | None = None) -> None:
    """A floor and a wall with a box and a ball before it, seen from the front and above."""
    white = stage.diffuse("White", (0.75, 0.72, 0.7))
    stage.rectangle("Floor", [(-3, -3, 0), (3, -3, 0), (3, 2, 0), (-3, 2, 0)], white)
    stage.rectangle("Wall", [(-3, 2, 0), (3, 2, 0), (3, 2, 3.5), (-3, 2, 3.5)], white)
    box = stage.diffuse("Box", (0.2, 0.5, 0.3))
    stage.box("Box", (0.9, 0.9, 1.4), (-0.9, 0.5, 0), 25, box)
    stage.sphere("Ball", 0.6, (0.8, 0, 0.6), material or stage.diffuse("Ball", (0.7, 0.3, 0.2)))
    stage.camera((0, -6, 2.6), (0, 0.2, 0.9), lens=40.0)
    stage.set_picture(scene, 64, 48, samples=64)


def ceiling_lamp(**values: Any) -> bpy.types.Object:
    """An area lamp of one square metre over the corner."""
    settings: dict[str, Any] = {"shape": "SQUARE", "size": 1.0, **values}
    return stage.lamp("AREA", "Ceiling Lamp", (0.3, -0.3, 3.2), DOWN, 60.0, **settings)


def animate(made: Any, path: str, begin: Any, end: Any) -> None:
    """Evenly, from the frame before the rendered one to the one after it."""
    frame = bpy.context.scene.frame_current
    for offset, value in ((-1, begin), (1, end)):
        setattr(made, path, value)
        made.keyframe_insert(path, frame=frame + offset)


# ---- lights --------------------------------------------------------------------------------------


@family
def point_lamps(scene: bpy.types.Scene) -> None:
    """One with a soft falloff, one without, one without a size."""
    corner(scene)
    stage.lamp("POINT", "Soft", (-1.5, -1, 2.5), DOWN, 60.0, shadow_soft_size=0.4)
    stage.lamp(
        "POINT", "Ball", (1.5, -1, 2), DOWN, 40.0, shadow_soft_size=0.2, use_soft_falloff=False
    )
    stage.lamp("POINT", "Point", (0, -2, 0.8), DOWN, 10.0, shadow_soft_size=0.0)


@family
def spot_lamps(scene: bpy.types.Scene) -> None:
    """A hard narrow one and a soft wide one, turned and stretched."""
    corner(scene)
    wide = {"spot_size": math.radians(70), "spot_blend": 0.8, "shadow_soft_size": 0.3}
    narrow = {"spot_size": math.radians(30), "spot_blend": 0.1, "shadow_soft_size": 0.0}
    spot = stage.lamp("SPOT", "Wide", (-1.5, -2, 3), (40, -10, 0), 250.0, **wide)
    spot.scale = (1.0, 0.5, 1.0)
    stage.lamp("SPOT", "Narrow", (1.5, -2, 2.5), (45, 20, 0), 150.0, **narrow)


@family
def suns(scene: bpy.types.Scene) -> None:
    """A wide one and one that is nearly a point."""
    corner(scene)
    stage.lamp("SUN", "Wide", (0, 0, 5), (30, 30, 0), 2.0, angle=math.radians(25))
    stage.lamp("SUN", "Narrow", (0, 0, 5), (55, -20, 0), 1.0, angle=math.radians(0.5))


@family
def area_lamps(scene: bpy.types.Scene) -> None:
    """Each shape, one of them close to what it lights."""
    corner(scene)
    stage.lamp("AREA", "Square", (-2, -1, 1.5), (0, -60, 0), 15.0, shape="SQUARE", size=0.8)
    stage.lamp("AREA", "Strip", (0, -1, 2.8), DOWN, 25.0, shape="RECTANGLE", size=2.0, size_y=0.1)
    stage.lamp("AREA", "Disk", (2.4, 0, 0.5), (0, 90, 0), 8.0, shape="DISK", size=0.6)
    stage.lamp(
        "AREA", "Ellipse", (0, 1.8, 1.2), (-60, 0, 0), 5.0, shape="ELLIPSE", size=1.0, size_y=0.2
    )


@family
def spread_of_area_lamps(scene: bpy.types.Scene) -> None:
    """Light that leaves within a cone."""
    corner(scene)
    ceiling_lamp(spread=math.radians(60))
    stage.lamp(
        "AREA",
        "Beam",
        (-2, -1.5, 1.5),
        (60, -50, 0),
        6.0,
        shape="DISK",
        size=0.5,
        spread=math.radians(15),
    )


@family
def shining_meshes(scene: bpy.types.Scene) -> None:
    """A ball, a box and a sheet that shines on both sides."""
    corner(scene)
    emission = "ShaderNodeEmission"
    warm = stage.new_material("Warm", emission, Color=(1.0, 0.7, 0.4), Strength=12.0)
    cold = stage.new_material("Cold", emission, Color=(0.4, 0.6, 1.0), Strength=5.0)
    mesh = stage.sphere_mesh("Bulb", 0.2, warm, segments=16)
    stage.place(mesh, "Bulb", (1.2, -1.2, 1.8))
    stage.box("Cube", (0.3, 0.3, 0.3), (-2, -1, 0.2), 20, cold)
    sheet = [(-0.4, 0, 1.8), (0.4, 0, 1.8), (0.4, 0.3, 2.4), (-0.4, 0.3, 2.4)]
    stage.rectangle("Sheet", sheet, cold)


@family
def even_sky(scene: bpy.types.Scene) -> None:
    """The same light from everywhere."""
    corner(scene)
    stage.set_world((0.5, 0.7, 1.0), 0.8)


@family
def picture_sky(scene: bpy.types.Scene) -> None:
    """A world image with a small bright patch, turned."""
    corner(scene)
    height, width = 32, 64
    pixels = np.full((height, width, 4), (0.1, 0.15, 0.25, 1.0), np.float32)
    pixels[: height // 2, :, :3] = 0.05
    pixels[20:24, 20:25, :3] = (30.0, 24.0, 15.0)
    pixels[26:29, 40:44, :3] = (2.0, 6.0, 12.0)
    image = bpy.data.images.new("Sky", width, height, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    stage.set_world((1.0, 1.0, 1.0), 0.7)
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    mapping = stage.new_node(tree, "ShaderNodeMapping", Rotation=(0.2, 0.1, 1.0))
    texture: Any = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])


@family
def evening_sky(scene: bpy.types.Scene) -> None:
    """A sky with its sun."""
    corner(scene)
    stage.set_world((1.0, 1.0, 1.0), 0.1)
    tree = scene.world.node_tree
    sky: Any = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = "MULTIPLE_SCATTERING"
    sky.sun_elevation, sky.sun_rotation = math.radians(20), math.radians(150)
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    tree.links.new(sky.outputs["Color"], background.inputs["Color"])


@family
def many_lamps(scene: bpy.types.Scene) -> None:
    """Eighty lamps of all kinds, between which the tree of lights must choose."""
    corner(scene)
    random = np.random.default_rng(7)
    for index in range(80):
        place = random.uniform((-3, -2.5, 0.3), (3, 1.8, 3.2))
        color = tuple(random.uniform(0.2, 1.0, 3))
        turn = tuple(random.uniform(-90, 90, 3))
        kind = ("POINT", "SPOT", "AREA")[index % 3]
        size = {"size": 0.2} if kind == "AREA" else {"shadow_soft_size": 0.05}
        stage.lamp(kind, f"Lamp {index}", tuple(place), turn, 2.0, color=color, **size)


# ---- paths ---------------------------------------------------------------------------------------


@family
def closed_room(scene: bpy.types.Scene) -> None:
    """Most light has bounced several times."""
    corner(scene)
    red, green = stage.diffuse("Red", (0.8, 0.1, 0.1)), stage.diffuse("Green", (0.1, 0.7, 0.1))
    grey = stage.diffuse("Grey", (0.8, 0.8, 0.8))
    stage.rectangle("Left", [(-3, -7, 0), (-3, 2, 0), (-3, 2, 3.5), (-3, -7, 3.5)], red)
    stage.rectangle("Right", [(3, 2, 0), (3, -7, 0), (3, -7, 3.5), (3, 2, 3.5)], green)
    stage.rectangle("Ceiling", [(-3, -7, 3.5), (-3, 2, 3.5), (3, 2, 3.5), (3, -7, 3.5)], grey)
    stage.rectangle("Front", [(-3, -7, 0), (-3, -7, 3.5), (3, -7, 3.5), (3, -7, 0)], grey)
    stage.rectangle("Apron", [(-3, -7, 0), (3, -7, 0), (3, -3, 0), (-3, -3, 0)], grey)
    lamp = stage.lamp("AREA", "Up", (0, -1, 2.2), (180, 0, 0), 60.0, shape="SQUARE", size=1.0)
    lamp.visible_camera = False


@family
def few_bounces(scene: bpy.types.Scene) -> None:
    """Each kind of bounce has a limit of its own."""
    corner(scene, stage.new_material("Glass", "ShaderNodeBsdfGlass", Roughness=0.2, IOR=1.4))
    mirror = stage.new_material("Mirror", "ShaderNodeBsdfAnisotropic", Roughness=0.15)
    stage.rectangle(
        "Mirror", [(-2.6, 1.5, 0.2), (2.6, 1.5, 0.2), (2.6, 1.8, 2), (-2.6, 1.8, 2)], mirror
    )
    ceiling_lamp()
    stage.set_world((0.3, 0.3, 0.3))
    own: Any = scene
    own.basicrt.max_bounces, own.basicrt.diffuse_bounces = 5, 1
    own.basicrt.glossy_bounces, own.basicrt.transmission_bounces = 2, 3


@family
def transparent_panes(scene: bpy.types.Scene) -> None:
    """Tinted panes one behind the other, for the eye and for shadows, more than may be passed."""
    corner(scene)
    ceiling_lamp()
    for index in range(5):
        tint = [(0.9, 0.5, 0.5), (0.5, 0.9, 0.5), (0.5, 0.5, 0.9)][index % 3]
        pane = stage.new_material(f"Pane {index}", "ShaderNodeBsdfTransparent", Color=tint)
        x, y = -1.8 + 0.6 * index, -1.2 - 0.2 * index
        corners = [(x, y, 0.1), (x + 1.6, y, 0.1), (x + 1.6, y + 0.3, 2.2), (x, y + 0.3, 2.2)]
        stage.rectangle(f"Pane {index}", corners, pane)
    own: Any = scene
    own.basicrt.transparent_bounces = 3


@family
def rough_metals(scene: bpy.types.Scene) -> None:
    """Sharp and dull reflections of near lamps: neither way of sampling will do alone."""
    corner(scene, stage.new_material("Metal", "ShaderNodeBsdfAnisotropic", Roughness=0.2))
    dull = stage.new_material(
        "Dull", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.7, 0.4), Roughness=0.5
    )
    stage.sphere("Dull Ball", 0.4, (0, -1.4, 0.4), dull)
    stage.lamp(
        "AREA", "Strip", (0, 1.5, 2.5), (-40, 0, 0), 30.0, shape="RECTANGLE", size=3, size_y=0.2
    )
    stage.lamp("POINT", "Bulb", (-1, -2, 2), DOWN, 30.0, shadow_soft_size=0.1)
    stage.set_world((0.1, 0.1, 0.12))


@family
def plastic_and_glass(scene: bpy.types.Scene) -> None:
    """Principled surfaces and a rough glass under a large lamp."""
    corner(scene, stage.new_material("Glass", "ShaderNodeBsdfGlass", Roughness=0.3, IOR=1.5))
    plastic = stage.new_material(
        "Plastic", "ShaderNodeBsdfPrincipled", Base_Color=(0.1, 0.3, 0.8), Roughness=0.4
    )
    metal = stage.new_material(
        "Metal", "ShaderNodeBsdfPrincipled", Base_Color=(0.9, 0.6, 0.3), Roughness=0.4, Metallic=1.0
    )
    stage.sphere("Plastic Ball", 0.4, (-0.2, -1.2, 0.4), plastic)
    stage.sphere("Metal Ball", 0.4, (1.7, -0.9, 0.4), metal)
    ceiling_lamp(size=2.5)
    stage.set_world((0.3, 0.3, 0.3))


@family
def seen_by_some(scene: bpy.types.Scene) -> None:
    """Objects that only some kinds of rays meet."""
    corner(scene)
    ceiling_lamp()
    mirror = stage.new_material("Mirror", "ShaderNodeBsdfAnisotropic", Roughness=0.0)
    stage.rectangle(
        "Mirror", [(0.2, 1.6, 0.2), (2.6, 1.6, 0.2), (2.6, 1.7, 2), (0.2, 1.7, 2)], mirror
    )
    objects = bpy.data.objects
    objects["Box"].visible_shadow = False
    objects["Ball"].visible_camera = False
    yellow = stage.diffuse("Yellow", (0.8, 0.7, 0.1))
    stage.box("No Reflection", (0.5, 0.5, 0.8), (1.8, -0.4, 0), 10, yellow).visible_glossy = False
    stage.box("No Bounce", (0.5, 0.5, 0.8), (-2.2, 0, 0), 10, yellow).visible_diffuse = False


# ---- volumes -------------------------------------------------------------------------------------


def fill(name: str, bl_idname: str, **values: Any) -> bpy.types.Material:
    """A material without a surface, of one volume node."""
    material, tree, output = stage.empty_material(name)
    node = stage.new_node(tree, bl_idname, **values)
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return material


@family
def clouded_boxes(scene: bpy.types.Scene) -> None:
    """A cloud in a box, one inside the other's corner, and glass that absorbs."""
    glass = stage.new_material("Glass", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.3)
    tree: Any = glass.node_tree
    tint = stage.new_node(tree, "ShaderNodeVolumeAbsorption", Color=(0.3, 0.8, 0.9), Density=2.0)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(tint.outputs[0], output.inputs["Volume"])
    corner(scene, glass)
    ceiling_lamp()
    scatter = "ShaderNodeVolumeScatter"
    white = fill("White Cloud", scatter, Color=(0.9, 0.9, 0.9), Density=1.5, Anisotropy=0.4)
    red = fill("Red Cloud", scatter, Color=(0.9, 0.4, 0.3), Density=4.0, Anisotropy=-0.3)
    stage.box("Cloud", (1.5, 1.5, 1.2), (0.4, -0.9, 1.2), 10, white)
    stage.box("Inner Cloud", (0.7, 0.7, 0.7), (0.9, -0.9, 1.6), 30, red)


@family
def foggy_world(scene: bpy.types.Scene) -> None:
    """The camera stands in fog that a spot lamp shines through."""
    corner(scene)
    spot = {"spot_size": math.radians(35), "spot_blend": 0.2, "shadow_soft_size": 0.05}
    stage.lamp("SPOT", "Beam", (-2, -1, 3), (20, -40, 0), 600.0, **spot)
    stage.set_world((0.0, 0.0, 0.0))
    tree: Any = scene.world.node_tree
    fog = stage.new_node(tree, "ShaderNodeVolumeScatter", Density=0.08, Anisotropy=0.2)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(fog.outputs[0], output.inputs["Volume"])


# ---- cameras -------------------------------------------------------------------------------------


@family
def level_camera(scene: bpy.types.Scene) -> None:
    """Without perspective, shifted."""
    corner(scene)
    ceiling_lamp()
    data: Any = scene.camera.data
    data.type, data.ortho_scale, data.shift_x, data.shift_y = "ORTHO", 5.0, 0.1, -0.05


@family
def round_camera(scene: bpy.types.Scene) -> None:
    """A fisheye from between the things."""
    corner(scene)
    ceiling_lamp()
    stage.set_world((0.2, 0.25, 0.3))
    scene.camera.location = (0, -1.5, 1.2)
    data: Any = scene.camera.data
    data.type = "PANO"
    settings = data if hasattr(data, "fisheye_fov") else data.cycles  # Cycles' own before 5.0
    settings.panorama_type = "FISHEYE_EQUIDISTANT"
    settings.fisheye_fov = math.radians(170)
    scene.render.resolution_x = 48


@family
def shallow_focus(scene: bpy.types.Scene) -> None:
    """A wide lens with a round aperture, focused on the ball."""
    corner(scene)
    ceiling_lamp()
    data: Any = scene.camera.data
    data.dof.use_dof, data.dof.aperture_fstop = True, 0.1
    data.dof.focus_object = bpy.data.objects["Ball"]


@family
def moving_things(scene: bpy.types.Scene) -> None:
    """A ball that rolls by, a box that turns, a camera that sinks."""
    corner(scene)
    ceiling_lamp()
    stage.lamp("SUN", "Sun", (0, 0, 5), (50, 20, 0), 1.0, angle=math.radians(3))
    scene.frame_set(10)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    animate(bpy.data.objects["Ball"], "location", (0, -0.5, 0.6), (1.8, 0.5, 0.9))
    animate(bpy.data.objects["Box"], "rotation_euler", (0, 0, 0), (0, 0.3, 1.0))
    animate(scene.camera, "location", (-0.2, -6, 2.8), (0.2, -6, 2.4))
