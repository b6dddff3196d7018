# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes: what becomes of their nodes, and their pictures against Cycles'."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.nodes import Textures, translate_surface
from addon.nodes.blackbody import blackbody_color
from addon.report import Report

import basicrt
from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    add_plane,
    empty_material,
    export,
    new_material,
    new_scene,
    render_both,
    set_world,
)
from support.cycles import both, expect_alike, neutral_scene

in_cycles = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)
COLOR = (0.75, 0.5, 0.25)


@pytest.fixture(autouse=True)
def empty_scene() -> None:
    new_scene()


def new_volume(bl_idname: str, phase: str = "", name: str = "Volume", **values: Any) -> Any:
    """A material of one volume node and no surface."""
    material, tree, output = empty_material(name)
    node = add_node(tree, bl_idname, **values)
    if phase:
        node.phase = phase
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return material


def translated(material: Any, *warnings: str) -> basicrt.VolumeShader:
    """The only node of the material, which is its volume."""
    report = Report()
    made = translate_surface(material, report, Textures(basicrt.Scene()))
    assert report.warnings == tuple(f'material "{material.name}": {text}' for text in warnings)
    assert (made.surface, made.volume) == (None, 0)
    node = made.nodes[0]
    assert isinstance(node, basicrt.VolumeShader)
    return node


def test_absorption_takes_what_the_colour_lacks() -> None:
    node = translated(new_volume("ShaderNodeVolumeAbsorption", Color=COLOR, Density=2.0))
    assert node.absorption == pytest.approx((0.5, 1.0, 1.5))
    assert node.scattering == (0.0, 0.0, 0.0)


def test_scattering_is_colour_times_density() -> None:
    node = translated(
        new_volume("ShaderNodeVolumeScatter", Color=COLOR, Density=2.0, Anisotropy=0.5)
    )
    assert node.scattering == pytest.approx((1.5, 1.0, 0.5))
    assert (node.absorption, node.anisotropy) == ((0.0, 0.0, 0.0), 0.5)


@pytest.mark.skipif(bpy.app.version < (4, 3, 0), reason="from 4.3 on")
@pytest.mark.parametrize(
    ("phase", "values"),
    [
        ("HENYEY_GREENSTEIN", {"Anisotropy": 0.25}),
        ("FOURNIER_FORAND", {"IOR": 1.25, "Backscatter": 0.125}),
        ("DRAINE", {"Anisotropy": 0.25, "Alpha": 2.0}),
        ("RAYLEIGH", {}),
        ("MIE", {"Diameter": 4.0}),
    ],
)
def test_phases_keep_their_numbers(phase: str, values: dict[str, float]) -> None:
    node = translated(new_volume("ShaderNodeVolumeScatter", phase, **values))
    assert node.phase == phase.lower()
    for identifier, value in values.items():
        assert getattr(node, identifier.lower()) == value


@pytest.mark.skipif(bpy.app.version < (5, 0, 0), reason="from 5.0 on")
def test_coefficients_are_kept() -> None:
    node = translated(
        new_volume(
            "ShaderNodeVolumeCoefficients",
            Absorption_Coefficients=(1, 2, 3),
            Scatter_Coefficients=(4, 5, 6),
            Emission_Coefficients=(7, 8, 9),
        )
    )
    assert (node.absorption, node.scattering, node.emission) == ((1, 2, 3), (4, 5, 6), (7, 8, 9))


def test_principled_volume_absorbs_what_it_does_not_scatter() -> None:
    node = translated(
        new_volume(
            "ShaderNodeVolumePrincipled",
            Color=COLOR,
            Density=2.0,
            Absorption_Color=(0.25, 0.25, 1.0),
            Emission_Strength=3.0,
            Emission_Color=(1.0, 0.5, 0.0),
        )
    )
    assert node.scattering == pytest.approx((1.5, 1.0, 0.5))
    assert node.absorption == pytest.approx((0.25, 0.5, 0.0))
    assert node.emission == pytest.approx((3.0, 1.5, 0.0))


def test_black_bodies_redden_as_they_cool() -> None:
    # CIE 15: illuminant A, a black body of 2856 K, has the chromaticity 0.4476, 0.4074; white is 6504 K, nearly.
    red, green, blue = blackbody_color(2856)
    x = 0.4124 * red + 0.3576 * green + 0.1805 * blue
    z = 0.0193 * red + 0.1192 * green + 0.9505 * blue
    assert (x / (x + 1 + z), 1 / (x + 1 + z)) == pytest.approx((0.4476, 0.4074), abs=5e-3)
    assert blackbody_color(6504) == pytest.approx((1, 1, 1), abs=0.06)
    assert blackbody_color(800)[2] == 0.0


def test_what_varies_in_a_volume_is_reported() -> None:
    material = new_volume("ShaderNodeVolumeScatter", Color=COLOR)
    tree = material.node_tree
    node = next(n for n in tree.nodes if n.type == "VOLUME_SCATTER")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs["Density"])
    translated(
        material,
        'node "Volume Scatter": Density is linked to "Noise Texture", which is not supported: its own value is used',
    )


def test_a_surface_in_a_volume_is_left_a_boundary() -> None:
    material, tree, output = empty_material()
    tree.links.new(tree.nodes.new("ShaderNodeEeveeSpecular").outputs[0], output.inputs["Volume"])
    node = translated(material, 'node "Specular BSDF" is not supported in a volume and left out')
    assert (node.absorption, node.scattering) == ((0, 0, 0), (0, 0, 0))


def test_the_world_has_its_volume_and_bounces_are_counted() -> None:
    scene = new_scene()
    set_world_volume("ShaderNodeVolumeScatter", Color=COLOR, Density=0.5)
    add_camera()
    scene.basicrt.volume_bounces = 3
    exported = export()
    assert exported.settings.volume_bounces == 3
    material = exported.materials[exported.world_volume]
    assert material.nodes[material.volume].scattering == pytest.approx((0.375, 0.25, 0.125))


def set_world_volume(bl_idname: str, **values: Any) -> None:
    """The world of the scene is filled."""
    world = bpy.context.scene.world or set_world((0, 0, 0))
    tree = world.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(add_node(tree, bl_idname, **values).outputs[0], output.inputs["Volume"])


def add_box(lower: Any, upper: Any, material: Any) -> Any:
    """A closed box."""
    corners = [
        (x, y, z)
        for z in (lower[2], upper[2])
        for y in (lower[1], upper[1])
        for x in (lower[0], upper[0])
    ]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return add_mesh(corners, faces, material, "Box")


@in_cycles
def test_nested_absorption_is_cycles(tmp_path: Path) -> None:
    """Boxes in and across each other, one around the camera, over a floor that shines."""
    new_scene(16, 16)
    add_plane(20, -2, new_material("ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0))
    outer = new_volume("ShaderNodeVolumeAbsorption", Color=COLOR, Density=0.5)
    inner = new_volume("ShaderNodeVolumeAbsorption", Color=(0.2, 0.9, 0.9), Density=1.0)
    add_box((-1, -1, -1), (1, 1, 1), outer)
    add_box((-0.6, -0.6, -0.5), (0.6, 0.6, 0.5), inner)
    add_box((0.3, 0.3, 0.2), (1.5, 1.5, 1.5), inner)
    add_box((-2, -0.3, 2), (2, 0.4, 6), inner)
    add_camera((0.1, 0.05, 5), kind="PERSP")
    ours, theirs = render_both(tmp_path)
    assert np.abs(ours - theirs).max() < 2e-3


def fog_lamp() -> None:
    set_world_volume("ShaderNodeVolumeScatter", Color=COLOR, Density=0.2, Anisotropy=0.4)
    add_lamp("POINT", (0.4, 0.2, 1), energy=50, shadow_soft_size=0.0)


def lit_box(bl_idname: str, phase: str = "", **values: Any) -> Callable[[], None]:
    def build() -> None:
        add_box((-1, -1, -1), (1, 1, 1), new_volume(bl_idname, phase, **values))
        add_lamp("SUN", rotation=(math.radians(60), 0, math.radians(30)), energy=3, angle=0.1)
        add_lamp("AREA", (1.5, 0, 2.5), (0, math.radians(30), 0), energy=60, size=1)

    return build


def volume_in_glass() -> None:
    material, tree, output = empty_material()
    glass = add_node(tree, "ShaderNodeBsdfGlass", Color=(1, 1, 1), Roughness=0.0, IOR=1.2)
    tree.links.new(glass.outputs[0], output.inputs["Surface"])
    fog = add_node(tree, "ShaderNodeVolumeScatter", Color=COLOR, Density=0.5)
    tree.links.new(fog.outputs[0], output.inputs["Volume"])
    add_box((-0.8, -0.8, -0.8), (0.8, 0.8, 0.8), material)
    set_world((0.5, 0.6, 0.7))


def mixed_volumes() -> None:
    material, tree, output = empty_material()
    mix, add = (
        add_node(tree, "ShaderNodeMixShader", Fac=0.25),
        tree.nodes.new("ShaderNodeAddShader"),
    )
    fog = add_node(tree, "ShaderNodeVolumeScatter", Color=COLOR, Density=1.0, Anisotropy=0.6)
    back = add_node(
        tree, "ShaderNodeVolumeScatter", Color=(0.3, 0.3, 0.9), Density=1.0, Anisotropy=-0.5
    )
    glow = add_node(tree, "ShaderNodeEmission", Color=(0.1, 0.2, 0.1), Strength=0.3)
    tree.links.new(fog.outputs[0], mix.inputs[1])
    tree.links.new(back.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], add.inputs[0])
    tree.links.new(glow.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], output.inputs["Volume"])
    add_box((-1, -1, -1), (1, 1, 1), material)
    add_lamp("SUN", rotation=(math.radians(60), 0, math.radians(30)), energy=3)
    set_world((0.2, 0.2, 0.3))


def inside_fog() -> None:
    add_box(
        (-3, -3, -2), (3, 3, 6), new_volume("ShaderNodeVolumeScatter", Color=COLOR, Density=0.2)
    )
    add_plane(4, -1, new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    add_lamp("SPOT", (0, 0, 3), energy=300, spot_size=0.8, shadow_soft_size=0.1)


SCENES: dict[str, tuple[Callable[[], None], int]] = {
    "a lamp in fog": (fog_lamp, 0),
    "inside fog": (inside_fog, 2),
    "scattered once": (lit_box("ShaderNodeVolumeScatter", Color=COLOR, Density=1.0), 0),
    "scattered four times": (
        lit_box("ShaderNodeVolumeScatter", Color=COLOR, Density=2.0, Anisotropy=0.3),
        3,
    ),
    "rayleigh": (lit_box("ShaderNodeVolumeScatter", "RAYLEIGH", Density=1.0), 0),
    "draine": (
        lit_box("ShaderNodeVolumeScatter", "DRAINE", Density=1.0, Anisotropy=0.4, Alpha=3.0),
        0,
    ),
    "fournier forand": (
        lit_box("ShaderNodeVolumeScatter", "FOURNIER_FORAND", IOR=1.3, Backscatter=0.2),
        0,
    ),
    "mie": (lit_box("ShaderNodeVolumeScatter", "MIE", Diameter=8.0), 0),
    "mie of small droplets": (lit_box("ShaderNodeVolumeScatter", "MIE", Diameter=2.0), 0),
    "principled": (
        lit_box(
            "ShaderNodeVolumePrincipled",
            Color=COLOR,
            Density=1.0,
            Absorption_Color=(0.3, 0.6, 0.1),
            Emission_Strength=0.05,
            Emission_Color=(0.2, 0.4, 1.0),
        ),
        1,
    ),
    "hot": (
        lit_box(
            "ShaderNodeVolumePrincipled", Density=0.5, Blackbody_Intensity=1.0, Temperature=1200.0
        ),
        0,
    ),
    "coefficients": (
        lit_box(
            "ShaderNodeVolumeCoefficients",
            Absorption_Coefficients=(0.1, 0.2, 0.3),
            Scatter_Coefficients=(1.0, 0.5, 0.2),
            Emission_Coefficients=(0.1, 0.0, 0.05),
        ),
        0,
    ),
    "volume in glass": (volume_in_glass, 4),
    "mixed and added": (mixed_volumes, 4),
}


@in_cycles
@pytest.mark.parametrize("name", SCENES)
def test_volumes_are_cycles(name: str, tmp_path: Path) -> None:
    build, bounces = SCENES[name]
    scene = neutral_scene(8, samples=256)
    scene.cycles.volume_bounces = bounces
    build()
    add_camera((0.2, 0.1, 5), kind="PERSP")
    expect_alike(*both(scene, tmp_path), relative=0.02)
