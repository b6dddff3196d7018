# SPDX-License-Identifier: GPL-3.0-or-later
"""The Cornell box, open to the camera: two boxes, a glass ball and a glass disc, one area lamp."""

from __future__ import annotations

import bpy
import stage

HALF = 1.0  # the room is two metres wide, deep and high; the floor is at z = 0
HEIGHT = 2.0


def build(scene: bpy.types.Scene) -> None:
    """Build it into an empty scene."""
    white = stage.diffuse("White", (0.73, 0.73, 0.73))
    red = stage.diffuse("Red", (0.63, 0.065, 0.05))
    green = stage.diffuse("Green", (0.14, 0.45, 0.091))
    glass = stage.new_material(
        "Glass", "ShaderNodeBsdfGlass", Color=(1, 1, 1), Roughness=0.0, IOR=1.5
    )
    tinted = stage.new_material(
        "Tinted Glass", "ShaderNodeBsdfGlass", Color=(0.75, 0.93, 1), Roughness=0.0, IOR=1.5
    )

    build_room(white, red, green)
    stage.box("Tall Box", (0.6, 0.6, 1.2), (-0.34, 0.36, 0), 17, white)
    stage.box("Short Box", (0.6, 0.6, 0.6), (0.38, -0.22, 0), -17, white)
    stage.sphere("Glass Ball", 0.3, (0.38, -0.22, 0.9), glass)
    build_disc(tinted)

    light = stage.lamp(
        "AREA", "Ceiling Lamp", (0, 0, HEIGHT - 0.01), (0, 0, 0), 27.0, shape="RECTANGLE"
    )
    light.data.size, light.data.size_y = 0.8, 0.7
    light.data.color = (1.0, 0.9, 0.75)
    light.visible_camera = True

    stage.camera((0, -3.9, 1), (0, 0, 1), lens=52.5)
    stage.set_picture(scene, 512, 512, samples=128)


def build_room(
    white: bpy.types.Material, red: bpy.types.Material, green: bpy.types.Material
) -> None:
    """Five walls, their fronts inwards."""
    h, top = HALF, HEIGHT
    stage.rectangle("Floor", [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], white)
    stage.rectangle("Ceiling", [(-h, -h, top), (-h, h, top), (h, h, top), (h, -h, top)], white)
    stage.rectangle("Back Wall", [(-h, h, 0), (h, h, 0), (h, h, top), (-h, h, top)], white)
    stage.rectangle("Left Wall", [(-h, -h, 0), (-h, h, 0), (-h, h, top), (-h, -h, top)], red)
    stage.rectangle("Right Wall", [(h, h, 0), (h, -h, 0), (h, -h, top), (h, h, top)], green)


def build_disc(material: bpy.types.Material) -> None:
    """A thick disc that leans on the tall box: a cylinder, closed, so that light is refracted in and out."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=96, radius=0.27, depth=0.05)
    disc = bpy.context.object
    disc.name = disc.data.name = "Glass Disc"
    disc.location = (-0.42, -0.34, 0.27)
    disc.rotation_euler = (1.3, 0.0, -0.35)
    disc.data.materials.append(material)
