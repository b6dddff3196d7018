# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair and points arrive whole: curves objects, particle systems, point clouds, and what their nodes say."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

import basicrt
from support.blender import (
    add_camera,
    add_plane,
    empty_material,
    export,
    export_in_render,
    new_scene,
    place,
    render,
    render_both,
)

STRANDS = [
    [(-1.5, -1, 0), (-1, 0, 0.2), (-1.4, 1, 0)],
    [(0, -1.2, 0), (0.3, -0.3, 0), (-0.2, 0.5, 0.1), (0.4, 1.2, 0)],
    [(1.2, -1, 0), (1.5, 1, 0)],
]


@pytest.fixture(autouse=True)
def scene() -> Any:
    made = new_scene(32, 32, 16)
    add_camera(ortho_scale=4)
    return made


def add_curves(radius: float | None = 0.2, material: Any = None) -> Any:
    """A curves object of the strands."""
    curves: Any = bpy.data.hair_curves.new("Hair")
    curves.add_curves([len(strand) for strand in STRANDS])
    points = np.concatenate([np.array(strand, np.float32) for strand in STRANDS])
    curves.attributes["position"].data.foreach_set("vector", points.ravel())
    if radius is not None:
        radii = np.linspace(radius, radius / 2, len(points), dtype=np.float32)
        curves.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
    if material is not None:
        curves.materials.append(material)
    return place(curves)


def add_points(radius: float = 0.4, material: Any = None) -> Any:
    """A point cloud, which geometry nodes make of a plane's vertices in any version."""
    made = add_plane(2)
    tree: Any = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    source, target = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    to_points = tree.nodes.new("GeometryNodeMeshToPoints")
    to_points.inputs["Radius"].default_value = radius
    last = to_points.outputs[0]
    tree.links.new(source.outputs[0], to_points.inputs[0])
    if material is not None:
        node = tree.nodes.new("GeometryNodeSetMaterial")
        node.inputs["Material"].default_value = material
        tree.links.new(last, node.inputs["Geometry"])
        last = node.outputs[0]
    tree.links.new(last, target.inputs[0])
    made.modifiers.new("Points", "NODES").node_group = tree
    return made


def add_particles(**settings: Any) -> tuple[Any, Any]:
    """A plane with straight hair, and the system's settings."""
    made = add_plane(2)
    made.modifiers.new("Hair", "PARTICLE_SYSTEM")
    own: Any = made.particle_systems[0].settings
    own.type, own.count, own.hair_length = "HAIR", 20, 0.5
    for name, value in settings.items():
        setattr(own, name, value)
    return made, own


def only_shape(kind: Any, exported: basicrt.Scene) -> Any:
    found = [exported.shapes[one.shape] for one in exported.instances]
    found = [shape for shape in found if isinstance(shape, kind)]
    assert len(found) == 1
    return found[0]


def emitter(node: str, output: str) -> Any:
    """A material that shines what a node gives."""
    material, tree, target = empty_material(output)
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(tree.nodes.new(node).outputs[output], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], target.inputs["Surface"])
    return material


def test_curves_have_their_points_and_radii() -> None:
    add_curves()
    curves = only_shape(basicrt.Curves, export())
    np.testing.assert_array_equal(curves.points, np.concatenate(STRANDS).astype(np.float32))
    np.testing.assert_allclose(curves.radii, np.linspace(0.2, 0.1, 9), rtol=1e-6)
    np.testing.assert_array_equal(curves.firsts, [0, 3, 7])
    assert len(set(curves.randoms)) == 3


def test_curves_of_other_kinds_are_told() -> None:
    made = add_curves()
    if not hasattr(made.data, "set_types"):
        pytest.skip("this Blender's Python can't make any")
    made.data.set_types(type="POLY")
    report = Report()
    export(report)
    assert any("Catmull-Rom" in text for text in report.warnings)


def test_curves_attributes_are_what_materials_ask_for() -> None:
    material, tree, target = empty_material("Dye")
    node: Any = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "dye"
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(node.outputs["Fac"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], target.inputs["Surface"])
    made = add_curves(material=material)
    made.data.attributes.new("dye", "FLOAT", "CURVE").data.foreach_set("value", [0.25, 0.5, 1.0])
    ((_, domain, values),) = only_shape(basicrt.Curves, export()).attributes
    assert domain == "face"
    np.testing.assert_array_equal(values[:, 0], [0.25, 0.5, 1.0])


@pytest.mark.parametrize("shape", ["RIBBONS", "THICK"])
def test_cycles_setting_says_what_curves_look_like(scene: Any, shape: str) -> None:
    if not hasattr(scene, "cycles_curves"):
        pytest.skip("Cycles is not there")
    scene.cycles_curves.shape = shape
    add_curves()
    form = only_shape(basicrt.Curves, export()).form
    assert form == {"RIBBONS": "ribbon", "THICK": "round"}[shape]


def test_particle_hair_grows_where_the_particles_are(monkeypatch: pytest.MonkeyPatch) -> None:
    made, settings = add_particles(render_step=2, root_radius=1.0, tip_radius=0.25)
    settings.radius_scale = 0.02
    made.location = (0, 0, 1)
    curves = only_shape(basicrt.Curves, export_in_render(monkeypatch))
    assert len(curves.firsts) == 20
    roots = np.asarray(curves.points)[np.asarray(curves.firsts)]
    np.testing.assert_allclose(roots[:, 2], 0, atol=1e-5)  # in the object's space
    assert (np.abs(roots[:, :2]) <= 1).all()
    ends = np.append(np.asarray(curves.firsts)[1:], len(curves.points)) - 1
    lengths = np.linalg.norm(np.asarray(curves.points)[ends] - roots, axis=1)
    np.testing.assert_allclose(lengths, lengths[0], rtol=1e-3)
    np.testing.assert_allclose(np.asarray(curves.radii)[np.asarray(curves.firsts)], 0.01, rtol=1e-5)
    closed = np.asarray(curves.radii)[ends]
    np.testing.assert_allclose(closed, 0.0 if settings.use_close_tip else 0.0025, rtol=1e-4)


def test_children_stand_for_their_parents(monkeypatch: pytest.MonkeyPatch) -> None:
    add_particles(child_type="SIMPLE", rendered_child_count=3)
    curves = only_shape(basicrt.Curves, export_in_render(monkeypatch))
    assert len(curves.firsts) == 60


def test_hair_is_there_without_what_it_grows_on(monkeypatch: pytest.MonkeyPatch) -> None:
    made, _ = add_particles()
    made.show_instancer_for_render = False
    exported = export_in_render(monkeypatch)
    kinds = {type(exported.shapes[one.shape]) for one in exported.instances}
    assert kinds == {basicrt.Curves}


def test_particles_that_are_no_hair_are_left_out() -> None:
    add_particles(render_type="NONE")
    exported = export()
    assert {type(exported.shapes[one.shape]) for one in exported.instances} == {basicrt.Mesh}


def test_point_clouds_have_their_points() -> None:
    add_points(0.3)
    cloud = only_shape(basicrt.PointCloud, export())
    expected = {(x, y, 0) for x in (-1, 1) for y in (-1, 1)}
    assert {tuple(point) for point in cloud.positions.tolist()} == expected
    np.testing.assert_allclose(cloud.radii, 0.3)


def test_hair_is_seen(tmp_path: Path) -> None:
    add_curves(material=emitter("ShaderNodeHairInfo", "Is Strand"))
    covered = render(tmp_path)[..., 0].mean()
    # About the strands' lengths times their thickness, of 16 square metres.
    assert 0.05 < covered < 0.2


IN_CYCLES = pytest.mark.skipif(
    bpy.app.version[:2] not in ((4, 2), (4, 5), (5, 0), (5, 2)), reason="compared in these"
)
HAIR = ["Is Strand", "Intercept", "Length", "Thickness", "Tangent Normal", "Random"]


@IN_CYCLES
@pytest.mark.slow
@pytest.mark.parametrize("output", HAIR)
@pytest.mark.parametrize("shape", ["RIBBONS", "THICK"])
def test_hair_info_is_as_in_cycles(scene: Any, shape: str, output: str, tmp_path: Path) -> None:
    scene.cycles_curves.shape = shape
    add_curves(material=emitter("ShaderNodeHairInfo", output))
    expect_alike(tmp_path, ends=0.02 if shape == "THICK" else 0.0)


@IN_CYCLES
@pytest.mark.slow
def test_radii_that_are_not_said_are_as_in_cycles(scene: Any, tmp_path: Path) -> None:
    scene.camera.data.ortho_scale = 0.1
    scene.cycles_curves.shape = "THICK"
    scene.camera.location.x = -1
    add_curves(None, emitter("ShaderNodeHairInfo", "Is Strand"))
    expect_alike(tmp_path)


@IN_CYCLES
@pytest.mark.slow
@pytest.mark.parametrize("output", ["Position", "Radius", "Random"])
def test_point_info_is_as_in_cycles(scene: Any, output: str, tmp_path: Path) -> None:
    add_points(material=emitter("ShaderNodePointInfo", output))
    expect_alike(tmp_path)


@IN_CYCLES
@pytest.mark.slow
def test_particle_hair_is_as_in_cycles(scene: Any, tmp_path: Path) -> None:
    material = emitter("ShaderNodeHairInfo", "Intercept")
    made, settings = add_particles(child_type="SIMPLE", rendered_child_count=5, render_step=3)
    settings.radius_scale, settings.shape = 0.1, -0.4
    made.data.materials.append(material)
    made.rotation_euler = (1.2, 0, 0.3)
    expect_alike(tmp_path)


def expect_alike(folder: Path, ends: float = 0.0) -> None:
    """Both engines' pictures at pixels' centres, but for a few that lie on an edge.

    On ribbons Cycles measures along straight pieces. It has no half spheres at round curves' ends,
    which cover the share `ends` of the picture. What is negative doesn't shine here.
    """
    ours, theirs = (picture[..., :3].astype(float) for picture in render_both(folder))
    theirs = np.maximum(theirs, 0.0)
    scale = np.abs(theirs).max()
    assert scale > 0
    unlike = (np.abs(ours - theirs) > 0.03 * scale).any(axis=2)
    seen = (theirs > 0).any(axis=2)
    where = f"{(unlike & seen).sum()} and {(unlike & ~seen).sum()} of {seen.sum()} pixels"
    assert (unlike & seen).mean() < 0.005, where
    assert (unlike & ~seen).mean() <= 0.003 + ends, where
