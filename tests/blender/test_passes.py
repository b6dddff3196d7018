# SPDX-License-Identifier: GPL-3.0-or-later
"""Every pass against Cycles' of the same name, and what else Blender's users expect of passes."""

import json
import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import OpenEXR
import pytest
from addon import compat

from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_plane,
    empty_material,
    new_material,
    new_scene,
    passes_of_both,
    render_passes,
    set_world,
)

SAMPLES = 256
SWITCHES = [
    "z",
    "mist",
    "position",
    "normal",
    "uv",
    "object_index",
    "material_index",
    "diffuse_direct",
    "diffuse_indirect",
    "diffuse_color",
    "glossy_direct",
    "glossy_indirect",
    "glossy_color",
    "transmission_direct",
    "transmission_indirect",
    "transmission_color",
    "emit",
    "environment",
    "ambient_occlusion",
    "cryptomatte_object",
    "cryptomatte_material",
    "cryptomatte_asset",
]
CYCLES_SWITCHES = [
    "use_pass_volume_direct",
    "use_pass_volume_indirect",
    "pass_debug_sample_count",
    "denoising_store_passes",
]

only_in_one_version = pytest.mark.skipif(
    bpy.app.version[:2] != (5, 0), reason="compared with the Cycles of Blender 5.0"
)


def add_ball(name: str, x: float, material: Any, index: int) -> Any:
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=48, ring_count=24, radius=0.7, location=(x, 0, 0.7)
    )
    made = bpy.context.object
    made.name, made.pass_index = name, index
    made.data.shade_smooth()
    made.data.materials.append(material)
    material.pass_index = 10 + index
    return made


def scene_of_all_kinds(samples: int = SAMPLES) -> Any:
    """A ball of each kind of scattering, a volume and a pane, on a floor under a wide lamp and a sky."""
    scene = new_scene(64, 32, samples)
    floor = new_material("ShaderNodeBsdfDiffuse", "Floor", Color=(0.6, 0.5, 0.4))
    add_plane(12, 0, floor, "Floor")
    paint = new_material("ShaderNodeBsdfPrincipled", "Paint", Base_Color=(0.2, 0.5, 0.9))
    metal = new_material("ShaderNodeBsdfGlossy", "Metal", Color=(0.9, 0.7, 0.3), Roughness=0.5)
    glass = new_material(
        "ShaderNodeBsdfGlass", "Glass", Color=(0.8, 1, 0.9), Roughness=0.5, IOR=1.45
    )
    glow = new_material("ShaderNodeEmission", "Glow", Color=(1, 0.6, 0.3), Strength=2.0)
    balls = [
        add_ball(name, 1.6 * i - 3.2, material, i + 1)
        for i, (name, material) in enumerate(
            (("Paint", paint), ("Metal", metal), ("Glass", glass), ("Glow", glow))
        )
    ]
    balls[1].parent = balls[0]
    balls[1].matrix_parent_inverse = balls[0].matrix_world.inverted()
    smoke, tree, output = empty_material("Smoke")
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    scatter.inputs["Density"].default_value = 1.0
    tree.links.new(scatter.outputs[0], output.inputs["Volume"])
    add_ball("Smoke", 3.2, smoke, 5)
    corners = [(-4.2, -1, 0), (-3.2, -1, 0), (-3.2, -1, 1), (-4.2, -1, 1)]
    pane = new_material("ShaderNodeBsdfTransparent", "Pane", Color=(0.9, 0.6, 0.8))
    add_mesh(corners, [(0, 1, 2, 3)], pane, "Pane")
    add_lamp("AREA", (1, -2, 5), (0.3, 0, 0), energy=150, size=4)
    world = set_world((0.3, 0.4, 0.5))
    world.mist_settings.start, world.mist_settings.depth = 4, 8
    world.mist_settings.falloff = "LINEAR"
    add_camera((0, -9, 3.2), (1.3, 0, 0), kind="PERSP", lens=38)
    scene.basicrt.volume_bounces = 2
    view_layer = bpy.context.view_layer
    for name in SWITCHES:
        setattr(view_layer, f"use_pass_{name}", True)
    for name in CYCLES_SWITCHES:
        setattr(view_layer.cycles, name, True)
    return scene


def split_ids(planes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ids as whole numbers, and coverages, each (height, width, 2)."""
    return np.ascontiguousarray(planes[..., 0::2]).view(np.uint32), planes[..., 1::2]


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], dict[str, Any]]:
    """Our passes and Cycles', without the view layer's name."""
    folder = tmp_path_factory.mktemp("passes")
    scene = scene_of_all_kinds()
    return passes_of_both(scene, folder)


@pytest.fixture
def inside(both: Any) -> np.ndarray:
    """Pixels that are all of one thing."""
    masks = []
    for passes in both:
        ids, coverages = split_ids(passes["CryptoObject00"])
        masks.append((coverages[..., 0] > 0.9999) & (ids[..., 0] != 0))
    return np.asarray(masks[0] & masks[1])


def test_the_passes_are_cycles(both: Any) -> None:
    assert set(both[0]) == set(both[1])
    for name, ours in both[0].items():
        assert ours.shape == both[1][name].shape, name


@only_in_one_version
@pytest.mark.parametrize(
    ("name", "tolerance"),
    [
        ("Depth", 0.3),
        ("Position", 0.3),
        ("Normal", 1e-2),
        ("UV", 1e-2),
        ("Mist", 2e-3),
        ("Object Index", 0),
        ("Material Index", 0),
    ],
)
def test_geometry_is_cycles_pixel_by_pixel(
    both: Any, inside: np.ndarray, name: str, tolerance: float
) -> None:
    """Places are of one sample each: not the same one of the pixel."""
    difference = np.abs(both[0][name][inside] - both[1][name][inside])
    assert np.percentile(difference, 95) <= tolerance
    assert np.median(difference) <= tolerance / 4


@only_in_one_version
@pytest.mark.parametrize(
    ("name", "share"),
    [
        ("Combined", 0.01),
        ("Diffuse Direct", 0.02),
        ("Diffuse Indirect", 0.05),
        ("Diffuse Color", 0.01),
        ("Glossy Direct", 0.07),
        ("Glossy Indirect", 0.15),
        ("Glossy Color", 0.03),
        ("Transmission Direct", 0.04),
        ("Transmission Indirect", 0.04),
        ("Transmission Color", 0.01),
        ("Emission", 0.01),
        ("Ambient Occlusion", 0.02),
        ("Denoising Normal", 0.02),
    ],
)
def test_light_is_filed_as_in_cycles(
    both: Any, inside: np.ndarray, name: str, share: float
) -> None:
    """The mean over each object's pixels that are all of it: at edges light is divided by next to no colour.

    As far apart as noise (the shares are three of its standard deviations or more) and guesses of albedo allow.
    """
    index = both[1]["Object Index"][..., 0]
    for number in range(5):
        pixels = inside & (index == number)
        assert pixels.sum() > 30
        ours, theirs = (picture[name][pixels][:, :3].astype(float).mean(axis=0) for picture in both)
        tolerance = share * np.abs(theirs).max() + 1e-3
        np.testing.assert_allclose(ours, theirs, atol=tolerance, err_msg=f"object {number}")


@only_in_one_version
@pytest.mark.parametrize(
    ("name", "share"), [("Volume Direct", 0.03), ("Volume Indirect", 0.1), ("Environment", 0.01)]
)
def test_light_of_no_surface_is_filed_as_in_cycles(both: Any, name: str, share: float) -> None:
    ours, theirs = (picture[name].astype(float).mean(axis=(0, 1)) for picture in both)
    np.testing.assert_allclose(ours, theirs, rtol=share)


def add_square(x: float, node: str, **values: Any) -> None:
    """One of a row, as wide as eight pixels."""
    corners = [(x, -2, 0), (x + 1, -2, 0), (x + 1, 2, 0), (x, 2, 0)]
    add_mesh(corners, [(0, 1, 2, 3)], new_material(node, **values))


@pytest.mark.skipif(bpy.app.version < (5, 2, 0), reason="Cycles has these passes from 5.2 on")
def test_how_specular_surfaces_are_is_as_in_cycles(tmp_path: Path) -> None:
    """Of a row of squares above a rough mirror, which shows through the last, a pane."""
    scene = new_scene(64, 8, 16)
    color = (0.8, 0.6, 0.4)
    add_square(-4, "ShaderNodeBsdfDiffuse", Color=color)
    for i, roughness in enumerate((0.0, 0.2, 0.3, 0.5)):
        add_square(i - 3, "ShaderNodeBsdfAnisotropic", Color=color, Roughness=roughness)
    add_square(1, "ShaderNodeBsdfPrincipled", Base_Color=color, Roughness=0.25, Coat_Weight=0.5)
    add_square(2, "ShaderNodeEmission", Color=color)
    add_square(3, "ShaderNodeBsdfTransparent", Color=color)
    floor = new_material("ShaderNodeBsdfAnisotropic", Color=(0.9, 0.9, 0.9), Roughness=0.1)
    add_plane(20, -1, floor)
    add_camera(ortho_scale=8)
    bpy.context.view_layer.cycles.denoising_store_passes = True
    both = passes_of_both(scene, tmp_path)
    for name, channels in (("Denoising Specular Albedo", 3), ("Denoising Roughness", 1)):
        ours, theirs = (passes[name] for passes in both)
        assert ours.shape == theirs.shape == (8, 64, channels)
        middles = slice(4, None, 8)
        np.testing.assert_allclose(ours[4, middles], theirs[4, middles], atol=0.01, err_msg=name)
        assert np.ptp(theirs[4, middles]) > 0.5


@only_in_one_version
def test_samples_are_counted_as_in_cycles(both: Any) -> None:
    np.testing.assert_array_equal(both[0]["Debug Sample Count"], both[1]["Debug Sample Count"])


@only_in_one_version
@pytest.mark.parametrize("kind", ["Object", "Material", "Asset"])
def test_mattes_are_cycles(both: Any, kind: str) -> None:
    name = f"Crypto{kind}00"
    ids, coverages = split_ids(both[0][name])
    their_ids, their_coverages = split_ids(both[1][name])
    # Cycles ranks those of objects alone.
    order = np.argsort(-their_coverages, axis=2, kind="stable")
    their_ids = np.take_along_axis(their_ids, order, 2)
    their_coverages = np.take_along_axis(their_coverages, order, 2)
    is_clear = their_coverages[..., 0] - their_coverages[..., 1] > 0.2
    np.testing.assert_array_equal(ids[is_clear, 0], their_ids[is_clear, 0])
    assert np.abs(coverages - their_coverages).mean() < 0.005


def test_light_passes_put_together_are_the_picture(both: Any) -> None:
    passes = {
        name: both[0][compat.pass_name(name)].astype(float)
        for name in ("Volume Direct", "Volume Indirect", "Emission", "Environment")
    }
    total = sum(passes.values())
    for kind in ("Diffuse", "Glossy", "Transmission"):
        direct, indirect, color = (
            both[0][compat.pass_name(f"{kind} {part}")] for part in ("Direct", "Indirect", "Color")
        )
        total += (direct.astype(float) + indirect) * color
    combined = both[0]["Combined"][..., :3]
    np.testing.assert_allclose(total, combined, rtol=2e-5, atol=2e-5)


def test_manifests_name_all_that_is_seen(both: Any, tmp_path: Path) -> None:
    scene = scene_of_all_kinds(1)
    render_passes(tmp_path)
    with OpenEXR.File(str(tmp_path / "passes.exr"), separate_channels=True) as file:
        header = dict(file.parts[0].header)
    scene.render.engine = "CYCLES"
    render_passes(tmp_path)
    with OpenEXR.File(str(tmp_path / "passes.exr"), separate_channels=True) as file:
        theirs = dict(file.parts[0].header)
    keys = [key for key in theirs if key.startswith("cryptomatte/")]
    assert len(keys) == 3 * 4
    for key in keys:
        if not key.endswith("manifest"):
            assert header[key] == theirs[key], key
            continue
        names = json.loads(header[key])
        for name, number in json.loads(theirs[key]).items():
            if name in names:  # Cycles writes the hash before its exponent is made a float's
                assert int(names[name], 16) ^ int(number, 16) in (0, 1 << 23), name
    objects = next(k for k in keys if header[k] == "ViewLayer.CryptoObject")
    manifest = json.loads(header[objects.replace("/name", "/manifest")])
    assert set(manifest) == {"Floor", "Paint", "Metal", "Glass", "Glow", "Smoke", "Pane"}


def test_levels_choose_how_many_mattes_there_are(tmp_path: Path) -> None:
    new_scene(4, 4, 1)
    add_camera()
    view_layer = bpy.context.view_layer
    view_layer.use_pass_cryptomatte_material = True
    view_layer.pass_cryptomatte_depth = 4
    assert set(render_passes(tmp_path)) == {
        "ViewLayer.Combined",
        "ViewLayer.CryptoMaterial00",
        "ViewLayer.CryptoMaterial01",
    }


def test_a_pane_leaves_the_rest_to_what_is_behind(tmp_path: Path) -> None:
    new_scene(4, 4, 64)
    view_layer = bpy.context.view_layer
    view_layer.use_pass_cryptomatte_object = view_layer.use_pass_environment = True
    set_world((1, 1, 1))
    pane = new_material("ShaderNodeBsdfTransparent", "Pane", Color=(0.25, 0.25, 0.25))
    add_plane(8, 0, pane, "Pane")
    add_camera(ortho_scale=1)
    passes = render_passes(tmp_path)
    _ids, coverages = split_ids(passes["ViewLayer.CryptoObject00"])
    np.testing.assert_allclose(coverages[..., 0], 0.75, atol=1e-6)
    environment = passes[f"ViewLayer.{compat.pass_name('Environment')}"]
    np.testing.assert_allclose(environment, 0.25, rtol=1e-5)


def test_environment_is_a_pass_of_a_transparent_film(tmp_path: Path) -> None:
    scene = new_scene(4, 4, 1)
    scene.render.film_transparent = True
    bpy.context.view_layer.use_pass_environment = True
    set_world((0.25, 0.5, 1))
    add_camera()
    passes = render_passes(tmp_path)
    assert not passes["ViewLayer.Combined"].any()
    environment = passes[f"ViewLayer.{compat.pass_name('Environment')}"]
    np.testing.assert_array_equal(environment[0, 0], np.float32((0.25, 0.5, 1)))
    assert math.isclose(environment.mean(), 1.75 / 3, rel_tol=1e-6)
