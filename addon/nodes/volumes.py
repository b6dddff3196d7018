# SPDX-License-Identifier: GPL-3.0-or-later
"""The volume nodes: each becomes the coefficients of a volume that is the same everywhere."""

from __future__ import annotations

from typing import Any

import basicrt

from .blackbody import blackbody_color
from .node_view import Color, NodeIndex, NodeView, scaled, shader

# W / (m^2 K^4), Stefan and Boltzmann's; Blender's nodes emit a millionth of that.
_STEFAN_BOLTZMANN = 5.670374e-8
_BLACKBODY_SCALE = 1e-6 / 3.14159265

# node.phase -> the core's name, and the inputs that count: identifier, keyword, limits.
_PHASES: dict[str, tuple[str, tuple[tuple[str, str, float, float], ...]]] = {
    "HENYEY_GREENSTEIN": ("henyey_greenstein", (("Anisotropy", "anisotropy", -1.0, 1.0),)),
    "FOURNIER_FORAND": (
        "fournier_forand",
        (("IOR", "ior", 1.001, 2.0), ("Backscatter", "backscatter", 0.0, 0.5)),
    ),
    "DRAINE": (
        "draine",
        (("Anisotropy", "anisotropy", -1.0, 1.0), ("Alpha", "alpha", 0.0, 1e6)),
    ),
    "RAYLEIGH": ("rayleigh", ()),
    "MIE": ("mie", (("Diameter", "diameter", 0.0, 50.0),)),
}


def _scatterer(view: NodeView, **coefficients: Any) -> NodeIndex:
    """A volume that turns light as the node says; before Blender 4.3 there was but one way."""
    node: Any = view.node
    phase, inputs = _PHASES[getattr(node, "phase", "HENYEY_GREENSTEIN")]
    numbers: dict[str, Any] = {
        keyword: view.number(identifier, lowest, highest)
        for identifier, keyword, lowest, highest in inputs
    }
    return view.add(basicrt.VolumeShader(phase=phase, **coefficients, **numbers))


@shader("ShaderNodeVolumeAbsorption")
def absorption(view: NodeView) -> NodeIndex:
    """What the colour lacks is taken away."""
    return view.add(
        basicrt.VolumeShader(absorption=scaled(_rest(view.light("Color")), view.number("Density")))
    )


@shader("ShaderNodeVolumeScatter")
def scatter(view: NodeView) -> NodeIndex:
    """Nothing is absorbed: the colour says how much is scattered."""
    return _scatterer(view, scattering=scaled(view.light("Color"), view.number("Density")))


@shader("ShaderNodeVolumeCoefficients")
def coefficients(view: NodeView) -> NodeIndex:
    """As the core has them."""
    return _scatterer(
        view,
        absorption=view.light("Absorption Coefficients"),
        scattering=view.light("Scatter Coefficients"),
        emission=view.light("Emission Coefficients"),
    )


@shader("ShaderNodeVolumePrincipled")
def principled_volume(view: NodeView) -> NodeIndex:
    """Scattering, what is left of it absorbed in part, and emission, some of it by heat.

    Its attributes (density, colour, temperature) are those of grids, which meshes don't have.
    """
    density = view.number("Density")
    color = view.light("Color")
    absorbed = _rest(_root(view.light("Absorption Color")))
    rest = _rest(color)
    emission = scaled(view.light("Emission Color"), view.number("Emission Strength"))
    heat = _heat(view)
    return view.add(
        basicrt.VolumeShader(
            scattering=scaled(color, density),
            absorption=scaled(_times(rest, absorbed), density),
            emission=(emission[0] + heat[0], emission[1] + heat[1], emission[2] + heat[2]),
            anisotropy=view.number("Anisotropy", -1, 1),
        )
    )


def _heat(view: NodeView) -> Color:
    """The radiance per metre of what glows, tinted."""
    intensity = view.number("Blackbody Intensity")
    if intensity == 0.0:
        return 0.0, 0.0, 0.0
    temperature = view.number("Temperature")
    # By the intensity from a single kelvin's light to that of a black body.
    fourth_power = 1.0 + min(intensity, 1.0) * (temperature**4 - 1.0)
    strength = _STEFAN_BOLTZMANN * _BLACKBODY_SCALE * fourth_power
    return scaled(_times(view.light("Blackbody Tint"), blackbody_color(temperature)), strength)


def _rest(color: Color) -> Color:
    """One less each channel, at least 0."""
    return max(1.0 - color[0], 0.0), max(1.0 - color[1], 0.0), max(1.0 - color[2], 0.0)


def _root(color: Color) -> Color:
    return color[0] ** 0.5, color[1] ** 0.5, color[2] ** 0.5


def _times(a: Color, b: Color) -> Color:
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]
