# SPDX-License-Identifier: GPL-3.0-or-later
"""The texture nodes, over any coordinates."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mathutils import Euler, Matrix

import basicrt

from .. import compat
from .coordinate_nodes import texture_vector
from .operations import Operands, Value, operation


def _dimensions(of: Operands) -> int:
    return int(of.node.noise_dimensions[0])


def _mapped_vector(of: Operands, default: str = "generated") -> Any:
    """Where the texture is looked up: its Vector, moved by the mapping of the node itself."""
    vector = texture_vector(of, default)
    mapping = of.node.texture_mapping
    axes = mapping.mapping_x, mapping.mapping_y, mapping.mapping_z
    if axes != ("X", "Y", "Z"):
        picked: list[Any] = [
            0.0
            if axis == "NONE"
            else of.add("number", basicrt.ComponentOperation(vector, axis.lower())).data
            for axis in axes
        ]
        vector = of.add("vector", basicrt.CombineOperation(*picked)).data
    matrix = _matrix(mapping)
    if matrix == Matrix():
        return vector
    transform = np.array(matrix, np.float32)
    moved = of.add("vector", basicrt.TransformOperation(vector=vector, transform=transform)).data
    if mapping.vector_type != "NORMAL":
        return moved
    return of.add("vector", basicrt.VectorMathOperation("normalize", moved)).data


def _matrix(mapping: Any) -> Matrix:
    """Of a texture node's own mapping."""
    kind = mapping.vector_type
    # Cycles does so only for those that are inverted, but a transform of ours always has an inverse.
    scale = [x if abs(x) >= 1e-5 else math.copysign(1e-5, x) for x in mapping.scale]
    matrix = Euler(mapping.rotation).to_matrix().to_4x4() @ Matrix.Diagonal((*scale, 1.0))
    if kind in ("POINT", "TEXTURE"):
        matrix = Matrix.Translation(mapping.translation) @ matrix
    if kind == "TEXTURE":
        matrix.invert()
    if kind == "NORMAL":
        matrix = matrix.inverted().transposed()
    return matrix


@operation("ShaderNodeTexNoise")
def noise(of: Operands, output: str) -> Value:
    """Smooth noise."""
    is_color = output == "Color"
    made = basicrt.NoiseOperation(
        noise=of.node.noise_type.lower(),
        dimensions=_dimensions(of),
        vector=_mapped_vector(of),
        w=of.number("W"),
        scale=of.number("Scale"),
        detail=of.number("Detail"),
        roughness=of.number("Roughness"),
        lacunarity=of.number("Lacunarity"),
        offset=of.number("Offset"),
        gain=of.number("Gain"),
        distortion=of.number("Distortion"),
        normalize=of.node.normalize,
        color=is_color,
    )
    return of.add("color" if is_color else "number", made)


@operation("ShaderNodeTexWhiteNoise")
def white_noise(of: Operands, output: str) -> Value:
    """A random number for each point; an unlinked vector is its own value."""
    is_color = output == "Color"
    made = basicrt.WhiteNoiseOperation(
        dimensions=_dimensions(of), vector=of.vector("Vector"), w=of.number("W"), color=is_color
    )
    return of.add("color" if is_color else "number", made)


@operation("ShaderNodeTexVoronoi")
def voronoi(of: Operands, output: str) -> Value | None:
    """Cells around random points."""
    kinds = {"Color": "color", "Position": "vector"}
    dimensions = int(of.node.voronoi_dimensions[0])
    outputs = {"Color": "color", "Position": "position", "W": "w"}
    made = basicrt.VoronoiOperation(
        feature=of.node.feature.lower(),
        metric=of.node.distance.lower(),
        output=outputs.get(output, "distance"),
        hash=compat.cell_hash(),
        dimensions=dimensions,
        vector=_mapped_vector(of),
        w=of.number("W"),
        scale=of.number("Scale"),
        detail=of.number("Detail"),
        roughness=of.number("Roughness"),
        lacunarity=of.number("Lacunarity"),
        smoothness=of.number("Smoothness"),
        exponent=of.number("Exponent"),
        randomness=of.number("Randomness"),
        normalize=of.node.normalize,
    )
    return of.add(kinds.get(output, "number"), made)


@operation("ShaderNodeTexGabor")
def gabor(of: Operands, output: str) -> Value:
    """Waves of one frequency."""
    made = basicrt.GaborOperation(
        output=output.lower(),
        dimensions=int(of.node.gabor_type[0]),
        vector=_mapped_vector(of),
        scale=of.number("Scale"),
        frequency=of.number("Frequency"),
        anisotropy=of.number("Anisotropy"),
        angle=of.number("Orientation 2D"),
        direction=of.vector("Orientation 3D"),
    )
    return of.add("number", made)


@operation("ShaderNodeTexChecker")
def checker(of: Operands, output: str) -> Value:
    """Two colours by turns."""
    made = of.add(
        "number",
        basicrt.CheckerOperation(vector=_mapped_vector(of), scale=of.number("Scale")),
    )
    return made if output == "Fac" else _mixed(of, made, "Color2", "Color1")


@operation("ShaderNodeTexGradient")
def gradient(of: Operands, output: str) -> Value:
    """A number that rises."""
    made = basicrt.GradientOperation(
        gradient=of.node.gradient_type.lower(), vector=_mapped_vector(of)
    )
    return of.add("color" if output == "Color" else "number", made)


@operation("ShaderNodeTexWave")
def wave(of: Operands, output: str) -> Value:
    """Bands or rings."""
    is_rings = of.node.wave_type == "RINGS"
    direction = of.node.rings_direction if is_rings else of.node.bands_direction
    made = basicrt.WaveOperation(
        rings=is_rings,
        direction=direction.lower(),
        profile={"SIN": "sine", "SAW": "saw", "TRI": "triangle"}[of.node.wave_profile],
        vector=_mapped_vector(of),
        scale=of.number("Scale"),
        distortion=of.number("Distortion"),
        detail=of.number("Detail"),
        detail_scale=of.number("Detail Scale"),
        detail_roughness=of.number("Detail Roughness"),
        phase=of.number("Phase Offset"),
    )
    return of.add("color" if output == "Color" else "number", made)


@operation("ShaderNodeTexMagic")
def magic(of: Operands, output: str) -> Value:
    """Colours in waves."""
    made = of.add(
        "color",
        basicrt.MagicOperation(
            depth=of.node.turbulence_depth,
            vector=_mapped_vector(of),
            scale=of.number("Scale"),
            distortion=of.number("Distortion"),
        ),
    )
    if output == "Color":
        return made
    average = basicrt.ComponentOperation(value=made.data, component="average")
    return of.add("number", average)


@operation("ShaderNodeTexBrick")
def brick(of: Operands, output: str) -> Value:
    """A wall."""
    wall = basicrt.BrickOperation(
        vector=_mapped_vector(of),
        scale=of.number("Scale"),
        mortar_size=of.number("Mortar Size"),
        mortar_smooth=of.number("Mortar Smooth"),
        bias=of.number("Bias"),
        brick_width=of.number("Brick Width"),
        row_height=of.number("Row Height"),
        offset=of.node.offset,
        squash=of.node.squash,
        offset_frequency=of.node.offset_frequency,
        squash_frequency=of.node.squash_frequency,
    )
    found = of.add("vector", wall)
    mortar = of.add("number", basicrt.ComponentOperation(value=found.data, component="x"))
    if output == "Fac":
        return mortar
    tint = of.add("number", basicrt.ComponentOperation(value=found.data, component="y"))
    bricks = _mixed(of, tint, "Color1", "Color2")
    made = basicrt.MixOperation(
        blend="mix", factor=mortar.data, a=bricks.data, b=of.vector("Mortar")
    )
    return of.add("color", made)


def _mixed(of: Operands, factor: Value, first: str, second: str) -> Value:
    """The second colour where the factor is 1."""
    made = basicrt.MixOperation(
        blend="mix", factor=factor.data, a=of.vector(first), b=of.vector(second)
    )
    return of.add("color", made)
