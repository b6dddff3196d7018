// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbouring floats, without the call that std::nextafter is.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "math/constants.h"

namespace basicrt {

// The next float up; infinity and NaN stay what they are.
inline float next_float_up(float x) {
  if (!(x < infinity)) return x;
  if (x == 0) return std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return std::bit_cast<float>(x > 0 ? bits + 1 : bits - 1);
}

inline float next_float_down(float x) { return -next_float_up(-x); }

}  // namespace basicrt
