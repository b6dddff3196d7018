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
  Vec2f offset;  // from the pixel's centre, in pixels
  // One; for a filter with negative lobes (mitchell) plus or minus the integral of |filter| over that of the filter.
  // Its mean is one, so a pixel is the sum of weight * radiance over the sum of weights, or over the number of
  // samples: the first has less noise and is right in the limit, the second has no bias at any number of samples.
  float weight = 1;
};

// A filter ready to sample: separable, so one table for both axes.
class PixelFilter {
 public:
  explicit PixelFilter(const FilterSettings& settings);

  // `u` in [0, 1)^2.
  [[nodiscard]] FilterSample sample(Vec2f u) const;
  // The filter at a distance from the centre along one axis, not normalised; zero past the radius.
  [[nodiscard]] float eval(float distance) const;

 private:
  struct AxisSample {
    float offset, weight;
  };
  [[nodiscard]] AxisSample sample_axis(float u) const;

  FilterSettings settings_;
  // The axis [-radius, radius] in cells of like width; empty for box.
  std::vector<float> cdf_;            // of |filter|, where the cells begin and end
  std::vector<float> weights_;        // of a sample in each cell
  std::vector<std::uint16_t> guide_;  // guide_[i] is the cell where the cdf reaches i / guide_.size()
};

}  // namespace basicrt
