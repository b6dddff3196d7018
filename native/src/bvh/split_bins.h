// SPDX-License-Identifier: GPL-3.0-or-later
// Where to split primitives in two: bins along each axis, and the surface area heuristic between them (Wald 2007, "On
// Fast Construction of SAH-based Bounding Volume Hierarchies").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "bvh/references.h"

namespace basicrt {

// Which bin a box is in, by its centre. Centres are doubled throughout: a sum takes one operation less than a mean.
class Binning {
 public:
  Binning() = default;
  // Of centres in this range, or a little outside. Where the extent or its inverse is no float, all are in bin 0.
  Binning(Float4 lower, Float4 upper, int bins)
      : lower_(lower), last_(Float4::all(static_cast<float>(bins - 1))), bins_(bins) {
    const Float4 largest = Float4::all(std::numeric_limits<float>::max());
    const Float4 scale = Float4::all(static_cast<float>(bins)) / (upper - lower);
    scale_ = select(scale <= largest, scale, Float4::all(0));
  }
  // In bins from the lower end of the range. May be outside, or no number.
  [[nodiscard]] Float4 positions(Float4 doubled_center) const { return (doubled_center - lower_) * scale_; }
  // For each axis. What is no number is in bin 0.
  [[nodiscard]] std::array<std::uint32_t, 3> bins_of(Float4 doubled_center) const {
    return min(max(positions(doubled_center), Float4::all(0)), last_).truncated().first_three();
  }
  [[nodiscard]] int bins() const { return bins_; }
  // Where a bin begins.
  [[nodiscard]] Float4 plane(int bin) const { return lower_ + Float4::all(static_cast<float>(bin)) / scale_; }

 private:
  Float4 lower_, scale_, last_;
  int bins_;
};

struct Split {
  Binning binning;
  Float4 threshold;  // positions from here on are right; no numbers for the other two axes
  int axis = 0, bin = 0;
  std::uint32_t left_count = 0;  // 0: no split was found
  Box left, right;

  [[nodiscard]] bool is_found() const { return left_count > 0; }
  [[nodiscard]] bool is_right(Float4 doubled_center) const {
    return (threshold <= binning.positions(doubled_center)).bits() != 0;
  }
};

class SplitBins {
 public:
  static constexpr int most_bins = 32;

  void clear(int bins);
  void add(const Box& box, const std::array<std::uint32_t, 3>& bins) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes_[axis][bins[axis]].extend(box);
      ++counts_[bins[axis]].of_axis[axis];
    }
  }
  void merge(const SplitBins& other, int bins);

  // The split that costs least: the sum of the two sides' surfaces, times the blocks of 2^block_bits primitives that
  // each fills. `scale` brings extents to about 1, so that surfaces are numbers.
  template <int block_bits>
  [[nodiscard]] Split best_split(const Binning& binning, float scale) const;

 private:
  struct alignas(32) Counts {
    std::int32_t of_axis[4];
  };

  [[nodiscard]] Split split_at(const Binning& binning, int axis, int bin) const;

  Box boxes_[3][most_bins];
  Counts counts_[most_bins];
};

}  // namespace basicrt
