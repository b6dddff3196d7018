// SPDX-License-Identifier: GPL-3.0-or-later
// Between the entries of tables of 16-bit numbers.
#pragma once

#include <algorithm>
#include <cstdint>

#include "math/vec.h"

namespace basicrt {

// A place on an axis of `nodes` nodes, for a coordinate in [0, 1].
struct AxisPlace {
  int index;
  float fraction;
};

[[nodiscard]] inline AxisPlace find_place(float coordinate, int nodes) {
  const float place = std::clamp(coordinate, 0.0f, 1.0f) * static_cast<float>(nodes - 1);
  const int index = std::min(static_cast<int>(place), nodes - 2);
  return {index, place - static_cast<float>(index)};
}

// `unit` is the entry that stands for one.
[[nodiscard]] inline float look_up(const std::uint16_t* table, float unit, AxisPlace x) {
  return lerp(float(table[x.index]), float(table[x.index + 1]), x.fraction) / unit;
}

// Of rows of `row_size` entries.
[[nodiscard]] inline float look_up(const std::uint16_t* table, float unit, int row_size, AxisPlace row, AxisPlace x) {
  const std::uint16_t* begin = table + row.index * row_size;
  return lerp(look_up(begin, unit, x), look_up(begin + row_size, unit, x), row.fraction);
}

}  // namespace basicrt
