// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics of a rough surface: how microfacets are turned, which of them can be seen, and how they hide light.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bsdf/turn.h"
#include "math/constants.h"
#include "math/vec.h"

namespace basicrt {

enum class MicrofacetModel : std::uint8_t { ggx, beckmann };

// Directions are local, above the surface (z > 0). Smith's uncorrelated normals with height-correlated masking and
// shadowing, G2 = 1 / (1 + lambda_o + lambda_i): Heitz 2014, "Understanding the masking-shadowing function in
// microfacet-based BRDFs". lambda diverges at grazing angles, so all here is in terms of the projected area
// z (1 + lambda), which does not.
struct Microfacets {
  float alpha_x = 0, alpha_y = 0;
  MicrofacetModel model = MicrofacetModel::ggx;
  Turn turn{};  // for whoever uses them: all here is along their own axes

  // So smooth that it is taken for a mirror: Cycles' limit.
  [[nodiscard]] bool is_smooth() const { return alpha_x * alpha_y <= 2e-10f; }

  // Of microfacets' normals, per solid angle and per area of the macroscopic surface.
  [[nodiscard]] float density(Vec3f normal) const;

  // The area of the microfacets that are seen from w, projected along w, per macroscopic area.
  [[nodiscard]] float projected_area(Vec3f w) const;

  // G2(wo, wi) / |wo.z|.
  [[nodiscard]] float masking_over_cosine(Vec3f wo, Vec3f wi) const {
    const float zo = std::abs(wo.z), zi = std::abs(wi.z);
    return zi / (projected_area(wo) * zi + projected_area(wi) * zo - zo * zi);
  }

  // A normal out of those visible from wo, and its density per solid angle.
  [[nodiscard]] Vec3f sample_visible_normal(Vec3f wo, Vec2f u) const;
  [[nodiscard]] float pdf_visible_normal(Vec3f wo, Vec3f normal) const {
    return density(normal) * std::max(dot(wo, normal), 0.0f) / projected_area(wo);
  }
};

namespace microfacet_detail {

// The slope distribution has the density exp(-x^2) / sqrt(pi). Of the slopes seen at the given angle, the one below
// which lies the share u: bisection and Newton's steps on Heitz and d'Eon 2014, "Importance sampling
// microfacet-based BSDFs using the distribution of visible normals".
inline float sample_beckmann_slope(float cos_theta, float sin_theta, float u) {
  constexpr float inv_sqrt_pi = 0.56418958f;
  constexpr float limit = 5;  // exp(-25) is less than a float's last digit
  const auto area_below = [&](float x) {
    return cos_theta * std::erfc(-x) / 2 + sin_theta * std::exp(-x * x) * inv_sqrt_pi / 2;
  };
  float lower = -limit, upper = cos_theta < limit * sin_theta ? cos_theta / sin_theta : limit;
  const float target = u * area_below(upper);
  float x = (std::max(lower, -1.0f) + std::min(upper, 1.0f)) / 2;
  for (int i = 0; i < 24 && upper - lower > 1e-6f; ++i) {
    const float error = area_below(x) - target;
    (error > 0 ? upper : lower) = x;
    const float slope = (cos_theta - x * sin_theta) * std::exp(-x * x) * inv_sqrt_pi;
    const float next = x - error / slope;
    if (std::abs(next - x) < 1e-6f) break;
    x = next > lower && next < upper ? next : (lower + upper) / 2;
  }
  return x;
}

}  // namespace microfacet_detail

inline float Microfacets::density(Vec3f normal) const {
  if (!(normal.z > 0)) return 0;
  const float x = normal.x / alpha_x, y = normal.y / alpha_y, z2 = normal.z * normal.z;
  if (model == MicrofacetModel::ggx) {
    const float s = x * x + y * y + z2;
    return inv_pi / (alpha_x * alpha_y * s * s);
  }
  const float exponent = (x * x + y * y) / z2;
  if (exponent > 80) return 0;  // below the least float, and z2 * z2 may be as well
  return std::exp(-exponent) * inv_pi / (alpha_x * alpha_y * z2 * z2);
}

inline float Microfacets::projected_area(Vec3f w) const {
  const float x = alpha_x * w.x, y = alpha_y * w.y, z = std::abs(w.z), s2 = x * x + y * y;
  if (model == MicrofacetModel::ggx) return (z + std::sqrt(s2 + z * z)) / 2;
  if (s2 == 0) return z;
  const float s = std::sqrt(s2), a = z / s;
  return z * std::erfc(-a) / 2 + s * std::exp(-a * a) * 0.28209479f;  // 1 / (2 sqrt(pi))
}

inline Vec3f Microfacets::sample_visible_normal(Vec3f wo, Vec2f u) const {
  // Seen in the space where both alphas are one, the surface is that of a sphere or of plain Gaussian slopes.
  const Vec3f stretched = normalize(Vec3f{alpha_x * wo.x, alpha_y * wo.y, wo.z});
  if (model == MicrofacetModel::ggx) {
    // Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps".
    const float phi = 2 * pi * u.x;
    const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
    const float r = std::sqrt(std::max(1 - z * z, 0.0f));
    const Vec3f h = Vec3f{r * std::cos(phi), r * std::sin(phi), z} + stretched;
    return normalize(Vec3f{alpha_x * h.x, alpha_y * h.y, std::max(h.z, 1e-7f)});
  }
  const float sin_theta = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
  const float along = microfacet_detail::sample_beckmann_slope(stretched.z, sin_theta, u.x);
  const float across = microfacet_detail::sample_beckmann_slope(1, 0, u.y);
  const float cos_phi = sin_theta > 0 ? stretched.x / sin_theta : 1;
  const float sin_phi = sin_theta > 0 ? stretched.y / sin_theta : 0;
  return normalize(
      Vec3f{-alpha_x * (cos_phi * along - sin_phi * across), -alpha_y * (sin_phi * along + cos_phi * across), 1});
}

}  // namespace basicrt
