# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps whose light varies by nodes: what their nodes read, and the same pictures as Cycles'."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.nodes import ies
from addon.report import Report

import basicrt
from support.blender import (
    add_camera,
    add_lamp,
    add_node,
    add_plane,
    export,
    new_image,
    new_material,
    new_scene,
)
from support.cycles import both, expect_alike, neutral_scene

only_in_one_version = pytest.mark.skipif(
    bpy.app.version < (5, 0, 0) or bpy.app.version >= (5, 1, 0),
    reason="Cycles is compared with in one version of Blender",
)

# Most light down, less to the sides; of type C, in one quadrant. At the first two angles it is the same: Cycles means
# to close the circle for its splines, but for the rounding of 360 degrees doesn't.
IES = """IESNA:LM-63-2002
[TEST] made up
TILT=NONE
1 1000 25 5 3 1 2 0 0 0
1 1 40
0 22.5 45 67.5 90
0 45 90
100 90 70 30 5
100, 90, 70, 30, 5
100 40 20 10 2
"""


def lamp_tree(b_lamp: Any) -> tuple[Any, Any]:
    """A lamp's nodes: an Emission node of strength 1, which is all there is."""
    if bpy.app.version < (5, 1, 0):
        b_lamp.data.use_nodes = True
    tree = b_lamp.data.node_tree
    tree.nodes.clear()
    emission = add_node(tree, "ShaderNodeEmission", Color=(1, 1, 1), Strength=1.0)
    output = tree.nodes.new("ShaderNodeOutputLight")
    tree.links.new(emission.outputs[0], output.inputs[0])
    return tree, emission


def picture() -> Any:
    """Coarse, of bright colours."""
    pixels = np.random.default_rng(4).uniform(0, 1, (4, 4, 4)) ** 2
    pixels[..., 3] = 1
    return new_image(pixels)


def add_picture(tree: Any, vector: Any, *, extension: str = "REPEAT") -> Any:
    """The picture over coordinates."""
    node = add_node(tree, "ShaderNodeTexImage")
    node.image, node.extension, node.interpolation = picture(), extension, "Closest"
    tree.links.new(vector, node.inputs["Vector"])
    return node.outputs["Color"]


def add_ies(tree: Any, text: str = IES, strength: float = 1.0) -> Any:
    node = add_node(tree, "ShaderNodeTexIES", Strength=strength)
    node.mode = "INTERNAL"
    node.ies = bpy.data.texts.new("Lamp.ies")
    node.ies.write(text)
    return node


# ---- the same pictures as Cycles -----------------------------------------------------------------

Fill = Callable[[Any, Any], None]


def _coordinates(output: str, scale: float = 1.0) -> Fill:
    """The picture by an output of Texture Coordinate."""

    def fill(tree: Any, emission: Any) -> None:
        source = add_node(tree, "ShaderNodeTexCoord").outputs[output]
        mapping = add_node(tree, "ShaderNodeMapping", Scale=(scale,) * 3, Location=(0.1, 0.2, 0.3))
        tree.links.new(source, mapping.inputs["Vector"])
        tree.links.new(add_picture(tree, mapping.outputs[0]), emission.inputs["Color"])

    return fill


def _geometry(output: str) -> Fill:
    """The output itself, moved to be above zero."""

    def fill(tree: Any, emission: Any) -> None:
        source = add_node(tree, "ShaderNodeNewGeometry").outputs[output]
        moved = add_node(tree, "ShaderNodeVectorMath")
        moved.operation = "MULTIPLY_ADD"
        moved.inputs[1].default_value, moved.inputs[2].default_value = (0.3,) * 3, (0.5,) * 3
        tree.links.new(source, moved.inputs[0])
        tree.links.new(moved.outputs[0], emission.inputs["Color"])

    return fill


def _noise(tree: Any, emission: Any) -> None:
    """With its own coordinates, through a ramp."""
    noise = add_node(tree, "ShaderNodeTexNoise", Scale=3.0)
    ramp = add_node(tree, "ShaderNodeValToRGB")
    tree.links.new(noise.outputs[0], ramp.inputs[0])
    ramp.color_ramp.elements[0].position = 0.4
    ramp.color_ramp.elements[1].position = 0.6
    tree.links.new(ramp.outputs["Color"], emission.inputs["Color"])


def _falloff(output: str, smooth: float = 0.0) -> Fill:
    def fill(tree: Any, emission: Any) -> None:
        falloff = add_node(tree, "ShaderNodeLightFalloff", Strength=1.5, Smooth=smooth)
        tree.links.new(falloff.outputs[output], emission.inputs["Strength"])

    return fill


def _luminaire(tree: Any, emission: Any) -> None:
    tree.links.new(add_ies(tree).outputs[0], emission.inputs["Strength"])


def _bounces(tree: Any, emission: Any) -> None:
    """One colour for light that is seen at once, another for what has bounced."""
    path = add_node(tree, "ShaderNodeLightPath")
    is_direct = add_node(tree, "ShaderNodeMath")
    is_direct.operation, is_direct.inputs[1].default_value = "LESS_THAN", 1.5
    tree.links.new(path.outputs["Ray Depth"], is_direct.inputs[0])
    tree.links.new(is_direct.outputs[0], emission.inputs["Color"])


def _mixed(tree: Any, emission: Any) -> None:
    """Two emissions by where they leave, one of them by its temperature."""
    body = add_node(tree, "ShaderNodeBlackbody", Temperature=2500.0)
    tree.links.new(body.outputs[0], emission.inputs["Color"])
    other = add_node(tree, "ShaderNodeEmission", Color=(0.1, 0.4, 1.0), Strength=2.0)
    checker = add_node(tree, "ShaderNodeTexChecker", Scale=2.0)
    tree.links.new(add_node(tree, "ShaderNodeTexCoord").outputs["Normal"], checker.inputs["Vector"])
    mix = add_node(tree, "ShaderNodeMixShader")
    tree.links.new(checker.outputs["Fac"], mix.inputs[0])
    tree.links.new(emission.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_LIGHT")
    tree.links.new(mix.outputs[0], output.inputs[0])


POINT = ("POINT", (0.2, 0.1, 1.3), {"energy": 60, "shadow_soft_size": 0.0})
BALL = ("POINT", (0.2, 0.1, 1.3), {"energy": 60, "shadow_soft_size": 0.4})
SPHERE = ("POINT", (0.2, 0.1, 1.3), {**BALL[2], "use_soft_falloff": False})
SPOT = (
    "SPOT",
    (0.2, 0.1, 1.3),
    {"energy": 120, "shadow_soft_size": 0.0, "spot_size": 1.4, "spot_blend": 0.3},
)
AREA = ("AREA", (0.2, 0.1, 1.0), {"energy": 40, "shape": "RECTANGLE", "size": 1.4, "size_y": 0.8})
DISK = ("AREA", (0.2, 0.1, 1.0), {"energy": 40, "shape": "DISK", "size": 1.2, "spread": 2.0})
SUN = ("SUN", (0.2, 0.1, 1.3), {"energy": 3, "angle": 1.0})
CASES: dict[str, tuple[Any, Fill]] = {
    "gobo of a spot": (SPOT, _coordinates("UV")),
    "gobo of a spot by its normal": (SPOT, _coordinates("Normal")),
    "picture on an area lamp": (AREA, _coordinates("UV")),
    "picture on a disk": (DISK, _coordinates("Object")),
    "picture of a sun": (SUN, _coordinates("UV", 2.0)),
    "sun by its normal": (SUN, _coordinates("Normal", 3.0)),
    "point by uv": (POINT, _coordinates("UV", 2.0)),
    "soft ball by uv": (BALL, _coordinates("UV", 2.0)),
    "sphere by its normal": (SPHERE, _coordinates("Normal")),
    "area by generated coordinates": (AREA, _coordinates("Generated")),
    "reflection": (SPHERE, _coordinates("Reflection")),
    "camera": (AREA, _coordinates("Camera", 2.0)),
    "window": (AREA, _coordinates("Window", 3.0)),
    "position": (AREA, _geometry("Position")),
    "incoming": (POINT, _geometry("Incoming")),
    "parametric": (AREA, _geometry("Parametric")),
    "true normal of a ball": (BALL, _geometry("True Normal")),
    "noise": (AREA, _noise),
    "constant falloff of a spot": (SPOT, _falloff("Constant")),
    "linear falloff of an area": (AREA, _falloff("Linear")),
    "linear falloff of a ball": (BALL, _falloff("Linear", 0.5)),
    "smoothed falloff of a point": (POINT, _falloff("Quadratic", 2.0)),
    "constant falloff of a sun": (SUN, _falloff("Constant", 1.0)),
    "luminaire": (POINT, _luminaire),
    "luminaire of an area": (AREA, _luminaire),
    "depth": (POINT, _bounces),
    "mixed": (SPHERE, _mixed),
}


@only_in_one_version
@pytest.mark.parametrize("name", CASES)
def test_lamp_is_as_in_cycles(name: str, tmp_path: Path) -> None:
    (kind, location, values), fill = CASES[name]
    scene = neutral_scene(samples=48)
    add_camera((0, 0, 4), ortho_scale=3.0)
    add_plane(8, material=new_material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    gloss = new_material("ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.3)
    tilted = add_plane(1.0, 0.2, gloss)
    tilted.location.x, tilted.rotation_euler = -0.8, (0.1, 0.4, 0)
    lamp = add_lamp(kind, location, (0.2, -0.15, 0.5), **values)
    lamp.visible_camera = False
    tree, emission = lamp_tree(lamp)
    fill(tree, emission)
    ours, theirs = both(scene, tmp_path)
    assert theirs[..., :3].mean() > 0.01
    expect_alike(ours, theirs, 0.01)


@only_in_one_version
def test_lamp_in_fog_and_seen_by_the_camera_is_as_in_cycles(tmp_path: Path) -> None:
    scene = neutral_scene(samples=96)
    add_camera((0, -4, 1), (math.pi / 2, 0, 0), "PERSP", lens=50)
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    world.node_tree.nodes.clear()
    fog = add_node(world.node_tree, "ShaderNodeVolumeScatter", Color=(1, 1, 1), Density=0.1)
    output = world.node_tree.nodes.new("ShaderNodeOutputWorld")
    world.node_tree.links.new(fog.outputs[0], output.inputs["Volume"])
    scene.world = world
    spot = add_lamp("SPOT", (0.3, 0, 1.9), (0, 0.3, 0.4), energy=300, spot_size=1.2)
    spot.data.shadow_soft_size = 0.05
    panel = add_lamp("AREA", (-0.8, 0.5, 1), (math.pi / 2, 0, 0), energy=4, size=0.8)
    panel.visible_camera = True
    for lamp in (spot, panel):
        _coordinates("UV", 2.0)(*lamp_tree(lamp))
    ours, theirs = both(scene, tmp_path)
    expect_alike(ours, theirs, 0.015)


# ---- what is exported ----------------------------------------------------------------------------


def test_a_lamp_whose_light_varies_has_a_material() -> None:
    new_scene()
    add_camera()
    lamp = add_lamp("POINT", (1, 2, 3), (0.3, 0, 0), energy=4 * math.pi)
    tree, emission = lamp_tree(lamp)
    checker = add_node(tree, "ShaderNodeTexChecker")
    tree.links.new(checker.outputs[0], emission.inputs["Color"])
    scene = export()
    exported = scene.lights[0]
    assert exported.intensity == pytest.approx((1, 1, 1))
    assert exported.material == len(scene.materials) - 1
    assert scene.materials[exported.material].name == "Point"
    bpy.context.view_layer.update()
    np.testing.assert_allclose(exported.object_transform, np.array(lamp.matrix_world), atol=1e-6)


def test_object_info_of_a_lamp_is_its_objects() -> None:
    new_scene()
    add_camera()
    lamp = add_lamp("SUN", energy=2)
    lamp.color, lamp.pass_index = (0.5, 0.25, 1, 0.5), 3
    tree, emission = lamp_tree(lamp)
    info = add_node(tree, "ShaderNodeObjectInfo")
    tree.links.new(info.outputs["Color"], emission.inputs["Color"])
    tree.links.new(info.outputs["Object Index"], emission.inputs["Strength"])
    exported = export().lights[0]
    assert exported.material is None
    assert exported.irradiance == pytest.approx((3, 1.5, 6))


def test_shaders_that_do_not_shine_are_reported() -> None:
    new_scene()
    add_camera()
    tree, _emission = lamp_tree(add_lamp("SUN", energy=2))
    glass = add_node(tree, "ShaderNodeBsdfGlass")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_LIGHT")
    tree.links.new(glass.outputs[0], output.inputs[0])
    report = Report()
    assert export(report).lights[0].irradiance == (0, 0, 0)
    assert report.warnings == ('light "Sun": node "Glass BSDF" is not supported: black instead',)


# ---- photometric files ---------------------------------------------------------------------------


def test_luminaire_comes_from_a_file_too(tmp_path: Path) -> None:
    path = tmp_path / "lamp.ies"
    path.write_text(IES)
    new_scene()
    add_camera()
    tree, emission = lamp_tree(add_lamp("POINT", energy=4 * math.pi))
    node = add_node(tree, "ShaderNodeTexIES")
    node.mode, node.filepath = "EXTERNAL", str(path)
    tree.links.new(node.outputs[0], emission.inputs["Strength"])
    report = Report()
    scene = export(report)
    assert not report.warnings
    tables = [o for o in scene.materials[0].operations if isinstance(o, basicrt.IesOperation)]
    assert len(tables) == 1
    assert len(tables[0].values) == 9 * 5


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("nothing of the kind", "it has no line TILT="),
        (IES[:-20], "it ends too early"),
        (IES.replace("70", "seventy"), '"seventy" is not a number'),
        (IES.replace("5 3 1 2", "5 3 7 2"), "its photometric type is none of 1, 2 and 3"),
        (IES.replace("5 3 1 2", "-5 3 1 2"), "it can't have -5 vertical angles"),
        (IES.replace("22.5 45", "45 22.5"), "its vertical angles don't ascend"),
        (IES.replace("100 90", "100 inf"), '"inf" is not finite'),
        (IES.replace("100 90", "100 1e300"), "its values are too large"),
    ],
)
def test_malformed_file_is_reported_and_the_lamp_still_shines(text: str, problem: str) -> None:
    new_scene()
    add_camera()
    tree, emission = lamp_tree(add_lamp("SUN", energy=2))
    tree.links.new(add_ies(tree, text, 0.01).outputs[0], emission.inputs["Strength"])
    report = Report()
    scene = export(report)
    (warning,) = report.warnings
    assert warning.startswith(
        f'light "Sun": node "IES Texture": text "Lamp.ies" is not an IES file ({problem}): '
    )
    assert len(scene.lights) == 1


def test_missing_file_is_reported() -> None:
    new_scene()
    add_camera()
    tree, emission = lamp_tree(add_lamp("SUN", energy=2))
    node = add_node(tree, "ShaderNodeTexIES")
    node.mode, node.filepath = "EXTERNAL", "/nowhere/lamp.ies"
    tree.links.new(node.outputs[0], emission.inputs["Strength"])
    report = Report()
    export(report)
    (warning,) = report.warnings
    assert 'file "/nowhere/lamp.ies" can\'t be read (No such file or directory)' in warning


def ies_file(kind: int, vertical: list[float], horizontal: list[float], values: Any) -> str:
    """The text of a file whose values are in the watts of lamps."""
    rows = np.asarray(values) * 177.83 / (4 * math.pi)
    numbers = [vertical, horizontal, *rows.tolist()]
    lines = [" ".join(f"{x:.9g}" for x in row) for row in numbers]
    counts = f"1 -1 1 {len(vertical)} {len(horizontal)} {kind} 2 0 0 0 1 1 1"
    return "\n".join(["IESNA:LM-63-1995", "TILT=NONE", counts, *lines])


@pytest.mark.parametrize(
    ("horizontal", "expected"),
    [
        ([0.0], [0, 360]),
        ([0.0, 45, 90], [0, 45, 90, 135, 180, 225, 270, 315, 360]),
        ([0.0, 90, 180], [0, 90, 180, 270, 360]),
        ([90.0, 180, 270], [0, 90, 180, 270, 360]),
        ([0.0, 120, 240], [0, 120, 240, 360]),
        ([0.0, 90, 180, 270, 360], [0, 90, 180, 270, 360]),
    ],
)
def test_type_c_covers_the_circle(horizontal: list[float], expected: list[float]) -> None:
    values = np.arange(2.0 * len(horizontal)).reshape(-1, 2)
    found = ies.parse(ies_file(1, [0, 90], horizontal, values))
    np.testing.assert_allclose(np.degrees(found.horizontal), expected)
    np.testing.assert_allclose(np.degrees(found.vertical), [0, 90])
    np.testing.assert_allclose(found.values[: len(values)], values, rtol=1e-6)
    if horizontal[-1] != 360:
        np.testing.assert_allclose(found.values[-1], found.values[0])  # the circle closes


def test_types_a_and_b_are_turned() -> None:
    values = np.arange(6.0).reshape(3, 2) + 1
    a = ies.parse(ies_file(3, [-90, 90], [0, 45, 90], values))
    np.testing.assert_allclose(np.degrees(a.horizontal), [90, 135, 180, 225, 270])
    np.testing.assert_allclose(np.degrees(a.vertical), [0, 180])
    np.testing.assert_allclose(a.values[:, 0], [5, 3, 1, 3, 5], rtol=1e-6)
    b = ies.parse(ies_file(2, [-90, 90], [0, 45, 90], values))
    np.testing.assert_allclose(np.degrees(b.horizontal), [0, 180])
    np.testing.assert_allclose(np.degrees(b.vertical), [0, 45, 90, 135, 180])
    np.testing.assert_allclose(b.values[0], [5, 3, 1, 3, 5], rtol=1e-6)


def test_tilt_is_passed_over() -> None:
    text = ies_file(1, [0, 90], [0], [[1, 2]])
    tilted = text.replace("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 0.5")
    np.testing.assert_array_equal(ies.parse(tilted).values, ies.parse(text).values)


@only_in_one_version
@pytest.mark.parametrize("kind", [1, 2, 3])
def test_luminaires_of_each_type_in_a_material_are_as_in_cycles(kind: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(kind)
    vertical = [0, 20, 50, 90] if kind == 1 else [-90, -30, 20, 90]
    horizontal = [0, 45, 90, 180] if kind == 1 else [-90, -20, 40, 90]
    values = rng.uniform(0.2, 1, (4, 4))
    values[1] = values[0]  # see IES
    text = ies_file(kind, vertical, horizontal, values)
    scene = neutral_scene(samples=64)
    add_camera((0, 0, 4), ortho_scale=2.0)
    material = bpy.data.materials.new("Shown")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(emission.outputs[0], output.inputs[0])
    node = add_ies(tree, text, 2.0)
    direction = add_node(tree, "ShaderNodeVectorMath")
    direction.inputs[1].default_value = (0, 0, -0.4)
    tree.links.new(add_node(tree, "ShaderNodeNewGeometry").outputs["Position"], direction.inputs[0])
    tree.links.new(direction.outputs[0], node.inputs["Vector"])
    tree.links.new(node.outputs[0], emission.inputs["Color"])
    add_plane(4, material=material)
    ours, theirs = both(scene, tmp_path)
    assert theirs[..., :3].std() > 0.05
    expect_alike(ours, theirs, 2e-3, cells=8)
