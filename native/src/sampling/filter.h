// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel filters, importance sampled: a sample's place is drawn from |filter|, so that all samples count the same.
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
  float falloff = 2;  // gaussian: exp(-falloff x^2); 2 is the assignment's

  static constexpr auto fields() {
    return fields_of(
        field("type", &FilterSettings::kind, "the filter's shape"),
        field("radius", &FilterSettings::radius, "half of its width, in pixels", above(0)),
        field("falloff", &FilterSettings::falloff, "of gaussian: exp(-falloff * x^2), x in pixels", above(0)));
  }
};

struct FilterSample {
  Vec2f offset;              // from the pixel's centre, in pixels
  bool is_negative = false;  // where the filter is: such a sample is taken off its pixel
};

// A filter ready to sample: separable, so one table for both axes.
class PixelFilter {
 public:
  explicit PixelFilter(const FilterSettings& settings);

  // `u` in [0, 1)^2.
  [[nodiscard]] FilterSample sample(Vec2f u) const;
  // The integral of what is negative of the filter, over that of the filter: above 0 for mitchell alone. A pixel is
  // (1 + negative_mass) times the mean of its positive samples less negative_mass times the mean of its negative ones.
  [[nodiscard]] float negative_mass() const { return negative_mass_; }
  // The filter at a distance from the centre along one axis, not normalised; zero past the radius.
  [[nodiscard]] float eval(float distance) const;

 private:
  struct AxisSample {
    float offset;
    bool is_negative;
  };
  [[nodiscard]] AxisSample sample_axis(float u) const;

  FilterSettings settings_;
  float negative_mass_ = 0;
  // The axis [-radius, radius] in cells of like width; empty for box.
  std::vector<float> cdf_;            // of |filter|, where the cells begin and end
  std::vector<bool> is_negative_;     // the filter in each cell
  std::vector<std::uint16_t> guide_;  // guide_[i] is the cell where the cdf reaches i / guide_.size()
};

}  // namespace basicrt
