# SPDX-License-Identifier: GPL-3.0-or-later
"""Thousands of copies that share a few meshes: pebbles by geometry nodes, and a tree three times as a collection."""

from __future__ import annotations

import math

import bpy
import stage

PEBBLES = 3000


def build(scene: bpy.types.Scene) -> None:
    """Build it into an empty scene."""
    ground = stage.rectangle(
        "Ground",
        [(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)],
        stage.diffuse("Ground", (0.3, 0.25, 0.2)),
    )
    modifier = ground.modifiers.new("Pebbles", "NODES")
    modifier.node_group = new_scatter()

    tree = new_tree()
    for index, (x, y, turn, size) in enumerate(
        ((-2.2, 1.0, 0, 1.0), (0.6, 2.4, 70, 1.3), (2.4, 0.2, 200, 0.8))
    ):
        instance = stage.place(None, f"Tree {index}", (x, y, 0), (0, 0, turn))
        instance.instance_type = "COLLECTION"
        instance.instance_collection = tree
        instance.scale = (size, size, size)

    stage.lamp(
        "SUN", "Sun", (0, 0, 5), (45, 0, 35), 3.0, angle=math.radians(1), color=(1.0, 0.9, 0.75)
    )
    stage.set_world((0.45, 0.65, 1.0), 0.5)
    stage.camera((0, -9, 3.4), (0, 0.4, 0.8), lens=42.0)
    stage.set_picture(scene, 640, 360, samples=64)


def new_scatter() -> bpy.types.NodeTree:
    """Geometry nodes: two kinds of pebbles on random points, turned and scaled at random."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, sink = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    points = stage.new_node(
        tree, "GeometryNodeDistributePointsOnFaces", Density=PEBBLES / 144.0, Seed=4
    )
    instances = tree.nodes.new("GeometryNodeInstanceOnPoints")
    turn = random_vector(tree, (0, 0, 0), (math.tau, math.tau, math.tau))
    size = random_vector(tree, (0.03, 0.03, 0.02), (0.1, 0.1, 0.05))
    pebbles = tree.nodes.new("GeometryNodeGeometryToInstance")
    for name, color in (("Pale Pebble", (0.6, 0.55, 0.5)), ("Dark Pebble", (0.15, 0.16, 0.2))):
        mesh = stage.new_node(tree, "GeometryNodeMeshIcoSphere", Radius=1.0, Subdivisions=2)
        painted = tree.nodes.new("GeometryNodeSetMaterial")
        painted.inputs["Material"].default_value = stage.diffuse(name, color)
        tree.links.new(mesh.outputs["Mesh"], painted.inputs["Geometry"])
        tree.links.new(painted.outputs[0], pebbles.inputs[0])
    join = tree.nodes.new("GeometryNodeJoinGeometry")

    instances.inputs["Pick Instance"].default_value = True
    tree.links.new(source.outputs[0], points.inputs["Mesh"])
    tree.links.new(points.outputs["Points"], instances.inputs["Points"])
    tree.links.new(pebbles.outputs[0], instances.inputs["Instance"])
    tree.links.new(turn.outputs[0], instances.inputs["Rotation"])
    tree.links.new(size.outputs[0], instances.inputs["Scale"])
    tree.links.new(source.outputs[0], join.inputs[0])
    tree.links.new(instances.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], sink.inputs[0])
    return tree


def random_vector(tree: bpy.types.NodeTree, low: stage.Point, high: stage.Point) -> bpy.types.Node:
    """A Random Value node that gives vectors between two."""
    node = tree.nodes.new("FunctionNodeRandomValue")
    node.data_type = "FLOAT_VECTOR"
    node.inputs[0].default_value, node.inputs[1].default_value = low, high
    return node


def new_tree() -> bpy.types.Collection:
    """A trunk and a crown of balls, in a collection that the scene shows only as instances."""
    collection = bpy.data.collections.new("Tree")
    bark, leaves = (
        stage.diffuse("Bark", (0.2, 0.1, 0.05)),
        stage.diffuse("Leaves", (0.12, 0.35, 0.08)),
    )
    parts = [stage.box("Trunk", (0.2, 0.2, 1.2), (0, 0, 0), 0, bark)]
    crown = stage.sphere_mesh("Crown", 0.5, leaves, segments=32)
    for x, y, z in ((0, 0, 1.6), (0.35, 0.1, 1.25), (-0.3, 0.2, 1.3), (0.0, -0.35, 1.25)):
        parts.append(stage.place(crown, "Crown", (x, y, z)))
    for part in parts:
        bpy.context.scene.collection.objects.unlink(part)
        collection.objects.link(part)
    return collection
