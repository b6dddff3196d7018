// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's Toon BSDF: a spot of even brightness around a direction, with a soft rim.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/lobe.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {

// Around the normal (diffuse) or the mirrored view (glossy). Not reciprocal, and it loses what the rim takes off and, of
// the glossy one, what would go below the surface.
template <ScatterKind spot_kind>
class Toon {
 public:
  static constexpr ScatterKind reflection_kind = spot_kind;

  // Both in [0, 1] of a right angle.
  Toon(float size, float smooth)
      : size_(std::clamp(size, 1e-5f, 1.0f) * (pi / 2)), smooth_(std::clamp(smooth, 0.0f, 1.0f) * (pi / 2)) {
    const float half_sine = std::sin(spot_angle() / 2);
    one_minus_cos_ = 2 * half_sine * half_sine;
  }

  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (!(wi.z > 0) || (is_glossy && !(wo.z > 0))) return {};
    // Of the chord, which keeps its digits where the spot is small.
    const float angle = 2 * std::asin(std::min(length(wi - axis(wo)) / 2, 1.0f));
    if (!(angle < spot_angle())) return {};
    const float pdf = pdf_cone(one_minus_cos_);
    return {Color(pdf * brightness(angle)), pdf};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    if (is_glossy && !(wo.z > 0)) return std::nullopt;
    const Vec3f local = sample_cone(u, one_minus_cos_);
    const Vec3f wi = is_glossy ? make_frame(axis(wo)).to_world(local) : local;
    const LobeValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return LobeSample{wi, value.value / value.pdf, value.pdf, false, spot_kind};
  }

 private:
  static constexpr bool is_glossy = spot_kind == ScatterKind::glossy;

  [[nodiscard]] static Vec3f axis(Vec3f wo) { return is_glossy ? Vec3f{-wo.x, -wo.y, wo.z} : Vec3f{0, 0, 1}; }
  [[nodiscard]] float spot_angle() const { return std::min(size_ + smooth_, pi / 2); }
  [[nodiscard]] float brightness(float angle) const { return angle < size_ ? 1 : 1 - (angle - size_) / smooth_; }

  float size_, smooth_;  // radians
  float one_minus_cos_;  // of the whole spot
};

}  // namespace basicrt
