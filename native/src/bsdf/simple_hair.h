// SPDX-License-Identifier: GPL-3.0-or-later
// The Hair BSDF's two lobes: a highlight along the fibre, and light that shines through it.
#pragma once

#include "bsdf/fiber.h"
#include "bsdf/lobe.h"

namespace basicrt {

// Blender's simplified form of Marschner et al. 2003, "Light scattering from human hair fibers": Cauchy distributions of
// the angle along the fibre, and around it a cosine (reflected) or another of Cauchy's (transmitted). All light comes back:
// where a wide highlight reaches around the fibre it shines there too.
template <bool is_transmission>
class SimpleHair {
 public:
  SimpleHair(Vec3f fiber, float along, float around, float offset)
      : fiber_(fiber),
        along_(std::clamp(along, 0.001f, 1.0f)),
        around_(std::clamp(around, 0.001f, 1.0f)),
        offset_(offset) {}

  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    const FiberFrame frame(fiber_.vector(), wo);
    const float angle_out = angle_along(frame, wo), angle_in = angle_along(frame, wi);
    if (pi / 2 - std::abs(angle_in) < least_angle) return {};
    const float around = std::abs(frame.angle_around(wi));
    if (is_transmission && around < pi / 2) return {};
    const float pdf = density_along(angle_in, angle_out) * density_around(around);
    return {Color(pdf), pdf};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f u) const {
    const FiberFrame frame(fiber_.vector(), wo);
    const float angle_out = angle_along(frame, wo);
    const Range range = range_of(angle_out);
    const float half = along_ * std::tan(range.from + u.x * (range.to - range.from)) + offset_;
    const float angle_in = 2 * half - angle_out;
    const float around = is_transmission ? pi + around_ * std::tan(2 * std::atan(pi / 2 / around_) * (u.y - 0.5f))
                                         : 2 * std::asin(std::clamp(1 - 2 * u.y, -1.0f, 1.0f)) * around_;
    const Vec3f wi = normalize(frame.direction(std::sin(angle_in), std::cos(angle_in), around));
    const LobeValue value = eval(wo, wi);
    if (!(value.pdf > 0 && std::isfinite(value.pdf))) return std::nullopt;
    return LobeSample{wi, Color(1.0f), value.pdf, false,
                      is_transmission ? ScatterKind::transmission : ScatterKind::glossy};
  }

 private:
  static constexpr float least_angle = 0.001f;  // to the fibre

  struct Range {
    float from, to;
  };
  // Of the arc tangents that are picked from: so that the angle stays within a right angle to both sides.
  [[nodiscard]] Range range_of(float angle_out) const {
    const auto at = [&](float limit) { return std::atan(((limit + angle_out) / 2 - offset_) / along_); };
    return {at(-pi / 2), at(pi / 2)};
  }
  [[nodiscard]] static float angle_along(const FiberFrame& frame, Vec3f direction) {
    return std::asin(std::clamp(dot(frame.along, direction), -1.0f, 1.0f));
  }
  [[nodiscard]] float density_along(float angle_in, float angle_out) const {
    const float off = (angle_in + angle_out) / 2 - offset_;
    const Range range = range_of(angle_out);
    return along_ / (2 * (off * off + along_ * along_) * (range.to - range.from) * std::cos(angle_in));
  }
  [[nodiscard]] float density_around(float around) const {
    if constexpr (is_transmission) {
      const float off = pi - around;
      return around_ / (2 * std::atan(pi / 2 / around_) * (off * off + around_ * around_));
    }
    return std::max(std::cos(std::min(around / around_, pi) / 2), 0.0f) * 0.25f / around_;
  }

  FiberDirection fiber_;
  float along_, around_, offset_;
};

using HairReflection = SimpleHair<false>;
using HairTransmission = SimpleHair<true>;

}  // namespace basicrt
