# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps in radiometric units: the closed forms of docs/conventions.md, in Blender's watts and strengths."""

import math

import bpy
import numpy as np
import pytest
from addon.report import Report
from mathutils import Euler, Matrix

import basicrt
from support.blender import add_camera, add_lamp, add_node, export, new_scene

HAS_EXPOSURE = bpy.app.version >= (4, 5, 0)
needs_exposure = pytest.mark.skipif(
    not HAS_EXPOSURE, reason="lamps have exposure, temperature and normalize from 4.5 on"
)


@pytest.fixture(autouse=True)
def scene() -> None:
    new_scene()
    add_camera()


def only_lamp(report: Report | None = None) -> basicrt.PointLight:
    lights = export(report).lights
    assert len(lights) == 1
    return lights[0]


def test_point_spreads_its_watts_over_the_sphere() -> None:
    add_lamp("POINT", (1, 2, 3), energy=100, color=(1, 0.5, 0.25), shadow_soft_size=0.3)
    lamp = only_lamp()
    assert isinstance(lamp, basicrt.PointLight)
    assert lamp.intensity == pytest.approx([100 / (4 * math.pi) * c for c in (1, 0.5, 0.25)])
    assert lamp.position == pytest.approx((1, 2, 3))
    assert lamp.radius == pytest.approx(0.3)
    assert lamp.soft


def test_soft_falloff_can_be_off() -> None:
    add_lamp("POINT", energy=1, use_soft_falloff=False)
    assert not only_lamp().soft


def test_point_ignores_the_objects_scale() -> None:
    add_lamp("POINT", energy=100, shadow_soft_size=0.3).scale = (5, 5, 5)
    assert only_lamp().radius == pytest.approx(0.3)


def test_spot_has_a_points_intensity_whatever_its_cone() -> None:
    made = add_lamp("SPOT", (0, 0, 2), (0.4, 0, 0.2), energy=100, spot_blend=0.3)
    made.data.spot_size = math.radians(50)
    lamp = only_lamp()
    assert isinstance(lamp, basicrt.SpotLight)
    assert lamp.intensity == pytest.approx([100 / (4 * math.pi)] * 3)
    assert (lamp.angle, lamp.blend) == pytest.approx((math.radians(50), 0.3))
    expected = Matrix.LocRotScale((0, 0, 2), Euler((0.4, 0, 0.2)), None)
    np.testing.assert_allclose(lamp.transform, np.array(expected), atol=1e-6)


def test_sun_shines_along_its_local_minus_z() -> None:
    add_lamp("SUN", rotation=(math.radians(60), 0, 0), energy=3, angle=math.radians(10))
    lamp = only_lamp()
    assert isinstance(lamp, basicrt.SunLight)
    assert lamp.irradiance == pytest.approx((3, 3, 3))
    assert lamp.angle == pytest.approx(math.radians(10))
    # Turned by 60 degrees about x, -z comes to (0, sin 60, -cos 60).
    assert lamp.direction == pytest.approx((0, math.sin(math.radians(60)), -0.5), abs=1e-6)


@pytest.mark.parametrize(
    ("shape", "size_y", "share"),
    [
        ("SQUARE", 2.0, 1),
        ("RECTANGLE", 0.5, 1),
        ("DISK", 2.0, math.pi / 4),
        ("ELLIPSE", 0.5, math.pi / 4),
    ],
)
def test_area_divides_its_watts_by_its_area_in_the_world(
    shape: str, size_y: float, share: float
) -> None:
    made = add_lamp("AREA", energy=100, shape=shape, size=2.0, spread=1.0)
    made.data.size_y = 0.5
    made.scale = (3, 2, 7)
    lamp = only_lamp()
    assert isinstance(lamp, basicrt.AreaLight)
    area = (2.0 * 3) * (size_y * 2) * share
    assert lamp.radiance == pytest.approx([100 / (math.pi * area)] * 3)
    assert lamp.ellipse == (share != 1)
    assert lamp.spread == pytest.approx(1.0)
    # The unit square is stretched to the lamp's size; its axis keeps unit length.
    np.testing.assert_allclose(
        np.array(lamp.transform)[:3, :3], np.diag((6, size_y * 2, 1)), rtol=1e-6
    )


def test_area_without_size_is_left_out() -> None:
    add_lamp("AREA", energy=100).scale = (0, 1, 1)
    report = Report()
    assert len(export(report).lights) == 0
    assert report.warnings == ('light "Area": has no size, and so no light',)


@needs_exposure
def test_exposure_doubles_for_each_stop() -> None:
    add_lamp("SUN", energy=3, exposure=2)
    assert only_lamp().irradiance == pytest.approx((12, 12, 12))


@needs_exposure
def test_temperature_multiplies_the_colour() -> None:
    add_lamp("SUN", energy=2, color=(1, 0.5, 1), use_temperature=True, temperature=3000)
    # Cycles' colour of 3000 K (RADIOMETRY): (1.771, .844, .272).
    expected = (2 * 1.771, 2 * 0.5 * 0.844, 2 * 0.272)
    assert only_lamp().irradiance == pytest.approx(expected, rel=5e-3)


@needs_exposure
def test_without_normalize_strength_is_the_surfaces() -> None:
    add_lamp("AREA", energy=100, size=0.5, shape="SQUARE", normalize=False)
    assert only_lamp().radiance == pytest.approx([100 / math.pi] * 3)


@needs_exposure
def test_unnormalized_ball_and_sun() -> None:
    add_lamp("POINT", energy=100, shadow_soft_size=0.5, normalize=False)
    add_lamp("SUN", energy=7, angle=0.2, normalize=False)
    ball, sun = export().lights
    # Radiance 100 / pi, seen over a disc of area pi r^2.
    assert ball.intensity == pytest.approx([100 * 0.25] * 3)
    assert sun.irradiance == pytest.approx([7 * math.pi * math.sin(0.1) ** 2] * 3)


def test_emission_node_scales_the_lamp() -> None:
    made = add_lamp("SUN", energy=2)
    if bpy.app.version < (5, 1, 0):
        made.data.use_nodes = True
    tree = made.data.node_tree
    tree.nodes.clear()
    emission = add_node(tree, "ShaderNodeEmission", Color=(1, 0.5, 0), Strength=3)
    tree.links.new(emission.outputs[0], tree.nodes.new("ShaderNodeOutputLight").inputs[0])
    assert only_lamp().irradiance == pytest.approx((6, 3, 0))


def test_negative_energy_gives_no_light() -> None:
    add_lamp("SUN", energy=-2)
    assert only_lamp().irradiance == pytest.approx((0, 0, 0))


def test_camera_sees_a_lamp_only_where_the_object_says_so() -> None:
    made = add_lamp("AREA", energy=1)
    assert not only_lamp().camera_visible, "Blender's default"
    made.visible_camera = True
    assert only_lamp().camera_visible


def test_each_kind_of_ray_has_its_switch() -> None:
    made = add_lamp("SPOT", energy=1)
    made.visible_camera = True
    names = {
        "visible_camera": "camera_visible",
        "visible_diffuse": "diffuse_visible",
        "visible_glossy": "glossy_visible",
        "visible_transmission": "transmission_visible",
        "visible_volume_scatter": "volume_visible",
    }
    for b_name, hidden in names.items():
        setattr(made, b_name, False)
        lamp = only_lamp()
        assert {name: getattr(lamp, name) for name in names.values()} == {
            name: name != hidden for name in names.values()
        }
        setattr(made, b_name, True)


def test_lamps_without_shadows_and_with_a_last_bounce() -> None:
    made = add_lamp("POINT", energy=1)
    report = Report()
    lamp = only_lamp(report)
    assert (lamp.casts_shadows, lamp.max_bounces) == (True, 1024), "Blender's defaults"
    made.data.use_shadow = False
    made.data.cycles.max_bounces = 3
    lamp = only_lamp(report)
    assert (lamp.casts_shadows, lamp.max_bounces) == (False, 3)
    assert report.warnings == ()


def test_portal_is_left_out_and_reported() -> None:
    add_lamp("AREA", energy=1).data.cycles.is_portal = True
    report = Report()
    assert len(export(report).lights) == 0
    assert report.warnings == (
        'light "Area": a portal gives no light and only guides Cycles\' sampling: it is left out',
    )


def test_lamps_of_instanced_collections_shine() -> None:
    made = add_lamp("POINT", (0, 0, 1), energy=1)
    collection = bpy.data.collections.new("Lamps")
    bpy.context.scene.collection.objects.unlink(made)
    collection.objects.link(made)
    for x in (2, 4):
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location = (x, 0, 0)
        bpy.context.scene.collection.objects.link(empty)
    assert [tuple(lamp.position) for lamp in export().lights] == [(2, 0, 1), (4, 0, 1)]
