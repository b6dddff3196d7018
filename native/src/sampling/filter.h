// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel filters, importance sampled: a sample's place is drawn from the filter, so that its weight is one.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "math/vec.h"

namespace basicrt {

enum class FilterKind : std::uint8_t { box, tent, gaussian, blackman_harris, mitchell };
template <>
inline constexpr std::array enum_names<FilterKind> =
    std::to_array<std::string_view>({"box", "tent", "gaussian", "blackman_harris", "mitchell"});

struct FilterSettings {
  FilterKind kind = FilterKind::box;
  float radius = 0.5f;

  static constexpr auto fields() {
    return std::tuple{field("type", &FilterSettings::kind, "the filter's shape"),
                      field("radius", &FilterSettings::radius, "half of its width, in pixels", above(0))};
  }
};

struct FilterSample {
  Vec2f offset;      // from the pixel's centre, in pixels
  float weight = 1;  // 1, or -1 where the filter is negative (mitchell)
};

// A filter ready to sample: separable, so one table for both axes.
class PixelFilter {
 public:
  explicit PixelFilter(const FilterSettings& settings);

  // `u` in [0, 1)^2.
  [[nodiscard]] FilterSample sample(Vec2f u) const;
  // The filter at a distance from the centre along one axis, not normalised.
  [[nodiscard]] float eval(float distance) const;

 private:
  FilterSettings settings_;
  std::vector<float> cdf_;     // of |filter| over [-radius, radius]; empty for box
  std::vector<float> values_;  // of the filter where the table's cells begin and end
};

}  // namespace basicrt
