// SPDX-License-Identifier: GPL-3.0-or-later
// Sheen of a thin layer of fibres: the Sheen BSDF's Microfiber type, and the Principled BSDF's sheen.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "bsdf/lobe.h"
#include "math/warp.h"

namespace basicrt {

// Zeltner, Burley and Chiang 2022, "Practical multiple-scattering sheen using linearly transformed cosines": a cosine
// lobe that a matrix of two numbers leans over, towards or away from the viewer. It reflects all light: the layer's share
// is its weight.
struct Sheen {
  static constexpr ScatterKind reflection_kind = ScatterKind::diffuse;

  float a, b;  // of the matrix from directions to the cosine lobe's: rows (a, 0, b), (0, a, 0), (0, 0, 1)
  float cos_azimuth, sin_azimuth;  // of the viewer

  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f /*wo*/, Vec3f wi) const {
    if (!(wi.z > 0)) return {};
    const float x = cos_azimuth * wi.x + sin_azimuth * wi.y, y = cos_azimuth * wi.y - sin_azimuth * wi.x;
    const float density = density_of({a * x + b * wi.z, a * y, wi.z});
    return {Color(density), density};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f /*wo*/, float /*choice*/, Vec2f u) const {
    const Vec3f cosine = sample_cosine_hemisphere(u);
    // The matrix's inverse, times a.
    const Vec3f leant = normalize(Vec3f{cosine.x - b * cosine.z, cosine.y, a * cosine.z});
    if (!(leant.z > 0)) return std::nullopt;
    const Vec3f wi{cos_azimuth * leant.x - sin_azimuth * leant.y, sin_azimuth * leant.x + cos_azimuth * leant.y,
                   leant.z};
    const float density = density_of({a * leant.x + b * leant.z, a * leant.y, leant.z});
    return LobeSample{wi, Color(1.0f), density, false, ScatterKind::diffuse};
  }

 private:
  // Of a direction of unit length before the matrix, whose determinant is a^2.
  [[nodiscard]] float density_of(Vec3f transformed) const {
    const float stretch = a / length_squared(transformed);
    return inv_pi * transformed.z * stretch * stretch;
  }
};

struct SheenLayer {
  Sheen lobe;
  float albedo;  // of the layer; what is left gets to what is below
};
// For a viewer in local direction wo. Nothing where there is none to see: smooth, or seen from below.
[[nodiscard]] std::optional<SheenLayer> make_sheen(float roughness, Vec3f wo);

}  // namespace basicrt
