# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene arrives: instances share meshes, slots find their materials, flags hide from rays."""

from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import ExportError, Report
from mathutils import Matrix

import basicrt
from basicrt import RayKind
from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    add_plane,
    export,
    export_in_render,
    new_material,
    new_scene,
    place,
    set_world,
)

TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]


@pytest.fixture(autouse=True)
def scene() -> Any:
    made = new_scene()
    add_camera()
    return made


def add_triangle(name: str = "Triangle", material: Any = None, location: Any = (0, 0, 0)) -> Any:
    return add_mesh(TRIANGLE, [(0, 1, 2)], material, name, location)


def places(exported: basicrt.Scene) -> list[tuple[float, ...]]:
    return sorted(tuple(np.array(i.transform)[:3, 3]) for i in exported.instances)


# ---- instances ---------------------------------------------------------------------------------


def test_objects_with_the_same_mesh_share_it() -> None:
    first = add_triangle()
    place(first.data, (5, 0, 0))
    exported = export()
    assert len(exported.shapes) == 1
    assert [instance.shape for instance in exported.instances] == [0, 0]
    assert places(exported) == [(0, 0, 0), (5, 0, 0)]


def test_modifiers_of_one_object_do_not_change_its_siblings() -> None:
    first = add_triangle()
    second = place(first.data, (5, 0, 0))
    second.modifiers.new("Solid", "SOLIDIFY")
    exported = export()
    counts = sorted(len(exported.shapes[i.shape].triangles) for i in exported.instances)
    assert counts[0] == 1
    assert counts[1] > 1


def instance_collection(count: int) -> None:
    inner = add_triangle(location=(0, 0, 1))
    collection = bpy.data.collections.new("Collection")
    bpy.context.scene.collection.objects.unlink(inner)
    collection.objects.link(inner)
    for index in range(count):
        empty = bpy.data.objects.new(f"Empty {index}", None)
        empty.location = (2 * index, 0, 0)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        bpy.context.scene.collection.objects.link(empty)


def test_collection_instances_share_their_meshes() -> None:
    instance_collection(3)
    exported = export()
    assert len(exported.shapes) == 1
    assert places(exported) == [(0, 0, 1), (2, 0, 1), (4, 0, 1)]


def scatter(points: int) -> Any:
    """An object whose geometry nodes put a painted ball on each corner of a grid."""
    made = add_triangle("Scatter")
    group = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    grid = group.nodes.new("GeometryNodeMeshGrid")
    grid.inputs["Vertices X"].default_value = points
    grid.inputs["Vertices Y"].default_value = 1
    ball = group.nodes.new("GeometryNodeMeshIcoSphere")
    paint = group.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = new_material(
        "ShaderNodeBsdfDiffuse", "Paint", Color=(1, 0, 0)
    )
    instances = group.nodes.new("GeometryNodeInstanceOnPoints")
    group.links.new(grid.outputs["Mesh"], instances.inputs["Points"])
    group.links.new(ball.outputs["Mesh"], paint.inputs["Geometry"])
    group.links.new(paint.outputs[0], instances.inputs["Instance"])
    sink = group.nodes.new("NodeGroupOutput")
    group.links.new(instances.outputs[0], sink.inputs[0])
    made.modifiers.new("Scatter", "NODES").node_group = group
    return made


def test_geometry_nodes_instances_share_a_mesh_and_keep_its_material() -> None:
    scatter(50)
    exported = export()
    assert len(exported.instances) == 50
    assert len(exported.shapes) == 1
    assert len(exported.materials) == 1
    (slot,) = set(exported.shapes[0].material_slots)
    assert all(instance.materials[slot] == 0 for instance in exported.instances)


def test_instancer_may_hide_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    parent = add_plane(2)
    child = add_triangle()
    child.parent = parent
    parent.instance_type = "FACES"
    parent.show_instancer_for_render = False
    exported = export_in_render(monkeypatch)
    assert [len(exported.shapes[i.shape].triangles) for i in exported.instances] == [1]


def test_instance_transforms_are_exact() -> None:
    made = add_triangle()
    matrix = Matrix(((1, 0.2, 0, 3), (0, -2, 0.1, 4), (0.3, 0, 1.5, 5), (0, 0, 0, 1)))
    made.matrix_world = matrix
    made.parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(made.parent)
    made.parent.matrix_world = matrix
    made.matrix_parent_inverse = Matrix()
    bpy.context.view_layer.update()
    (instance,) = export().instances
    np.testing.assert_allclose(instance.transform, np.array(made.matrix_world), rtol=1e-6)


def test_object_without_extent_is_left_out_with_a_warning() -> None:
    made = add_triangle()
    made.scale = (1, 0, 1)
    report = Report()
    assert len(export(report).instances) == 0
    assert report.warnings == ('object "Triangle": scaled to nothing along an axis: left out',)


def test_vertex_that_is_not_a_number_names_the_object() -> None:
    made = add_triangle("Broken")
    made.data.attributes["position"].data[1].vector = (float("nan"), 0, 0)
    with pytest.raises(ExportError, match=r'object "Broken": positions\[1, 0\].*nan'):
        export()


def test_transform_that_is_not_a_number_names_the_object() -> None:
    add_triangle("Lost").location = (float("nan"), 0, 0)
    with pytest.raises(ExportError, match='object "Lost": its transform is not finite'):
        export()


def test_hidden_objects_stay_out_of_renders(monkeypatch: pytest.MonkeyPatch) -> None:
    add_triangle("Seen").hide_viewport = True
    add_triangle("Hidden").hide_render = True
    assert [i.name for i in export_in_render(monkeypatch).instances] == ["Seen"]


# ---- materials ---------------------------------------------------------------------------------


def diffuse(name: str) -> Any:
    return new_material("ShaderNodeBsdfDiffuse", name, Color=(0.5, 0.5, 0.5))


def material_names(exported: basicrt.Scene) -> list[list[str | None]]:
    return [
        [None if index is None else exported.materials[index].name for index in instance.materials]
        for instance in exported.instances
    ]


def test_slots_in_order_with_gaps() -> None:
    made = add_triangle()
    for material in (diffuse("First"), None, diffuse("Third")):
        made.data.materials.append(material)
    assert material_names(export()) == [["First", None, "Third"]]


def test_mesh_without_slots_has_no_materials() -> None:
    add_triangle()
    assert material_names(export()) == [[]]


def test_slot_of_the_object_overrides_the_meshs() -> None:
    first = add_triangle(material=diffuse("Mesh's"))
    second = place(first.data)
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = diffuse("Object's")
    exported = export()
    assert sorted(material_names(exported)) == [["Mesh's"], ["Object's"]]
    assert len(exported.shapes) == 1


def test_shared_material_is_translated_once() -> None:
    material = diffuse("Shared")
    add_triangle(material=material)
    add_triangle(material=material)
    assert len(export().materials) == 1


def test_view_layers_material_override_replaces_all() -> None:
    made = add_triangle()
    for name in ("One", "Two"):
        made.data.materials.append(diffuse(name))
    bpy.context.view_layer.material_override = diffuse("Override")
    assert material_names(export()) == [["Override"]]


# ---- visibility --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("switch", "kind"),
    [
        ("visible_camera", RayKind.CAMERA),
        ("visible_diffuse", RayKind.DIFFUSE),
        ("visible_glossy", RayKind.GLOSSY),
        ("visible_transmission", RayKind.TRANSMISSION),
        ("visible_volume_scatter", RayKind.VOLUME),
        ("visible_shadow", RayKind.SHADOW),
    ],
)
def test_ray_visibility(switch: str, kind: RayKind) -> None:
    setattr(add_triangle(), switch, False)
    (instance,) = export().instances
    assert instance.visibility == RayKind.ALL & ~kind


def test_instances_are_hidden_with_what_instances_them() -> None:
    instance_collection(2)
    bpy.data.objects["Empty 1"].visible_glossy = False
    by_place = {np.array(i.transform)[0, 3]: i.visibility for i in export().instances}
    assert by_place == {0: RayKind.ALL, 2: RayKind.ALL & ~RayKind.GLOSSY}


def test_indirect_only_collections_hide_from_the_camera() -> None:
    made = add_triangle()
    collection = bpy.data.collections.new("Indirect")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(made)
    bpy.context.scene.collection.objects.unlink(made)
    bpy.context.view_layer.layer_collection.children["Indirect"].indirect_only = True
    (instance,) = export().instances
    assert instance.visibility == RayKind.ALL & ~RayKind.CAMERA


# ---- world, camera, reports --------------------------------------------------------------------


def test_world_is_colour_times_strength() -> None:
    set_world((0.25, 0.5, 1), 2)
    assert export().environment.radiance == (0.5, 1, 2)


def test_no_world_is_black() -> None:
    assert export().environment.radiance == (0, 0, 0)


@pytest.mark.skipif(bpy.app.version >= (5, 0, 0), reason="a world always has nodes from 5.0 on")
def test_world_without_nodes_has_its_viewport_colour() -> None:
    world = bpy.data.worlds.new("Plain")
    world.color = (0.25, 0.5, 0.75)
    bpy.context.scene.world = world
    assert export().environment.radiance == (0.25, 0.5, 0.75)


def test_world_shader_that_is_no_light_is_black() -> None:
    world = set_world((1, 1, 1))
    tree = world.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    diffuse = add_node(tree, "ShaderNodeBsdfDiffuse")
    tree.links.new(diffuse.outputs[0], output.inputs[0])
    report = Report()
    assert export(report).environment.radiance == (0, 0, 0)
    assert report.warnings == (
        'world "World": node "Diffuse BSDF" is not supported: black instead',
    )


def test_scene_without_camera_is_refused() -> None:
    bpy.context.scene.camera = None
    with pytest.raises(ExportError, match='scene "Scene" has no camera'):
        export()


def test_what_cannot_be_drawn_is_reported_once() -> None:
    place(bpy.data.hair_curves.new("Hair"), name="Hair")  # of no curves: there is nothing to tell
    for _ in range(2):
        place(bpy.data.volumes.new("Smoke"), name="Smoke")
    add_lamp("POINT", energy=1)
    report = Report()
    export(report)
    assert sorted(report.warnings) == [
        'object "Smoke": volumes are not supported: left out',
        'object "Smoke.001": volumes are not supported: left out',
    ]


def test_settings_arrive() -> None:
    scene = bpy.context.scene
    own = scene.basicrt
    own.samples, own.seed, own.bvh_builder = 7, 11, "MEDIAN"
    own.sampler = "INDEPENDENT"
    own.max_bounces, own.diffuse_bounces, own.glossy_bounces = 9, 8, 7
    own.transmission_bounces, own.transparent_bounces = 6, 5
    own.filter_type, own.filter_width, own.film_exposure = "GAUSSIAN", 2.5, 3.0
    scene.render.film_transparent = True
    settings = export().settings
    assert (settings.width, settings.height) == (16, 16)
    assert (settings.samples, settings.seed, settings.bvh_builder) == (7, 11, "median")
    assert settings.sampler == "independent"
    assert (settings.max_bounces, settings.diffuse_bounces, settings.glossy_bounces) == (9, 8, 7)
    assert (settings.transmission_bounces, settings.transparent_bounces) == (6, 5)
    assert (settings.filter_type, settings.exposure) == ("gaussian", 3)
    # Blender's is exp(-2 (2 x / width)^2), cut off at 1.5 widths.
    assert (settings.filter_radius, settings.filter_falloff) == pytest.approx((3.75, 8 / 2.5**2))
    assert settings.film_transparent
    assert settings.passes == ["Combined"]


@pytest.mark.parametrize("name", ["BOX", "TENT", "GAUSSIAN", "BLACKMAN_HARRIS", "MITCHELL"])
def test_every_filter_is_known_to_the_core(name: str) -> None:
    bpy.context.scene.basicrt.filter_type = name
    settings = export().settings
    assert settings.filter_type == name.lower()
    assert settings.filter_radius == {"BOX": 0.5, "GAUSSIAN": 2.25}.get(name, 1.5)


def test_view_layer_may_have_its_own_samples() -> None:
    bpy.context.scene.basicrt.samples = 7
    bpy.context.view_layer.samples = 3
    assert export().settings.samples == 3


def test_passes_follow_the_view_layer() -> None:
    bpy.context.view_layer.use_pass_z = True
    bpy.context.view_layer.use_pass_normal = True
    assert export().settings.passes == ["Combined", "Depth", "Normal"]
