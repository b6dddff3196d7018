// SPDX-License-Identifier: GPL-3.0-or-later
// Points for operations that send several rays from one place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "math/constants.h"
#include "math/hash.h"
#include "math/vec.h"

namespace basicrt {

// Evenly spread points of the unit square, shifted together by chance: Roberts 2018, "The Unreasonable Effectiveness of
// Quasirandom Sequences".
class SpreadPoints {
 public:
  explicit SpreadPoints(std::uint64_t random_bits)
      : shift_{to_unit_float(static_cast<std::uint32_t>(random_bits >> 32)),
               to_unit_float(static_cast<std::uint32_t>(random_bits))} {}

  [[nodiscard]] Vec2f operator[](int i) const {
    const auto wrapped = [](float x) { return std::min(x - std::floor(x), one_minus_epsilon); };
    const auto n = static_cast<float>(i);
    return {wrapped(shift_.x + n * 0.75487767f), wrapped(shift_.y + n * 0.56984029f)};
  }

 private:
  Vec2f shift_;
};

}  // namespace basicrt
