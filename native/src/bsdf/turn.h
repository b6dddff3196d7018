// SPDX-License-Identifier: GPL-3.0-or-later
// How far a stretched lobe is turned about the normal.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/constants.h"
#include "math/vec.h"

namespace basicrt {

// From the frame's tangent to the lobe's x axis. Such lobes look the same from both sides, so half a turn is enough; it
// is divided into 65536 steps, for a lobe has room for no more.
class Turn {
 public:
  Turn() = default;
  // With the x axis `angle` beyond `tangent`, in the frame, as far as the normal allows; both within some turns.
  Turn(Vec3f tangent, float angle) {
    constexpr float steps = 65536;
    const float step = std::round((std::atan2(tangent.y, tangent.x) + angle) * (inv_pi * steps));
    steps_ = static_cast<std::uint16_t>(static_cast<std::int32_t>(step) & 0xffff);
  }

  [[nodiscard]] bool is_none() const { return steps_ == 0; }

  // From the frame to the lobe's own axes, and back.
  [[nodiscard]] Vec3f to_own(Vec3f w) const {
    const float c = std::cos(angle()), s = std::sin(angle());
    return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
  }
  [[nodiscard]] Vec3f from_own(Vec3f w) const {
    const float c = std::cos(angle()), s = std::sin(angle());
    return {c * w.x - s * w.y, c * w.y + s * w.x, w.z};
  }

 private:
  [[nodiscard]] float angle() const { return static_cast<float>(steps_) * (pi / 65536); }

  std::uint16_t steps_ = 0;
};

}  // namespace basicrt
