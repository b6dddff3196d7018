// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps over the bins, all three axes side by side.
#include "bvh/split_bins.h"

#include <algorithm>

namespace basicrt {
namespace {

// What is on one side of a plane, for each axis.
template <int block_bits>
class Side {
 public:
  void add(const Box& x, const Box& y, const Box& z, const std::int32_t* counts) {
    boxes_[0].extend(x);
    boxes_[1].extend(y);
    boxes_[2].extend(z);
    counts_ = counts_ + Int4::load(counts);
  }
  // Not a number where the side is empty.
  [[nodiscard]] Float4 costs(Float4 scale) const {
    Float4 x = boxes_[0].extent(), y = boxes_[1].extent(), z = boxes_[2].extent();
    transpose(x, y, z);
    x = x * scale, y = y * scale, z = z * scale;
    const Int4 blocks = (counts_ + Int4::all((1 << block_bits) - 1)).template shifted_right<block_bits>();
    return (x * (y + z) + y * z) * Float4::from(blocks);
  }

 private:
  Box boxes_[3];
  Int4 counts_ = Int4::all(0);
};

}  // namespace

void SplitBins::clear(int bins) {
  for (auto& axis : boxes_) std::fill_n(axis, bins, Box());
  std::fill_n(counts_, bins, Counts{});
}

void SplitBins::merge(const SplitBins& other, int bins) {
  for (int axis = 0; axis < 3; ++axis)
    for (int bin = 0; bin < bins; ++bin) {
      boxes_[axis][bin].extend(other.boxes_[axis][bin]);
      counts_[bin].of_axis[axis] += other.counts_[bin].of_axis[axis];
    }
}

template <int block_bits>
Split SplitBins::best_split(const Binning& binning, float scale) const {
  const Float4 scales = Float4::all(scale);
  Float4 right_costs[most_bins];  // of a bin and those above
  Side<block_bits> right, left;
  for (int bin = binning.bins() - 1; bin > 0; --bin) {
    right.add(boxes_[0][bin], boxes_[1][bin], boxes_[2][bin], counts_[bin].of_axis);
    right_costs[bin] = right.costs(scales);
  }
  Float4 best_costs = Float4::all(std::numeric_limits<float>::infinity()), best_bins = Float4::all(0);
  for (int bin = 1; bin < binning.bins(); ++bin) {
    left.add(boxes_[0][bin - 1], boxes_[1][bin - 1], boxes_[2][bin - 1], counts_[bin - 1].of_axis);
    const Float4 costs = left.costs(scales) + right_costs[bin];
    const Mask4 is_better = costs < best_costs;
    best_costs = select(is_better, costs, best_costs);
    best_bins = select(is_better, Float4::all(static_cast<float>(bin)), best_bins);
  }
  alignas(16) float costs[4];
  alignas(16) std::int32_t bins[4];
  best_costs.store(costs);
  best_bins.truncated().store(bins);
  const auto axis = static_cast<int>(std::min_element(costs, costs + 3) - costs);
  return bins[axis] == 0 ? Split{} : split_at(binning, axis, bins[axis]);
}

template Split SplitBins::best_split<0>(const Binning& binning, float scale) const;
template Split SplitBins::best_split<2>(const Binning& binning, float scale) const;
template Split SplitBins::best_split<1>(const Binning& binning, float scale) const;

Split SplitBins::split_at(const Binning& binning, int axis, int bin) const {
  Split split{.binning = binning, .axis = axis, .bin = bin};
  alignas(16) float threshold[4];
  std::fill_n(threshold, 4, std::numeric_limits<float>::quiet_NaN());
  threshold[axis] = static_cast<float>(bin);
  split.threshold = Float4::load(threshold);
  for (int i = 0; i < binning.bins(); ++i) {
    (i < bin ? split.left : split.right).extend(boxes_[axis][i]);
    if (i < bin) split.left_count += static_cast<std::uint32_t>(counts_[i].of_axis[axis]);
  }
  return split;
}

}  // namespace basicrt
