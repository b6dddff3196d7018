# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures, arithmetic and colours agree with Cycles point by point, to 1e-4 of their value.

A picture has a row of squares for each case, a square a pixel. A square has one uv, which holds four
numbers of ten bits: every point of it has the very same coordinates, so that the place in a pixel
doesn't matter. What varies besides is white noise of them. Both engines show the value plus OFFSET,
because nothing shines less than zero; of numbers also the negative value.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from addon.nodes import LampObject, Textures
from addon.nodes.blackbody import blackbody_color
from addon.nodes.translate import emission_of
from addon.report import Report

import basicrt
from support.blender import (
    add_camera,
    add_lamp,
    add_mesh,
    add_node,
    empty_material,
    new_scene,
    render_both,
)

WIDTH = 64
ROWS = 8  # of a case
OFFSET = 16.0
TOLERANCE = 1e-4
# Points of which the Cycles of Blender 5.2 rounds otherwise what distortions and octaves then multiply.
ROUNDED = 40 if bpy.app.version >= (5, 2, 0) else 0
SENSITIVE = ("ShaderNodeTexNoise", "ShaderNodeTexMagic")
BITS = 10  # of a coordinate: from -4 to 4 in steps of 1 / 128


@dataclass(frozen=True)
class Points:
    """The sockets of a square's coordinates."""

    tree: Any
    xyz: Any
    numbers: tuple[Any, Any, Any, Any]

    def math(self, operation: str, *operands: Any, is_vector: bool = False) -> Any:
        """The output of a Math or Vector Math node; operands are sockets or values."""
        node = self.tree.nodes.new(f"ShaderNode{'Vector' if is_vector else ''}Math")
        node.operation = operation
        for socket, operand in zip(node.inputs, operands, strict=False):
            self.feed(socket, operand)
        return node.outputs[0]

    def feed(self, socket: Any, source: Any) -> None:
        """Links a socket, or gives it a value."""
        if isinstance(source, bpy.types.NodeSocket):
            self.tree.links.new(source, socket)
        elif isinstance(source, (int, float)) and hasattr(socket.default_value, "__len__"):
            socket.default_value = [source] * len(socket.default_value)
        elif isinstance(source, tuple) and socket.type == "RGBA":
            socket.default_value = (*source, 1.0)
        else:
            socket.default_value = source

    def white_noise(self, seed: float) -> Any:
        """A node of numbers from 0 to 1."""
        noise = self.tree.nodes.new("ShaderNodeTexWhiteNoise")
        noise.noise_dimensions = "4D"
        self.tree.links.new(self.xyz, noise.inputs["Vector"])
        noise.inputs["W"].default_value = seed
        return noise

    def random(self, seed: float, low: float, high: float, is_vector: bool = False) -> Any:
        """Numbers that differ from square to square."""
        noise = self.white_noise(seed)
        if is_vector:
            span, least = (high - low,) * 3, (low,) * 3
            return self.math("MULTIPLY_ADD", noise.outputs["Color"], span, least, is_vector=True)
        return self.math("MULTIPLY_ADD", noise.outputs["Value"], high - low, low)


@dataclass(frozen=True)
class Case:
    """One node with settings. Its inputs: "x" to "w" or "xyz", a range of random numbers, or a value."""

    bl_idname: str
    output: str
    settings: dict[str, Any] = field(default_factory=dict)
    inputs: dict[str, Any] = field(default_factory=dict)
    prepare: Callable[[Any], None] | None = None
    steps: int = 0  # how many squares may lie on a step, where rounding decides
    tolerance: float = TOLERANCE

    def __str__(self) -> str:
        values = ", ".join(f"{name}={value}" for name, value in self.settings.items())
        return f"{self.bl_idname}({values}).{self.output}"

    def build(self, points: Points) -> Any:
        """The node's output."""
        node = points.tree.nodes.new(self.bl_idname)
        for name, value in self.settings.items():
            setattr(node, name, value)
        if self.prepare is not None:
            self.prepare(node)
        by_name = {socket.identifier: socket for socket in node.inputs}
        for seed, (name, source) in enumerate(self.inputs.items()):
            if name in by_name:
                points.feed(by_name[name], _source(points, by_name[name], source, seed))
        return next(socket for socket in node.outputs if socket.identifier == self.output)


@dataclass(frozen=True)
class Between:
    """Random numbers from a range."""

    low: float
    high: float


@dataclass(frozen=True)
class Scaled:
    """A coordinate times a power of two, which is exact."""

    coordinate: str
    factor: float


def _source(points: Points, socket: Any, source: Any, seed: int) -> Any:
    if isinstance(source, Between):
        return points.random(seed, source.low, source.high, socket.type in ("VECTOR", "RGBA"))
    if isinstance(source, Scaled):
        number = points.numbers["xyzw".index(source.coordinate)]
        return points.math("MULTIPLY", number, source.factor)
    if source == "xyz":
        return points.xyz
    if source == "rgb":
        return points.white_noise(seed).outputs["Color"]
    return points.numbers["xyzw".index(source)] if isinstance(source, str) else source


def _decoded(tree: Any) -> Points:
    """The four numbers in a uv."""
    uv = tree.nodes.new("ShaderNodeUVMap").outputs[0]
    points = Points(tree, uv, (uv, uv, uv, uv))

    def vector_math(operation: str, *operands: Any) -> Any:
        return points.math(operation, *operands, is_vector=True)

    whole = vector_math("FLOOR", vector_math("ADD", uv, (0.5, 0.5, 0.5)))
    high = vector_math("FLOOR", vector_math("MULTIPLY", whole, (2.0**-BITS,) * 3))
    low = vector_math("MULTIPLY_ADD", high, (-(2.0**BITS),) * 3, whole)
    numbers: list[Any] = []
    for vector in (low, high):
        scaled = vector_math("MULTIPLY_ADD", vector, (1 / 128,) * 3, (-4.0,) * 3)
        separate = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(scaled, separate.inputs[0])
        numbers += separate.outputs[:2]
    combine = tree.nodes.new("ShaderNodeCombineXYZ")
    for i in range(3):
        tree.links.new(numbers[i], combine.inputs[i])
    x, y, z, w = numbers
    return Points(tree, combine.outputs[0], (x, y, z, w))


def _material(case: Case) -> Any:
    material, tree, output = empty_material()
    material.cycles.emission_sampling = "NONE"
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    points = _decoded(tree)
    output_socket = case.build(points)
    signs = (1.0, -1.0, 1.0) if output_socket.type == "VALUE" else (1.0, 1.0, 1.0)
    shown = points.math("MULTIPLY_ADD", output_socket, signs, (OFFSET,) * 3, is_vector=True)
    tree.links.new(shown, emission.inputs["Color"])
    return material


def _coordinates() -> np.ndarray:
    """Whole numbers of ten bits (squares, 4): first all of a few special ones, then random ones."""
    special = np.array([0, 384, 448, 512, 576, 640, 1023])  # -4, -1, -0.5, 0, 0.5, 1 and nearly 4
    first = np.array(list(product(special, special)))
    rng = np.random.default_rng(20)
    numbers = rng.integers(0, 2**BITS, (WIDTH * ROWS, 4))
    numbers[: len(first), :2] = first
    numbers[: len(first) // 2, 2:] = 512
    numbers[len(first) : 2 * len(first), 1] = numbers[len(first) : 2 * len(first), 0]
    return numbers


def _add_squares(material: Any, bottom: int) -> None:
    """A case's squares, of one material."""
    column, row = np.meshgrid(np.arange(WIDTH), np.arange(ROWS))
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    x = np.stack([column.ravel() + dx for dx, _dy in corners], axis=1)
    y = np.stack([row.ravel() + dy + bottom for _dx, dy in corners], axis=1)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    faces = np.arange(x.size).reshape(-1, 4)
    made = add_mesh(vertices.tolist(), faces.tolist(), material)
    numbers = _coordinates()
    uv = np.repeat(numbers[:, :2] + 2.0**BITS * numbers[:, 2:], 4, axis=0)
    layer = made.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())


def compare(cases: list[Case], folder: Path) -> None:
    """Renders all cases in both engines; fails with a list of those that differ."""
    height = ROWS * len(cases)
    new_scene(WIDTH, height, samples=1)
    for i, case in enumerate(cases):
        _add_squares(_material(case), i * ROWS)
    camera = add_camera((WIDTH / 2, height / 2, 5))
    camera.data.ortho_scale = max(WIDTH, height)
    ours, theirs = (np.maximum(picture[..., :3], 0) - OFFSET for picture in render_both(folder))
    wrong: list[str] = []
    for i, case in enumerate(cases):
        a, b = (p[i * ROWS : (i + 1) * ROWS].reshape(-1, 3) for p in (ours, theirs))
        error = np.abs(a - b) / np.maximum(1, np.abs(b))
        differs = ~(error.max(axis=1) <= case.tolerance)
        if np.ptp(b) == 0:
            wrong.append(f"{case}: shows nothing that could differ ({b[0]})")
        allowed = case.steps + (ROUNDED if case.bl_idname in SENSITIVE else 0)
        if differs.sum() > allowed:
            worst = np.argmax(error.max(axis=1))
            place = _coordinates()[worst] / 128 - 4
            wrong.append(
                f"{case}: {differs.sum()} of {len(a)}, at {place} {a[worst]} for {b[worst]}"
            )
    assert not wrong, f"{len(wrong)} of {len(cases)}:\n" + "\n".join(wrong)


def _kinds(node: Any, setting: str) -> list[str]:
    return [item.identifier for item in node.bl_rna.properties[setting].enum_items]


TYPES: Any = bpy.types
POINT = {"Vector": "xyz", "W": "w"}


def _infinities(kind: str, count: int) -> int:
    """Before 5.0 negative powers of zero are infinite, which Cycles then shows as black."""
    return count if kind == "POWER" and bpy.app.version < (5, 0, 0) else 0


def _math() -> list[Case]:
    inputs = {"Value": "x", "Value_001": "y", "Value_002": "z"}
    kinds = _kinds(TYPES.ShaderNodeMath, "operation")
    cases = [
        Case("ShaderNodeMath", "Value", {"operation": kind}, inputs, steps=_infinities(kind, 3))
        for kind in kinds
    ]
    clamped = {"operation": "MULTIPLY", "use_clamp": True}
    cases.append(Case("ShaderNodeMath", "Value", clamped, inputs))
    large = {"Value": Scaled("x", 64.0), "Value_001": Scaled("y", 16.0), "Value_002": "z"}
    overflowing = {"EXPONENT", "SINH", "COSH", "POWER"}
    return cases + [
        Case("ShaderNodeMath", "Value", {"operation": kind}, large)
        for kind in kinds
        if kind not in overflowing
    ]


def _vector_math() -> list[Case]:
    some = Between(-2, 2)
    inputs = {"Vector": "xyz", "Vector_001": some, "Vector_002": some, "Scale": "w"}
    numbers = {"DOT_PRODUCT", "DISTANCE", "LENGTH"}
    return [
        Case(
            "ShaderNodeVectorMath",
            "Value" if kind in numbers else "Vector",
            {"operation": kind},
            inputs,
            steps=_infinities(kind, 16),
        )
        for kind in _kinds(TYPES.ShaderNodeVectorMath, "operation")
    ]


def _voronoi() -> list[Case]:
    shape = {"Scale": 1.7, "Randomness": Between(0.3, 1), "Smoothness": Between(0, 1)}
    octaves = {"Detail": Between(0, 3), "Roughness": Between(0, 1), "Lacunarity": Between(1.5, 2.5)}
    inputs = POINT | shape | octaves | {"Exponent": Between(0.3, 3)}
    cases: list[Case] = []
    for dimensions, feature in product(
        ("1D", "2D", "3D", "4D"), _kinds(TYPES.ShaderNodeTexVoronoi, "feature")
    ):
        base = {"voronoi_dimensions": dimensions, "feature": feature}
        if feature in ("DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"):
            output = "Radius" if feature == "N_SPHERE_RADIUS" else "Distance"
            cases.append(Case("ShaderNodeTexVoronoi", output, base, inputs))
            if output == "Distance":
                cases.append(
                    Case("ShaderNodeTexVoronoi", output, base | {"normalize": True}, inputs)
                )
            continue
        metrics = _kinds(TYPES.ShaderNodeTexVoronoi, "distance")
        for metric in metrics[:1] if dimensions == "1D" else metrics:
            settings = base | {"distance": metric}
            normalized = settings | {"normalize": True}
            outputs = ["Distance", "Color"]
            outputs += ["W"] if dimensions in ("1D", "4D") else []
            outputs += ["Position"] if dimensions != "1D" else []
            cases += [Case("ShaderNodeTexVoronoi", o, settings, inputs) for o in outputs]
            cases += [Case("ShaderNodeTexVoronoi", o, normalized, inputs) for o in outputs[:2]]
    return cases


def _voronoi_limits() -> list[Case]:
    """Without octaves, and where randomness and smoothness end."""
    cases: list[Case] = []
    for dimensions, feature, randomness, smoothness in product(
        ("1D", "2D", "3D", "4D"), ("F1", "F2", "SMOOTH_F1"), (0.0, 0.5, 1.0), (0.0, 1.0)
    ):
        if feature == "SMOOTH_F1" or smoothness == 0:
            base = {"voronoi_dimensions": dimensions, "feature": feature}
            shape = {"Scale": 1.3, "Randomness": randomness, "Smoothness": smoothness}
            cases.append(Case("ShaderNodeTexVoronoi", "Color", base, POINT | shape))
    return cases


def _beyond_limits() -> list[Case]:
    """Octaves and scales that are out of the ranges of the user interface, and places far away."""
    # A lacunarity that is rounded would be multiplied by the scale.
    octaves = {"Detail": Between(-1, 6), "Roughness": Between(-0.5, 1.5), "Lacunarity": 2.5}
    inputs = POINT | octaves | {"Randomness": Between(-0.5, 1.5)}
    cases: list[Case] = []
    for dimensions, scale in product(("1D", "2D", "3D", "4D"), (40.0, -1e4, 1e6)):
        scaled = inputs | {"Scale": scale}
        noise, cells = {"noise_dimensions": dimensions}, {"voronoi_dimensions": dimensions}
        edges = cells | {"feature": "DISTANCE_TO_EDGE"}
        cases += [
            Case("ShaderNodeTexNoise", "Color", noise, scaled),
            Case("ShaderNodeTexVoronoi", "Color", cells, scaled),
            Case("ShaderNodeTexVoronoi", "Distance", edges, scaled),
        ]
    return cases


def _mix() -> list[Case]:
    node, factor, operand = "ShaderNodeMix", Between(-0.5, 1.5), Between(-0.5, 1.5)
    cases: list[Case] = []
    for limits in (True, False):
        number = {"Factor_Float": factor, "A_Float": "x", "B_Float": "y"}
        cases.append(
            Case(node, "Result_Float", {"data_type": "FLOAT", "clamp_factor": limits}, number)
        )
        for mode in ("UNIFORM", "NON_UNIFORM"):
            settings = {"data_type": "VECTOR", "factor_mode": mode, "clamp_factor": limits}
            inputs = {"Factor_Float": factor, "Factor_Vector": factor, "A_Vector": "xyz"}
            inputs |= {"B_Vector": operand}
            cases.append(Case(node, "Result_Vector", settings, inputs))
        for blend in _kinds(TYPES.ShaderNodeMix, "blend_type"):
            settings = {"data_type": "RGBA", "blend_type": blend, "clamp_factor": limits}
            inputs = {"Factor_Float": factor, "A_Color": operand, "B_Color": operand}
            cases.append(Case(node, "Result_Color", settings, inputs))
            inside = {"Factor_Float": factor, "A_Color": "rgb", "B_Color": "rgb"}
            cases.append(Case(node, "Result_Color", settings | {"clamp_result": True}, inside))
    for blend, limits in product(_kinds(TYPES.ShaderNodeMixRGB, "blend_type"), (True, False)):
        settings = {"blend_type": blend, "use_clamp": limits}
        inputs = {"Fac": factor, "Color1": operand, "Color2": operand}
        cases.append(Case("ShaderNodeMixRGB", "Color", settings, inputs))
    return cases


def _ranges() -> list[Case]:
    cases: list[Case] = []
    for kind, limits in product(_kinds(TYPES.ShaderNodeMapRange, "interpolation_type"), (0, 1)):
        base = {"interpolation_type": kind, "clamp": bool(limits)}
        numbers = {"Value": "x", "From Min": "y", "From Max": "z", "To Min": "w"}
        numbers |= {"To Max": Between(-3, 3), "Steps": Between(-1, 6)}
        cases.append(Case("ShaderNodeMapRange", "Result", base, numbers))
        some = Between(-3, 3)
        vectors = {"Vector": "xyz", "From_Min_FLOAT3": some, "From_Max_FLOAT3": Between(3.5, 5)}
        vectors |= {"To_Min_FLOAT3": some, "To_Max_FLOAT3": some, "Steps_FLOAT3": Between(-1, 6)}
        cases.append(
            Case("ShaderNodeMapRange", "Vector", base | {"data_type": "FLOAT_VECTOR"}, vectors)
        )
    for kind in ("MINMAX", "RANGE"):
        inputs = {"Value": "x", "Min": "y", "Max": "z"}
        cases.append(Case("ShaderNodeClamp", "Result", {"clamp_type": kind}, inputs))
    return cases


def _ramp(interpolation: str, mode: str = "RGB", hue: str = "NEAR") -> Callable[[Any], None]:
    def prepare(node: Any) -> None:
        ramp = node.color_ramp
        ramp.color_mode = mode
        if mode == "RGB":
            ramp.interpolation = interpolation
        else:
            ramp.hue_interpolation = hue
        ramp.elements[0].color = (0.1, 0.8, 0.3, 0.2)
        ramp.elements[1].position = 0.9
        ramp.elements.new(0.41).color = (0.9, 0.2, 0.5, 0.5)

    return prepare


def _ramps() -> list[Case]:
    node, inputs = "ShaderNodeValToRGB", {"Fac": Between(-0.2, 1.2)}
    kinds = ["EASE", "CARDINAL", "LINEAR", "B_SPLINE", "CONSTANT"]
    prepared = [_ramp(kind) for kind in kinds]
    modes = product(("HSV", "HSL"), ("NEAR", "FAR", "CW", "CCW"))
    prepared += [_ramp("LINEAR", mode, hue) for mode, hue in modes]
    outputs = product(prepared, ("Color", "Alpha"))
    return [Case(node, output, {}, inputs, prepare) for prepare, output in outputs]


def _bent(extend: str, is_wide: bool = False) -> Callable[[Any], None]:
    def prepare(node: Any) -> None:
        mapping = node.mapping
        mapping.extend = extend
        for i, curve in enumerate(mapping.curves):
            curve.points.new(0.3 + 0.1 * i, 0.7 - 0.2 * i)
            curve.points[-1].location = (1.5, 0.9) if is_wide else (1, 0.9)
            if i == 1:
                curve.points[1].handle_type = "VECTOR"
        mapping.update()

    return prepare


def _curves() -> list[Case]:
    cases: list[Case] = []
    for extend in ("HORIZONTAL", "EXTRAPOLATED"):
        for is_wide in (False, True):
            bent = _bent(extend, is_wide)
            color = {"Fac": Between(0, 1), "Color": Between(-0.5, 2)}
            cases.append(Case("ShaderNodeRGBCurve", "Color", {}, color, bent))
            number = {"Factor": Between(0, 1), "Value": Between(-0.5, 2)}
            cases.append(Case("ShaderNodeFloatCurve", "Value", {}, number, bent))
        vector = {"Fac": Between(0, 1), "Vector": Between(-1.5, 1.5)}
        cases.append(Case("ShaderNodeVectorCurve", "Vector", {}, vector, _bent(extend)))
    return cases


def _colors() -> list[Case]:
    wide = Between(-0.5, 1.5)
    cases = [
        Case(
            "ShaderNodeHueSaturation",
            "Color",
            {},
            {
                "Hue": Between(-0.5, 2),
                "Saturation": wide,
                "Value": wide,
                "Fac": wide,
                "Color": color,
            },
        )
        for color in (wide, "rgb")
    ]
    bright = {"Color": wide, "Bright": wide, "Brightness": wide, "Contrast": wide}
    cases += [
        Case("ShaderNodeBrightContrast", "Color", {}, bright),
        Case("ShaderNodeGamma", "Color", {}, {"Color": wide, "Gamma": Between(-1, 3)}),
        Case("ShaderNodeInvert", "Color", {}, {"Fac": wide, "Color": wide}),
        Case("ShaderNodeRGBToBW", "Val", {}, {"Color": wide}),
        Case("ShaderNodeSeparateXYZ", "Y", {}, {"Vector": "xyz"}),
        Case("ShaderNodeCombineXYZ", "Vector", {}, {"X": "x", "Y": "y", "Z": "z"}),
    ]
    for mode, color in product(("RGB", "HSV", "HSL"), (wide, "rgb")):
        for output in ("Red", "Green", "Blue"):
            cases.append(Case("ShaderNodeSeparateColor", output, {"mode": mode}, {"Color": color}))
        three = {"Red": wide, "Green": wide, "Blue": wide}
        cases.append(Case("ShaderNodeCombineColor", "Color", {"mode": mode}, three))
    if bpy.app.version < (5, 0, 0):
        for model, names in (("RGB", "RGB"), ("HSV", "HSV")):
            socket = "Image" if model == "RGB" else "Color"
            separate, combine = f"ShaderNodeSeparate{model}", f"ShaderNodeCombine{model}"
            cases += [Case(separate, name, {}, {socket: "rgb"}) for name in names]
            three = {name: Between(0, 1) for name in names}
            cases.append(Case(combine, socket, {}, three))
    return cases


def _vectors() -> list[Case]:
    cases: list[Case] = []
    for kind, invert in product(_kinds(TYPES.ShaderNodeVectorRotate, "rotation_type"), (0, 1)):
        settings = {"rotation_type": kind, "invert": bool(invert)}
        inputs = {"Vector": "xyz", "Center": Between(-1, 1), "Axis": Between(-1, 1)}
        inputs |= {"Angle": "w", "Rotation": Between(-3, 3)}
        cases.append(Case("ShaderNodeVectorRotate", "Vector", settings, inputs))
    for kind in _kinds(TYPES.ShaderNodeMapping, "vector_type"):
        inputs = {"Vector": "xyz", "Location": Between(-1, 1), "Rotation": Between(-3, 3)}
        inputs |= {"Scale": Between(-1, 2)}
        cases.append(Case("ShaderNodeMapping", "Vector", {"vector_type": kind}, inputs))
    return cases


def _conversions() -> list[Case]:
    """Colours and vectors where numbers are wanted, and numbers where vectors are."""
    cases: list[Case] = []
    for source in ("rgb", "xyz"):
        cases += [
            Case("ShaderNodeMath", "Value", {"operation": "ADD"}, {"Value": source}),
            Case("ShaderNodeValToRGB", "Color", {}, {"Fac": source}),
            Case("ShaderNodeMapRange", "Result", {"clamp": False}, {"Value": source}),
            Case("ShaderNodeFloatCurve", "Value", {}, {"Value": source}, _bent("HORIZONTAL")),
            Case("ShaderNodeMix", "Result_Float", {}, {"A_Float": source, "B_Float": source}),
            Case("ShaderNodeMix", "Result_Float", {}, {"Factor_Float": source, "B_Float": 2.0}),
            Case("ShaderNodeMixRGB", "Color", {}, {"Fac": source, "Color2": (1.0, 0.2, 0.1)}),
        ]
    color = {"data_type": "RGBA"}
    cases.append(Case("ShaderNodeMix", "Result_Color", color, {"A_Color": "x", "B_Color": "xyz"}))
    cases.append(Case("ShaderNodeVectorMath", "Vector", {}, {"Vector": "x", "Vector_001": "rgb"}))
    return cases


def _noise() -> list[Case]:
    octaves = {"Detail": Between(0, 4), "Roughness": Between(0, 1), "Lacunarity": Between(1.5, 2.5)}
    inputs = POINT | octaves | {"Scale": 1.7, "Distortion": Between(-1, 1)}
    inputs |= {"Offset": Between(-0.5, 1), "Gain": Between(0.5, 2)}
    cases: list[Case] = []
    for kind, dimensions in product(
        _kinds(TYPES.ShaderNodeTexNoise, "noise_type"), ("1D", "2D", "3D", "4D")
    ):
        settings = {"noise_type": kind, "noise_dimensions": dimensions}
        for is_normalized in (True, False):
            of_both = settings | {"normalize": is_normalized}
            cases += [Case("ShaderNodeTexNoise", out, of_both, inputs) for out in ("Fac", "Color")]
        plain = POINT | {"Scale": -3.0, "Detail": 0.0}
        cases.append(Case("ShaderNodeTexNoise", "Fac", settings, plain))
    for dimensions, output in product(("1D", "2D", "3D", "4D"), ("Value", "Color")):
        settings = {"noise_dimensions": dimensions}
        cases.append(Case("ShaderNodeTexWhiteNoise", output, settings, POINT))
    return cases


def _patterns() -> list[Case]:
    node, cases = "ShaderNodeTexWave", list[Case]()
    parameters = {"Scale": 0.7, "Detail": Between(0, 3), "Phase Offset": Between(-3, 3)}
    parameters |= {"Detail Scale": Between(0.5, 2), "Detail Roughness": Between(0, 1)}
    for kind, axis, profile in product(
        ("BANDS", "RINGS"), "XYZD", _kinds(TYPES.ShaderNodeTexWave, "wave_profile")
    ):
        ring = "SPHERICAL" if axis == "D" else axis
        band = "DIAGONAL" if axis == "D" else axis
        settings = {"wave_type": kind, "bands_direction": band, "rings_direction": ring}
        settings |= {"wave_profile": profile}
        for distortion in (0.0, Between(0, 3)):
            inputs = POINT | parameters | {"Distortion": distortion}
            cases.append(Case(node, "Color" if distortion else "Fac", settings, inputs))
    for depth, output in product(range(11), ("Color", "Fac")):
        inputs = POINT | {"Scale": 1.2, "Distortion": Between(-2, 2)}
        cases.append(Case("ShaderNodeTexMagic", output, {"turbulence_depth": depth}, inputs))
    for kind in _kinds(TYPES.ShaderNodeTexGradient, "gradient_type"):
        cases.append(Case("ShaderNodeTexGradient", "Fac", {"gradient_type": kind}, POINT))
    for output in ("Color", "Fac"):
        inputs = POINT | {"Color1": Between(0, 1), "Color2": Between(0, 1)}
        for scale in (1.0, -2.7):
            cases.append(Case("ShaderNodeTexChecker", output, {}, inputs | {"Scale": scale}))
    return cases


def _bricks() -> list[Case]:
    colors = {name: Between(0, 1) for name in ("Color1", "Color2", "Mortar")}
    shape = {"Scale": 1.3, "Mortar Size": Between(0.02, 0.2), "Mortar Smooth": Between(0.1, 1)}
    shape |= {"Bias": Between(-1, 1), "Brick Width": Between(0.3, 1), "Row Height": Between(0.1, 1)}
    inputs = POINT | colors | shape
    cases: list[Case] = []
    for offset, squash in product((0, 1, 2, 3), (0, 1, 3)):
        settings = {"offset_frequency": max(offset, 1), "squash_frequency": max(squash, 1)}
        settings |= {"offset": 0.4 * offset / 3, "squash": 1 + 0.4 * squash}
        cases += [Case("ShaderNodeTexBrick", out, settings, inputs) for out in ("Color", "Fac")]
    sharp = POINT | {"Scale": 2.0, "Mortar Smooth": 0.0}
    return [*cases, Case("ShaderNodeTexBrick", "Color", {}, sharp)]


def _gabor() -> list[Case]:
    if bpy.app.version < (4, 3, 0):
        return []
    inputs = {"Vector": "xyz", "Scale": 1.3, "Frequency": Between(0, 3)}
    inputs |= {"Anisotropy": Between(-0.2, 1.2), "Orientation 2D": Between(-3, 3)}
    inputs |= {"Orientation 3D": Between(-1, 1)}
    return [
        Case("ShaderNodeTexGabor", output, {"gabor_type": kind}, inputs)
        for kind, output in product(("2D", "3D"), ("Value", "Phase", "Intensity"))
    ]


def _spectra() -> list[Case]:
    kelvin = {"Temperature": Between(600, 13000)}
    return [
        Case("ShaderNodeWavelength", "Color", {}, {"Wavelength": Between(360, 800)}),
        # Cycles approximates Planck's law in pieces.
        Case("ShaderNodeBlackbody", "Color", {}, kelvin, tolerance=1.5e-3),
        Case("ShaderNodeNormal", "Dot", {}, {"Normal": "xyz"}, _turned),
    ]


def _turned(node: Any) -> None:
    node.outputs["Normal"].default_value = (0.6, 0.0, 0.8)


def _moved(kind: str) -> Callable[[Any], None]:
    def prepare(node: Any) -> None:
        mapping = node.texture_mapping
        mapping.vector_type = kind
        mapping.translation = (0.1, -0.2, 0.3)
        mapping.rotation = (0.3, 0.7, -0.4)
        mapping.scale = (0.5, 1.3, 2.0)
        mapping.mapping_x, mapping.mapping_y, mapping.mapping_z = "Y", "NONE", "X"

    return prepare


def _texture_mappings() -> list[Case]:
    kinds = ("POINT", "TEXTURE", "VECTOR", "NORMAL")
    return [Case("ShaderNodeTexMagic", "Color", {}, POINT, _moved(kind)) for kind in kinds]


MAKERS = [_math, _vector_math, _mix, _ranges, _ramps, _curves, _colors, _vectors, _conversions]
MAKERS += [
    _voronoi,
    _voronoi_limits,
    _beyond_limits,
    _noise,
    _patterns,
    _bricks,
    _gabor,
    _spectra,
    _texture_mappings,
]


@pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__.strip("_"))
def test_values(make: Callable[[], list[Case]], tmp_path: Path) -> None:
    cases = make()
    if not cases:
        pytest.skip("no such nodes in this version")
    compare(cases, tmp_path)


def test_lamp_takes_the_constant_of_a_node() -> None:
    new_scene()
    lamp = add_lamp("POINT").data
    lamp.use_nodes = True
    tree = lamp.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    body = add_node(tree, "ShaderNodeBlackbody", Temperature=3000.0)
    tree.links.new(body.outputs[0], emission.inputs["Color"])
    emission.inputs["Strength"].default_value = 1.0
    report = Report()
    found = emission_of(lamp, report, Textures(basicrt.Scene()), LampObject("POINT"))
    assert found is not None
    assert found.material is None
    # From 5.0 on by Blender itself, whose approximation is another.
    assert found.radiance == pytest.approx(blackbody_color(3000.0), abs=1e-3)
    assert not report.warnings
