# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenes are made of: materials from single nodes, boxes, spheres, lamps, a camera. Metres and watts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import bpy
from mathutils import Vector

Color = tuple[float, float, float]
Point = tuple[float, float, float]


def new_node(tree: bpy.types.NodeTree, bl_idname: str, **values: Any) -> bpy.types.Node:
    """A node with values for inputs; underscores stand for spaces, colours get an alpha."""
    node = tree.nodes.new(bl_idname)
    for name, value in values.items():
        socket = node.inputs[name.replace("_", " ")]
        socket.default_value = (*value, 1.0) if socket.type == "RGBA" else value
    return node


def new_material(name: str, bl_idname: str, **values: Any) -> bpy.types.Material:
    """A material of one shader node."""
    material, tree, output = empty_material(name)
    tree.links.new(new_node(tree, bl_idname, **values).outputs[0], output.inputs["Surface"])
    return material


def empty_material(name: str) -> tuple[bpy.types.Material, bpy.types.NodeTree, bpy.types.Node]:
    """A material, its tree and its output, to which nothing is linked."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def diffuse(name: str, color: Color) -> bpy.types.Material:
    """A matt material."""
    return new_material(name, "ShaderNodeBsdfDiffuse", Color=color)


def place(
    data: bpy.types.ID, name: str, location: Point = (0, 0, 0), turn: Point = (0, 0, 0)
) -> bpy.types.Object:
    """An object in the scene; `turn` in degrees about x, y, z."""
    obj = bpy.data.objects.new(name, data)
    obj.location = location
    obj.rotation_euler = [math.radians(angle) for angle in turn]
    bpy.context.scene.collection.objects.link(obj)
    return obj


def new_mesh(
    name: str,
    vertices: Sequence[Point],
    faces: Sequence[Sequence[int]],
    material: bpy.types.Material | None,
) -> bpy.types.Mesh:
    """A mesh of one material."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.validate()
    if material is not None:
        mesh.materials.append(material)
    return mesh


def rectangle(
    name: str, corners: Sequence[Point], material: bpy.types.Material
) -> bpy.types.Object:
    """A face with four corners, anticlockwise seen from the front."""
    return place(new_mesh(name, corners, [(0, 1, 2, 3)], material), name)


def box(
    name: str, size: Point, location: Point, turn: float, material: bpy.types.Material
) -> bpy.types.Object:
    """A box that stands at `location`, turned about the vertical by degrees."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    vertices = [
        (sx * x, sy * y, h) for h in (0.0, z) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return place(new_mesh(name, vertices, faces, material), name, location, (0, 0, turn))


def sphere_mesh(
    name: str, radius: float, material: bpy.types.Material | None, segments: int = 64
) -> bpy.types.Mesh:
    """A smooth sphere about the origin, poles on z."""
    rings = segments // 2
    vertices: list[Point] = [(0, 0, -radius), (0, 0, radius)]
    for ring in range(1, rings):
        theta = math.pi * ring / rings
        for segment in range(segments):
            phi = 2 * math.pi * segment / segments
            sine = math.sin(theta)
            point = (sine * math.cos(phi), sine * math.sin(phi), -math.cos(theta))
            vertices.append((radius * point[0], radius * point[1], radius * point[2]))

    def vertex(ring: int, segment: int) -> int:
        return 2 + (ring - 1) * segments + segment % segments

    faces: list[tuple[int, ...]] = []
    for segment in range(segments):
        faces.append((0, vertex(1, segment + 1), vertex(1, segment)))
        faces.append((1, vertex(rings - 1, segment), vertex(rings - 1, segment + 1)))
        for ring in range(1, rings - 1):
            low, high = (vertex(ring, segment), vertex(ring, segment + 1)), ring + 1
            faces.append((*low, vertex(high, segment + 1), vertex(high, segment)))
    mesh = new_mesh(name, vertices, faces, material)
    mesh.shade_smooth()
    return mesh


def sphere(
    name: str, radius: float, location: Point, material: bpy.types.Material
) -> bpy.types.Object:
    """A smooth sphere."""
    return place(sphere_mesh(name, radius, material), name, location)


def lamp(
    kind: str, name: str, location: Point, turn: Point, power: float, **values: Any
) -> bpy.types.Object:
    """A lamp that shines down where `turn` is zero; watts, or W/m² for a sun."""
    light = bpy.data.lights.new(name, kind)
    light.energy = power
    for key, value in values.items():
        setattr(light, key, value)
    return place(light, name, location, turn)


def camera(location: Point, target: Point, lens: float, sensor: float = 36.0) -> bpy.types.Object:
    """The scene's camera, level, looking at a point; lens and sensor in millimetres."""
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width = lens, sensor
    obj = place(data, "Camera", location)
    direction = Vector(target) - Vector(location)
    obj.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = obj
    return obj


def set_world(color: Color, strength: float = 1.0) -> None:
    """The same light from everywhere."""
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = world


def set_picture(scene: bpy.types.Scene, width: int, height: int, samples: int) -> None:
    """Size in pixels, and samples for each of them."""
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.basicrt.samples = samples
