# SPDX-License-Identifier: GPL-3.0-or-later
"""Light linking and shadow linking against Cycles', and how they are exported."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import pytest
from addon.report import Report

from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_plane,
    export,
    new_material,
    place,
    set_world,
)
from support.cycles import both, expect_alike, neutral_scene


def collection(
    *included: Any, excluded: tuple[Any, ...] = (), children: tuple[Any, ...] = ()
) -> Any:
    """A collection of objects, and of collections, that a light's links may be."""
    made = bpy.data.collections.new("Links")
    for each in (*included, *excluded):
        made.objects.link(each)
    for each in children:
        made.children.link(each)
    for each, state in zip(made.objects, made.collection_objects, strict=True):
        if each in excluded:
            state.light_linking.link_state = "EXCLUDE"
    return made


class Stage:
    """Two balls and a slab on a floor, dark but for what a test adds."""

    def __init__(self) -> None:
        self.scene = neutral_scene(24, samples=128)
        set_world((0.0, 0.0, 0.0))
        add_camera((0, -7, 3.5), (1.15, 0, 0), kind="PERSP", lens=40)
        floor = new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.7, 0.6, 0.5))
        self.floor = add_plane(14, 0, floor, "Floor")
        self.matt = self.ball(-1.2, new_material("ShaderNodeBsdfDiffuse", "Matt"), "Matt")
        glossy = new_material("ShaderNodeBsdfGlossy", "Glossy", Roughness=0.25)
        self.glossy = self.ball(1.2, glossy, "Glossy")
        corners = [(-1.5, -1.5, 2.2), (1.5, -1.5, 2.2), (1.5, 1.5, 2.2), (-1.5, 1.5, 2.2)]
        slab = new_material("ShaderNodeBsdfDiffuse", "Slab", Color=(0.2, 0.3, 0.8))
        self.slab = add_mesh(corners, [(0, 1, 2, 3)], slab, "Slab")

    def ball(self, x: float, material: Any, name: str) -> Any:
        bpy.ops.mesh.primitive_uv_sphere_add(
            radius=0.9, location=(x, 0, 0.9), segments=16, ring_count=8
        )
        bpy.context.object.name = name
        bpy.context.object.data.materials.append(material)
        return bpy.context.object

    def area(self, **values: Any) -> Any:
        return add_lamp("AREA", (0, 0, 4), energy=300, size=1.5, **values)

    def glow(self) -> Any:
        emission = new_material("ShaderNodeEmission", "Glow", Strength=12.0)
        corners = [(-0.7, -0.7, 4), (0.7, -0.7, 4), (0.7, 0.7, 4), (-0.7, 0.7, 4)]
        return add_mesh(corners, [(3, 2, 1, 0)], emission, "Glow")


def link_area(stage: Stage) -> None:
    lamp = stage.area()
    lamp.light_linking.receiver_collection = collection(stage.matt, stage.slab)
    add_lamp("POINT", (3, -3, 3), energy=150, shadow_soft_size=0.3)


def exclude_from_point(stage: Stage) -> None:
    lamp = add_lamp("POINT", (0, -1, 3.5), energy=300, shadow_soft_size=0.5)
    lamp.light_linking.receiver_collection = collection(excluded=(stage.floor, stage.glossy))
    other = add_lamp("SUN", rotation=(0.5, 0.3, 0), energy=2, angle=0.2)
    other.light_linking.receiver_collection = collection(stage.floor)


def link_glow(stage: Stage) -> None:
    stage.glow().light_linking.receiver_collection = collection(stage.glossy, stage.slab)
    set_world((0.1, 0.1, 0.1))


def pass_the_slab(stage: Stage) -> None:
    lamp = stage.area()
    lamp.light_linking.blocker_collection = collection(excluded=(stage.slab,))


def dim_by_the_slab_alone(stage: Stage) -> None:
    lamp = add_lamp("SUN", rotation=(0.3, 0.2, 0), energy=3, angle=0.3)
    lamp.light_linking.blocker_collection = collection(stage.slab)


def pass_the_slab_from_a_glow(stage: Stage) -> None:
    stage.glow().light_linking.blocker_collection = collection(excluded=(stage.slab,))


def link_both_ways(stage: Stage) -> None:
    lamp = stage.area()
    inner = collection(stage.matt)
    outer = collection(stage.floor, children=(collection(children=(inner,)),))
    lamp.light_linking.receiver_collection = outer
    outer.collection_children[0].light_linking.link_state = "EXCLUDE"
    lamp.light_linking.blocker_collection = collection(stage.glossy)
    set_world((0.1, 0.1, 0.2))


def link_instances(stage: Stage) -> None:
    """Of a collection's instances the empty that places them is what receives."""
    source = bpy.data.collections.new("Source")
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(0, 0, 0))
    cube = bpy.context.object
    bpy.context.collection.objects.unlink(cube)
    source.objects.link(cube)
    empties = [place(None, (x, -2, 0.4), name="Empty") for x in (-1.5, 1.5)]
    for empty in empties:
        empty.instance_type, empty.instance_collection = "COLLECTION", source
    stage.area().light_linking.receiver_collection = collection(stage.floor, empties[0])


def link_in_fog(stage: Stage) -> None:
    fog = new_material("ShaderNodeEmission", "Fog")
    tree = fog.node_tree
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    scatter.inputs["Density"].default_value = 0.4
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    for link in list(tree.links):
        tree.links.remove(link)
    tree.links.new(scatter.outputs[0], output.inputs["Volume"])
    bpy.ops.mesh.primitive_cube_add(size=4, location=(0, 0, 2.01))
    box = bpy.context.object
    box.data.materials.append(fog)
    lamp = add_lamp("POINT", (0, -1, 3.5), energy=200, shadow_soft_size=0.3)
    lamp.light_linking.receiver_collection = collection(excluded=(box,))
    other = add_lamp("POINT", (1.5, -2, 1), energy=100, shadow_soft_size=0.3)
    other.light_linking.receiver_collection = collection(box, stage.slab)


CASES = [
    link_area,
    exclude_from_point,
    link_glow,
    pass_the_slab,
    dim_by_the_slab_alone,
    pass_the_slab_from_a_glow,
    link_both_ways,
    link_instances,
    link_in_fog,
]


@pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="compared in one version: 5.0")
@pytest.mark.parametrize("add_lights", CASES, ids=lambda one: str(one.__name__))
def test_pictures_are_cycles(add_lights: Callable[[Stage], None], tmp_path: Path) -> None:
    stage = Stage()
    add_lights(stage)
    ours, theirs = both(stage.scene, tmp_path)
    expect_alike(ours, theirs, relative=0.01)


def by_name(scene: Any) -> dict[str, Any]:
    return {instance.name: instance for instance in scene.instances}


def test_links_are_exported_as_sets() -> None:
    stage = Stage()
    first = stage.area()
    first.light_linking.receiver_collection = collection(stage.matt, stage.glossy)
    second = add_lamp("POINT", (0, 0, 3))
    second.light_linking.receiver_collection = collection(excluded=(stage.matt,))
    scene = export()
    objects = by_name(scene)
    matt, glossy = objects["Matt"].receiver_set, objects["Glossy"].receiver_set
    assert objects["Floor"].receiver_set == 0
    assert sorted([matt, glossy]) == [1, 2]
    assert scene.lights[0].lit_sets == [1, 2]
    assert scene.lights[1].lit_sets == [index for index in range(64) if index != matt]
    assert scene.lights[0].blocker_sets is None


def test_empty_collections_link_nothing() -> None:
    stage = Stage()
    lamp = stage.area()
    lamp.light_linking.receiver_collection = collection()
    lamp.light_linking.blocker_collection = collection()
    scene = export()
    assert scene.lights[0].lit_sets is None
    assert scene.lights[0].blocker_sets is None


def test_what_there_is_no_room_for_is_told() -> None:
    stage = Stage()
    for index in range(70):
        ball = place(stage.matt.data, (index, 5, 0), name=f"Ball {index}")
        lamp = add_lamp("POINT", (index, 0, 3))
        lamp.light_linking.receiver_collection = collection(ball)
        lamp.light_linking.blocker_collection = collection(ball) if index < 30 else None
    report = Report()
    scene = export(report)
    assert len({tuple(light.blocker_sets or ()) for light in scene.lights}) == 24 + 1
    told = [text for text in report.warnings if text.startswith('scene "Scene": ')]
    assert len(told) == 2, told
    assert "63 ways at the most, there are 70" in told[0]
    assert "24 different shadow links" in told[1]
