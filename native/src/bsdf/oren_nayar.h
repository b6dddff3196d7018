// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse reflection by a rough surface that keeps all the light that bounces on it, as Cycles has it from 4.3 on.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "math/warp.h"

namespace basicrt {

// Oren and Nayar 1994, "Generalization of Lambert's reflectance model", as improved by Fujii ("A tiny improvement of
// Oren-Nayar reflectance model"), with the light that bounces more than once added as in OpenPBR 1.1 (Kulla and Conty
// 2017's reciprocal form). The colour is that of the facets: it must not multiply the lobe as well as being given here,
// but for one time: the lobe is for white light, relative to the colour.
class OrenNayar {
 public:
  static constexpr ScatterKind reflection_kind = ScatterKind::diffuse;

  // `roughness` in [0, 1], `cos_o` of the viewing direction that the lobe is made for.
  OrenNayar(Color color, float roughness, float cos_o)
      : a_(1 / (pi + roughness * (pi / 2 - 2.0f / 3))), b_(roughness * a_) {
    const float average = a_ * pi + b_ * (2 * pi - 5.6f) / 3;
    const Color lost = Color(1.0f) - color * (1 - average);
    bounced_ = color * color * (inv_pi * average / (1 - average) * (1 - albedo(std::max(cos_o, 0.0f)))) / lost;
  }

  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (!(wi.z > 0)) return {};
    const float cos_o = std::max(wo.z, 0.0f);
    // Of the cosine between both directions, what their cosines with the normal leave.
    float s = dot(wo, wi) - wi.z * cos_o;
    if (s > 0) s /= std::max(wi.z, cos_o);
    return {(Color(a_ + b_ * s) + bounced_ * (1 - albedo(wi.z))) * wi.z, pdf_cosine_hemisphere(wi.z)};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    const Vec3f wi = sample_cosine_hemisphere(u);
    const LobeValue value = eval(wo, wi);
    return LobeSample{wi, value.value / value.pdf, value.pdf, false, ScatterKind::diffuse};
  }

  [[nodiscard]] float roughness() const { return b_ / a_; }

 private:
  // The share of light that one bounce on white facets returns.
  [[nodiscard]] float albedo(float cos_theta) const {
    const float cosine = std::min(cos_theta, 1.0f), sine = std::sqrt(1 - cosine * cosine);
    // The last term's limit, for it would be infinity times nothing.
    const float g = cosine < 1e-6f ? pi / 2 - 2.0f / 3 - cosine
                                   : sine * (std::acos(cosine) - 2.0f / 3 - sine * cosine) +
                                         2.0f / 3 * (sine / cosine) * (1 - sine * sine * sine);
    return a_ * pi + b_ * g;
  }

  float a_, b_;
  Color bounced_{0.0f};  // what comes back after more than one bounce, but for the factor of wi
};

}  // namespace basicrt
