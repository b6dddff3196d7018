// SPDX-License-Identifier: GPL-3.0-or-later
// The reference builder: halves the primitives along the longest axis of their bounds.
#include <algorithm>
#include <limits>
#include <numeric>

#include "base/assert.h"
#include "bvh/bvh.h"

namespace basicrt {
namespace {

// What primitives are sorted by. An empty box sorts as if at the origin.
Vec3f centroid(const Bounds3f& box) { return box.is_empty() ? Vec3f(0) : box.center(); }

std::size_t largest_axis(Vec3f extent) {
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

class MedianBuilder {
 public:
  MedianBuilder(std::span<const Bounds3f> bounds, const BvhConfig& config) : bounds_(bounds), config_(config) {
    bvh_.nodes.reserve(bounds.size());
    bvh_.primitives.resize(bounds.size());
    std::iota(bvh_.primitives.begin(), bvh_.primitives.end(), 0u);
  }

  Bvh build() {
    build_node(0, static_cast<std::uint32_t>(bvh_.primitives.size()), 0);
    return std::move(bvh_);
  }

 private:
  // Over primitives[begin, end).
  void build_node(std::uint32_t begin, std::uint32_t end, int depth) {
    const std::size_t index = bvh_.nodes.size();
    BvhNode node;
    for (std::uint32_t i = begin; i < end; ++i) node.bounds.extend(bounds_[bvh_.primitives[i]]);
    const bool is_leaf = end - begin <= 2 || depth >= config_.max_depth;
    if (is_leaf) {
      node.right_or_first = begin;
      node.count = end - begin;
    }
    bvh_.nodes.push_back(node);
    report_work(end - begin, is_leaf);
    if (is_leaf) return;

    const std::uint32_t middle = begin + (end - begin) / 2;
    split_at(begin, middle, end, largest_axis(node.bounds.extent()));
    build_node(begin, middle, depth + 1);
    bvh_.nodes[index].right_or_first = static_cast<std::uint32_t>(bvh_.nodes.size());
    build_node(middle, end, depth + 1);
  }

  void report_work(std::uint32_t count, bool is_leaf) {
    if (config_.progress == nullptr) return;
    if (is_leaf) config_.progress->advance(std::uint64_t{count} * small_part_work);
    if (count >= large_part) config_.progress->advance(count);
  }

  void split_at(std::uint32_t begin, std::uint32_t middle, std::uint32_t end, std::size_t axis) {
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
      const float at_a = centroid(bounds_[a])[axis], at_b = centroid(bounds_[b])[axis];
      return at_a != at_b ? at_a < at_b : a < b;  // a total order, so that the halves are the same everywhere
    };
    const auto first = bvh_.primitives.begin();
    std::nth_element(first + begin, first + middle, first + end, is_before);
  }

  std::span<const Bounds3f> bounds_;
  const BvhConfig& config_;
  Bvh bvh_;
};

}  // namespace

Bvh build_median_bvh(std::span<const Bounds3f> bounds, const BvhConfig& config) {
  // So that the number of nodes fits 32 bits too.
  BASICRT_ASSERT(bounds.size() <= std::numeric_limits<std::uint32_t>::max() / 2);
  if (bounds.empty()) return {};
  return MedianBuilder(bounds, config).build();
}

}  // namespace basicrt
