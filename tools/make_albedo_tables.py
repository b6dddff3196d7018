#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes native/src/bsdf/albedo_tables.cpp: how much light GGX microfacets return after a single scattering.

What is missing to one bounces between microfacets. native/src/bsdf/albedo.h makes up for it (Turquin 2019, "Practical
multiple scattering compensation for microfacet models"). Needs numpy; takes a minute or two.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

OUTPUT = Path(__file__).resolve().parent.parent / "native" / "src" / "bsdf" / "albedo_tables.cpp"
# Nodes along the square root of the cosine, the roughness, and the refractive index: see albedo_tables.h.
COSINES, ROUGHNESSES, IORS = 24, 24, 14
GREATEST_IOR_COORDINATE = 0.8  # ior 9
LEVELS = 65535


def visible_normals(wo: Array, alpha: float, points: int) -> Array:
    """(points^2, 3) normals, each seen from `wo` with the same probability: Dupuy and Benyoub 2023."""
    u = (np.arange(points) + 0.5) / points
    azimuth, height = (a.ravel() for a in np.meshgrid(2 * np.pi * u, u))
    stretch = np.array([alpha, alpha, 1.0])
    view = wo * stretch / np.linalg.norm(wo * stretch)
    z = (1 - height) * (1 + view[2]) - view[2]
    r = np.sqrt(np.clip(1 - z * z, 0, None))
    half = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=-1) + view
    normals = half * stretch
    return np.asarray(normals / np.linalg.norm(normals, axis=-1, keepdims=True))


def projected_area(w: Array, alpha: float) -> Array:
    """Of the microfacets seen from `w`, per macroscopic area."""
    cosine = np.abs(w[..., 2])
    return np.asarray(
        (cosine + np.sqrt(alpha**2 * (w[..., 0] ** 2 + w[..., 1] ** 2) + cosine**2)) / 2
    )


def shadowing(wo: Array, wi: Array, alpha: float) -> Array:
    """G2 / G1: the share of light towards `wi` that no other microfacet stops."""
    zo, zi = abs(wo[2]), np.abs(wi[:, 2])
    area_o, area_i = projected_area(wo, alpha), projected_area(wi, alpha)
    return np.asarray(area_o * zi / (area_o * zi + area_i * zo - zo * zi))


def fresnel(cosine: Array, eta: float) -> tuple[Array, Array]:
    """Reflectance of a dielectric, and the cosine of the refracted direction."""
    sine2 = (1 - cosine**2) / eta**2
    is_total = sine2 >= 1
    transmitted = np.sqrt(np.where(is_total, 0, 1 - sine2))
    parallel = (eta * cosine - transmitted) / (eta * cosine + transmitted)
    perpendicular = (cosine - eta * transmitted) / (cosine + eta * transmitted)
    return np.where(is_total, 1.0, (parallel**2 + perpendicular**2) / 2), transmitted


def returned_shares(
    cosine: float, roughness: float, eta: float | None, points: int
) -> tuple[float, float]:
    """What is reflected and what is refracted; without `eta` everything is reflected."""
    cosine = max(cosine, 1e-4)
    alpha = max(roughness, 1e-3) ** 2
    wo = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])
    normals = visible_normals(wo, alpha, points)
    incident = np.clip(normals @ wo, 0, 1)
    wi = 2 * incident[:, None] * normals - wo
    reflected = np.where(wi[:, 2] > 0, shadowing(wo, wi, alpha), 0)
    if eta is None:
        return float(reflected.mean()), 0.0
    reflectance, transmitted = fresnel(incident, eta)
    wt = (incident / eta - transmitted)[:, None] * normals - wo / eta
    refracted = np.where(wt[:, 2] < 0, shadowing(wo, wt, alpha), 0)
    return float((reflected * reflectance).mean()), float((refracted * (1 - reflectance)).mean())


def grid() -> Iterator[tuple[float, float]]:
    """(cosine, roughness) of the nodes, the roughness changing fastest."""
    for i in range(COSINES):
        for j in range(ROUGHNESSES):
            yield (i / (COSINES - 1)) ** 2, j / (ROUGHNESSES - 1)


def iors(power: int) -> list[float]:
    coordinates = [GREATEST_IOR_COORDINATE * (k / (IORS - 1)) ** power for k in range(IORS)]
    return [(1 + x) / (1 - x) for x in coordinates]


def averages(table: list[float]) -> list[float]:
    """Over the cosine-weighted hemisphere, for each roughness of each index: 2 times the integral of E(mu) mu."""
    # Over the nodes t with mu = t^2, by the trapezoidal rule. Weights that add up to one keep an albedo of one.
    weights = np.linspace(0, 1, COSINES) ** 3
    weights[-1] /= 2
    by_cosine = np.array(table).reshape(-1, COSINES, ROUGHNESSES)
    return list(np.einsum("c,icr->ir", weights / weights.sum(), by_cosine).ravel())


def format_table(name: str, size: str, values: list[float]) -> str:
    levels = [str(round(min(max(v, 0.0), 1.0) * LEVELS)) for v in values]
    lines = [", ".join(levels[i : i + 16]) for i in range(0, len(levels), 16)]
    return f"const std::uint16_t {name}[{size}] = {{\n" + ",\n".join(lines) + "};\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=96, help="quadrature points along each axis")
    points: int = parser.parse_args().points

    reflection = [returned_shares(c, r, None, points)[0] for c, r in grid()]
    # From a layer the reflection goes with the index's difference squared; of glass the losses set in at once.
    layer = [returned_shares(c, r, ior, points)[0] for ior in iors(1) for c, r in grid()]
    outside, inside = (
        [
            sum(returned_shares(c, r, 1 / ior if is_inside else ior, points))
            for ior in iors(2)
            for c, r in grid()
        ]
        for is_inside in (False, True)
    )

    parts = [
        "// SPDX-License-Identifier: GPL-3.0-or-later\n"
        "// Generated by tools/make_albedo_tables.py: shares of light in units of 1/65535.\n"
        '#include "bsdf/albedo_tables.h"\n\n'
        "namespace basicrt::albedo_tables {\n\n// clang-format off\n",
        format_table("reflection", "cosines * roughnesses", reflection),
        format_table("reflection_average", "roughnesses", averages(reflection)),
        format_table("layer", "iors * cosines * roughnesses", layer),
        format_table("glass_from_outside", "iors * cosines * roughnesses", outside),
        format_table("glass_from_inside", "iors * cosines * roughnesses", inside),
        format_table("glass_from_outside_average", "iors * roughnesses", averages(outside)),
        format_table("glass_from_inside_average", "iors * roughnesses", averages(inside)),
        "// clang-format on\n\n}  // namespace basicrt::albedo_tables\n",
    ]
    OUTPUT.write_text("".join(parts))


if __name__ == "__main__":
    main()
