# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that is kept up to date edit by edit is the scene that a fresh export gives."""

from __future__ import annotations

import os
import random
import time
from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from addon.export import camera
from addon.report import Report
from addon.sync import changes
from addon.sync.models import Models
from addon.sync.scene_sync import SceneSync

import basicrt
from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    add_plane,
    export,
    new_material,
    new_scene,
    place,
    set_world,
)

CUBE = (
    [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)],
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
)


def picture_in(session: basicrt.ViewSession, scene: basicrt.Scene) -> np.ndarray:
    """What it comes to show of a scene, as the scene's camera sees it."""
    session.set_scene(scene)
    session.set_view(scene.camera, scene.settings)
    while not session.status.is_done:
        time.sleep(0.001)
    newest = session.take_picture()
    assert newest is not None
    return newest.pixels


def fresh_picture() -> np.ndarray:
    """The scene in a session that has never seen another."""
    session = basicrt.ViewSession(1)
    picture = picture_in(session, export())
    session.close()
    return picture


class LiveScene:
    """A sync that hears of every update of the scene's dependency graph, as a viewport's does."""

    def __init__(self) -> None:
        self.sync = SceneSync(Report())
        self.session = basicrt.ViewSession(1)
        self.update()

    def update(self) -> basicrt.Scene:
        """The scene after Blender has evaluated its own."""
        depsgraph = bpy.context.evaluated_depsgraph_get()
        b_camera: Any = bpy.context.scene.camera.evaluated_get(depsgraph)
        seen = camera.convert(b_camera, bpy.context.scene.render, Report())
        self.sync.update(depsgraph, seen)
        return self.sync.exported.scene

    def picture(self) -> np.ndarray:
        """What a viewport that looks through the scene's camera comes to show after an update."""
        return picture_in(self.session, self.update())

    def note(self, _scene: Any, depsgraph: Any) -> None:
        """Blender's handler."""
        self.sync.note(depsgraph)


@pytest.fixture
def live() -> Iterator[LiveScene]:
    """Two cubes that share a mesh on a floor, under a lamp and a sky."""
    new_scene(16, 16, 4)
    add_camera((4, -6, 5), (0.9, 0, 0.6), "PERSP")
    add_plane(material=new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.5, 0.4, 0.3)))
    red = new_material("ShaderNodeBsdfDiffuse", "Red", Color=(0.8, 0.1, 0.1))
    first = add_mesh(*CUBE, red, "Cube", (0, 0, 0.5))
    place(first.data, (2, 1, 0.5), name="Second")
    add_lamp("POINT", (2, -2, 4), energy=200, shadow_soft_size=0.5)
    set_world((0.2, 0.3, 0.5))
    scene = LiveScene()
    bpy.app.handlers.depsgraph_update_post.append(scene.note)
    yield scene
    scene.session.close()
    bpy.app.handlers.depsgraph_update_post.remove(scene.note)


def expect_up_to_date(live: LiveScene) -> None:
    bpy.context.view_layer.update()
    np.testing.assert_array_equal(live.picture(), fresh_picture())


def objects(kind: str = "MESH") -> list[Any]:
    return [made for made in bpy.context.scene.objects if made.type == kind]


def test_moving_an_object_touches_one_instance(
    live: LiveScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live.sync._instances, "scan", None)  # it would be called in vain
    bpy.data.objects["Cube"].location.x = -1
    expect_up_to_date(live)


def test_moving_a_lamp_touches_no_instance(
    live: LiveScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live.sync._instances, "scan", None)
    bpy.data.objects["Point"].location.x = -1
    expect_up_to_date(live)
    bpy.data.lights["Point"].energy = 20
    expect_up_to_date(live)


def test_nodes_of_a_lamp_touch_no_instance(
    live: LiveScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live.sync._instances, "scan", None)
    before = live.picture()
    edit_lamp_nodes(random.Random(1))
    expect_up_to_date(live)
    after, count = live.picture(), len(live.sync.exported.scene.materials)
    assert not np.array_equal(before, after)
    edit_lamp_nodes(random.Random(2))
    expect_up_to_date(live)
    assert not np.array_equal(after, live.picture())
    assert len(live.sync.exported.scene.materials) == count


def test_moving_an_instancer_places_its_instances_alone(
    live: LiveScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    collection = bpy.data.collections.new("Group")
    collection.objects.link(bpy.data.objects["Cube"])
    for name, x in (("Left", -2), ("Right", 2)):
        made = bpy.data.objects.new(name, None)
        made.instance_type, made.instance_collection = "COLLECTION", collection
        made.location = (x, 2, 1)
        bpy.context.scene.collection.objects.link(made)
    expect_up_to_date(live)
    placing, placed = Models.place, []

    def place_one(self: Models, b_instance: Any, *owners: Any) -> Any:
        placement = placing(self, b_instance, *owners)
        if placement is not None:
            placed.append((b_instance.parent or b_instance.object).name)
        return placement

    bpy.data.objects["Left"].location.z = 2
    bpy.context.view_layer.update()
    with monkeypatch.context() as patch:
        patch.setattr(Models, "place", place_one)
        live.update()
    assert placed == ["Left"]
    expect_up_to_date(live)


def test_a_material_is_converted_alone(live: LiveScene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live.sync._instances, "scan", None)
    tree = bpy.data.materials["Red"].node_tree
    next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE").inputs[0].default_value = (0, 1, 0, 1)
    expect_up_to_date(live)


def test_shapes_of_deleted_objects_give_their_place_to_new_ones(live: LiveScene) -> None:
    count = len(live.sync.exported.scene.shapes)
    for name in ("Cube", "Second"):
        bpy.data.objects.remove(bpy.data.objects[name])
    expect_up_to_date(live)
    add_mesh([(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 1, 2)], None, "Triangle")
    expect_up_to_date(live)
    assert len(live.sync.exported.scene.shapes) == count


def test_what_is_undone_is_read_anew(live: LiveScene) -> None:
    before = changes.history()
    for handler in (bpy.app.handlers.undo_post, bpy.app.handlers.load_post):
        for one in handler:
            if one.__module__ == changes.__name__:
                one(None)
    assert changes.history() == before + 2
    expect_up_to_date(live)


def test_a_moved_object_moves_what_materials_make_of_it(live: LiveScene) -> None:
    guide = bpy.data.objects.new("Guide", None)
    bpy.context.scene.collection.objects.link(guide)
    tree = bpy.data.materials["Floor"].node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    coordinates.object = guide
    checks = add_node(tree, "ShaderNodeTexChecker", Scale=1.0)
    tree.links.new(coordinates.outputs["Object"], checks.inputs["Vector"])
    diffuse = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    tree.links.new(checks.outputs[0], diffuse.inputs[0])
    expect_up_to_date(live)
    guide.location.x = 0.3
    expect_up_to_date(live)


# Random edits. Each takes a source of random numbers.


def add_object(chance: random.Random) -> None:
    made = add_mesh(*CUBE, None, "Added", (chance.uniform(-2, 2), chance.uniform(-2, 2), 0.5))
    made.data.materials.append(chance.choice(list(bpy.data.materials)))


def delete_object(chance: random.Random) -> None:
    if len(objects()) > 1:
        bpy.data.objects.remove(chance.choice(objects()))


def move(chance: random.Random) -> None:
    made = chance.choice(objects())
    made.location.x += chance.uniform(-1, 1)
    made.scale.z = chance.uniform(0.5, 2)


def move_lamp(chance: random.Random) -> None:
    chance.choice(objects("LIGHT")).location.x = chance.uniform(-2, 2)


def edit_lamp_nodes(chance: random.Random) -> None:
    """Noise in the light of a lamp, or its strength where it has that already."""
    light = chance.choice(objects("LIGHT")).data
    if bpy.app.version < (5, 1, 0) and not light.use_nodes:
        light.use_nodes = True  # tells of a change of the object, too
    emission = next(n for n in light.node_tree.nodes if n.type == "EMISSION")
    emission.inputs["Strength"].default_value = chance.uniform(1, 2)
    if not emission.inputs["Color"].is_linked:
        noise = light.node_tree.nodes.new("ShaderNodeTexNoise")
        light.node_tree.links.new(noise.outputs["Color"], emission.inputs["Color"])


def link_a_lamp(chance: random.Random) -> None:
    """To some object or to all but that, or no longer; its light or its shadows."""
    links = chance.choice(objects("LIGHT")).light_linking
    name = chance.choice(("receiver_collection", "blocker_collection"))
    collection = getattr(links, name)
    if collection is None:
        made = bpy.data.collections.new("Links")
        made.objects.link(chance.choice(objects()))
        setattr(links, name, made)
    elif collection.collection_objects and chance.random() < 0.5:
        collection.collection_objects[0].light_linking.link_state = "EXCLUDE"
    else:
        setattr(links, name, None)


def edit_mesh(chance: random.Random) -> None:
    mesh = chance.choice(objects()).data
    mesh.vertices[0].co.z += chance.uniform(-0.3, 0.3)
    mesh.update()


def relink_material(chance: random.Random) -> None:
    mesh = chance.choice(objects()).data
    if len(mesh.materials) > 0:
        mesh.materials[0] = chance.choice(list(bpy.data.materials))


def edit_material(chance: random.Random) -> None:
    tree = chance.choice([one for one in bpy.data.materials if one.node_tree]).node_tree
    diffuse = next(n for n in tree.nodes if n.type == "BSDF_DIFFUSE")
    diffuse.inputs[0].default_value = (chance.random(), chance.random(), chance.random(), 1)


def hide(chance: random.Random) -> None:
    made = chance.choice(objects())
    made.hide_viewport = not made.hide_viewport


def hide_in_the_view_layer(chance: random.Random) -> None:
    made = chance.choice(objects())
    made.hide_set(not made.hide_get())


def rename(chance: random.Random) -> None:
    chance.choice(objects()).name = f"Renamed{chance.randrange(100)}"


def add_modifier(chance: random.Random) -> None:
    made = chance.choice(objects())
    if made.modifiers:
        made.modifiers.clear()
    else:
        made.modifiers.new("Array", "ARRAY").count = 2


def parent(chance: random.Random) -> None:
    child, root = chance.choice(objects()), chance.choice(objects())
    if root is not child and root.parent is None and not child.children:
        child.parent = root


def instance_a_collection(chance: random.Random) -> None:
    collection = bpy.data.collections.new("Group")
    collection.objects.link(chance.choice(objects()))
    made = bpy.data.objects.new("Instancer", None)
    made.instance_type, made.instance_collection = "COLLECTION", collection
    made.location.z = chance.uniform(1, 2)
    bpy.context.scene.collection.objects.link(made)


def move_an_empty(chance: random.Random) -> None:
    if objects("EMPTY"):
        chance.choice(objects("EMPTY")).location.y = chance.uniform(-1, 1)


def change_world(chance: random.Random) -> None:
    tree = bpy.context.scene.world.node_tree
    next(n for n in tree.nodes if n.type == "BACKGROUND").inputs[1].default_value = chance.random()


def switch_camera_rays(chance: random.Random) -> None:
    made = chance.choice(objects())
    made.visible_camera = not made.visible_camera


def switch_holdout(_chance: random.Random) -> None:
    layer = bpy.context.view_layer.layer_collection
    for child in layer.children:
        child.holdout = not child.holdout


EDITS: tuple[Callable[[random.Random], None], ...] = (
    add_object,
    delete_object,
    move,
    move_lamp,
    edit_lamp_nodes,
    link_a_lamp,
    edit_mesh,
    relink_material,
    edit_material,
    hide,
    hide_in_the_view_layer,
    rename,
    add_modifier,
    parent,
    instance_a_collection,
    move_an_empty,
    change_world,
    switch_camera_rays,
    switch_holdout,
)


# `make nightly` tries more.
SEQUENCES = int(os.environ.get("BASICRT_EDIT_SEQUENCES", "20"))


@pytest.mark.parametrize("seed", range(SEQUENCES))
def test_random_edits_give_the_picture_of_a_fresh_export(live: LiveScene, seed: int) -> None:
    chance = random.Random(seed)
    for step in range(12):
        edits = [chance.choice(EDITS) for _ in range(chance.choice((1, 1, 1, 3)))]
        for edit in edits:
            edit(chance)
        bpy.context.view_layer.update()
        same = np.array_equal(live.picture(), fresh_picture())
        assert same, f"seed {seed}, step {step}: {[edit.__name__ for edit in edits]}"
