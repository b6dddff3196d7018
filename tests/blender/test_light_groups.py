# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of light groups against Cycles' of the same names."""

from typing import Any

import bpy
import numpy as np
import pytest
from addon.report import Report

from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_plane,
    export,
    new_material,
    new_scene,
    passes_of_both,
    set_world,
)

GROUPS = ("Key", "Fill", "Sky", "Glow")


def add_groups(*names: str) -> None:
    for name in names:
        bpy.ops.scene.view_layer_add_lightgroup(name=name)


def scene_of_groups(samples: int = 512) -> Any:
    """Two balls on a floor under three lamps, one of them in no group, a glowing square and a sky."""
    scene = new_scene(32, 16, samples)
    add_plane(12, 0, new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.6, 0.5, 0.4)))
    for x, kind in ((-1, "ShaderNodeBsdfDiffuse"), (1, "ShaderNodeBsdfGlossy")):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.8, location=(x, 0, 0.8))
        bpy.context.object.data.materials.append(new_material(kind, kind, Color=(0.8, 0.6, 0.5)))
    glow = new_material("ShaderNodeEmission", "Glow", Color=(1, 0.6, 0.3), Strength=3.0)
    corners = [(-2.6, -1, 0.1), (-1.6, -1, 0.1), (-1.6, -1, 1.1), (-2.6, -1, 1.1)]
    add_mesh(corners, [(0, 1, 2, 3)], glow, "Square").lightgroup = "Glow"
    add_groups(*GROUPS)
    add_lamp("AREA", (2, -2, 4), (0.4, 0.3, 0), energy=80, size=2).lightgroup = "Key"
    add_lamp("POINT", (-3, -2, 3), energy=60, shadow_soft_size=0.4).lightgroup = "Fill"
    add_lamp("POINT", (0, 3, 3), energy=60, shadow_soft_size=0.4)
    set_world((0.2, 0.3, 0.5)).lightgroup = "Sky"
    add_camera((0, -8, 3), (1.25, 0, 0), kind="PERSP", lens=50)
    return scene


@pytest.fixture(scope="module", params=[False, True], ids=["opaque", "transparent"])
def both(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Our passes and Cycles', without the view layer's name."""
    folder = tmp_path_factory.mktemp("groups")
    scene = scene_of_groups()
    scene.render.film_transparent = request.param
    return passes_of_both(scene, folder)


def test_the_passes_are_cycles(both: Any) -> None:
    assert set(both[0]) == set(both[1]) == {"Combined", *(f"Combined_{name}" for name in GROUPS)}
    for name, ours in both[0].items():
        assert ours.shape == both[1][name].shape, name


@pytest.mark.parametrize("name", GROUPS)
def test_each_group_has_the_light_that_it_has_in_cycles(both: Any, name: str) -> None:
    """Means over cells of 8 x 8 pixels: noise is below 1 % of the picture's mean."""
    ours, theirs = (
        picture[f"Combined_{name}"].astype(float).reshape(2, 8, 4, 8, 3).mean(axis=(1, 3))
        for picture in both
    )
    assert theirs.mean() > 0.01
    np.testing.assert_allclose(ours, theirs, rtol=0.03, atol=0.03 * theirs.mean())


def test_what_no_group_has_is_the_other_lamp(both: Any) -> None:
    passes = both[0]
    total = sum(passes[f"Combined_{name}"].astype(float) for name in GROUPS)
    rest = passes["Combined"][..., :3] - total
    is_opaque = passes["Combined"][..., 3] == 1
    assert rest[is_opaque].min() > -1e-4
    assert rest[is_opaque].mean() > 0.005


def test_groups_are_those_of_the_view_layer() -> None:
    scene = scene_of_groups(1)
    add_groups("Unused")
    exported = export()
    by_name = {instance.name: instance.light_group for instance in exported.instances}
    assert by_name["Square"] == 4
    assert set(by_name.values()) == {0, 4}
    assert [light.light_group for light in exported.lights] == [1, 2, 0]
    assert exported.environment.light_group == 3
    passes = [name for name in exported.settings.passes if name.startswith("Light Group")]
    assert passes == [f"Light Group {number:02}" for number in range(1, 6)]
    other = scene.view_layers.new("Other")
    bpy.context.window.view_layer = other
    assert not [name for name in export().settings.passes if name.startswith("Light Group")]


def test_more_groups_than_there_are_passes_for_are_reported() -> None:
    new_scene()
    add_camera()
    add_groups(*(f"Group {number}" for number in range(1, 18)))
    report = Report()
    assert len([n for n in export(report).settings.passes if n.startswith("Light Group")]) == 16
    assert report.warnings == (
        'view layer "ViewLayer": there are 16 light groups at the most: "Group 17" is left out',
    )
