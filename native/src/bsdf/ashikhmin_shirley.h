// SPDX-License-Identifier: GPL-3.0-or-later
// The Glossy BSDF's Ashikhmin-Shirley distribution.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "bsdf/microfacets.h"

namespace basicrt {

// Ashikhmin and Shirley 2000, "An anisotropic Phong BRDF model", its specular part without Fresnel. Light is lost at
// grazing angles.
struct AshikhminShirley {
  static constexpr ScatterKind reflection_kind = ScatterKind::glossy;

  float alpha_x, alpha_y;  // in [1e-4, 1]
  Turn turn{};

  [[nodiscard]] bool is_delta() const { return std::max(alpha_x, alpha_y) <= 1e-4f; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (is_delta() || !(wo.z > 0) || !(wi.z > 0)) return {};
    const Vec3f world_normal = normalize(wo + wi);
    const Vec3f normal = turn.is_none() ? world_normal : turn.to_own(world_normal);
    const float cos_incident = std::max(dot(wo, world_normal), 1e-6f);
    // Of the microfacets' normals, over four times the cosine for the reflected directions'.
    const float pdf = density(normal) / (4 * cos_incident);
    return {Color(pdf * wi.z / std::max({wo.z, wi.z, 1e-6f})), pdf};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    if (!(wo.z > 0)) return std::nullopt;
    if (is_delta()) return LobeSample{{-wo.x, -wo.y, wo.z}, Color(1.0f), 1, true, ScatterKind::glossy};
    const Vec3f own = sample_normal(u);
    const Vec3f normal = turn.is_none() ? own : turn.from_own(own);
    const Vec3f wi = normal * (2 * dot(wo, normal)) - wo;
    const LobeValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return LobeSample{wi, value.value / value.pdf, value.pdf, false, ScatterKind::glossy};
  }

 private:
  // The exponents along both axes, as Blender has them.
  [[nodiscard]] static float exponent(float alpha) { return 2 / (alpha * alpha) - 2; }

  // Of microfacets' normals, per solid angle.
  [[nodiscard]] float density(Vec3f normal) const {
    const float nx = exponent(alpha_x), ny = exponent(alpha_y);
    const float sin2 = normal.x * normal.x + normal.y * normal.y;
    const float power = sin2 > 0 ? (nx * normal.x * normal.x + ny * normal.y * normal.y) / sin2 : 0;
    // By the sine, for the cosine of a narrow lobe has lost its digits.
    const float log_cosine = std::log1p(-std::min(sin2, one_minus_epsilon)) / 2;
    return std::sqrt((nx + 1) * (ny + 1)) * (inv_pi / 2) * std::exp(power * log_cosine);
  }

  [[nodiscard]] Vec3f sample_normal(Vec2f u) const {
    const float nx = exponent(alpha_x), ny = exponent(alpha_y);
    // The azimuths of a circle that is stretched: each quadrant onto itself.
    const float circle = 2 * pi * u.x, x = std::cos(circle) * std::sqrt(ny + 1),
                y = std::sin(circle) * std::sqrt(nx + 1);
    const float r = std::sqrt(x * x + y * y), cos_phi = x / r, sin_phi = y / r;
    const float power = nx * cos_phi * cos_phi + ny * sin_phi * sin_phi;
    const float log_z = std::log1p(-u.y) / (power + 1), sine = std::sqrt(-std::expm1(2 * log_z));
    return {sine * cos_phi, sine * sin_phi, std::exp(log_z)};
  }
};

}  // namespace basicrt
