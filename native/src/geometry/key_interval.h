// SPDX-License-Identifier: GPL-3.0-or-later
// Where a time lies among keys: states of something that moves, equally spaced from time 0, when the shutter opens, to
// time 1, when it closes. Between two keys all is linear.
#pragma once

#include <cstdint>

namespace basicrt {

struct KeyInterval {
  std::uint32_t first;  // key; the other is the next
  float fraction;       // of the way from the first to the other, in [0, 1]
};

// `intervals` is one less than the number of keys. Times outside [0, 1] and NaNs count as the nearest end. Internal
// linkage, for kernels are compiled for other instruction sets.
static inline KeyInterval key_interval(std::uint32_t intervals, float time) {
  const float clamped = time > 0 ? (time < 1 ? time : 1.0f) : 0.0f;
  const float scaled = clamped * static_cast<float>(intervals);
  const auto floor = static_cast<std::uint32_t>(scaled);
  const std::uint32_t first = floor < intervals ? floor : intervals - 1;
  return {first, scaled - static_cast<float>(first)};
}

}  // namespace basicrt
