// SPDX-License-Identifier: GPL-3.0-or-later
// Splits where the surface area heuristic, evaluated between bins, expects the least work (Wald 2007, "On Fast
// Construction of SAH-based Bounding Volume Hierarchies").
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bvh/builders.h"

namespace basicrt {
namespace {

constexpr int most_bins = 64;
// A deeper node is halved by number, which ends within 32 more levels.
constexpr int deepest_sah_split = 64;
// The work of visiting a node, in tests of a primitive.
constexpr double node_cost = 1.0;

struct Bin {
  Bounds3f bounds;
  std::uint32_t count = 0;

  void add(const Bin& other) {
    bounds.extend(other.bounds);
    count += other.count;
  }
  // The chance that a ray meets the bounds, up to a factor, times the primitives to test then.
  [[nodiscard]] double cost() const {
    return count == 0 ? 0 : Bounds3<double>{Vec3d(bounds.lower), Vec3d(bounds.upper)}.half_area() * count;
  }
};

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0;
  int bin = 0;  // the first that goes right
};

// Which bin a centroid is in, along one axis.
struct Binning {
  double lower, bins_per_length;
  int last;

  Binning(const Bounds3f& centroids, std::size_t axis, int bins)
      : lower(centroids.lower[axis]),
        bins_per_length(bins / (static_cast<double>(centroids.upper[axis]) - lower)),
        last(bins - 1) {}
  [[nodiscard]] int bin(float position) const {
    return std::clamp(static_cast<int>((position - lower) * bins_per_length), 0, last);
  }
};

class BinnedSahBuilder {
 public:
  BinnedSahBuilder(std::span<const Bounds3f> bounds, const BvhConfig& config)
      : bounds_(bounds),
        bins_(std::clamp(config.bins, 2, most_bins)),
        max_leaf_size_(static_cast<std::uint32_t>(std::max(1, config.max_leaf_size))) {
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
    Bounds3f centroids;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Bounds3f& box = bounds_[bvh_.primitives[i]];
      node.bounds.extend(box);
      centroids.extend(centroid(box));
    }
    bvh_.nodes.push_back(node);

    const std::uint32_t middle = choose_middle(begin, end, depth, node.bounds, centroids);
    if (middle == end) {
      bvh_.nodes[index].right_or_first = begin;
      bvh_.nodes[index].count = end - begin;
      return;
    }
    build_node(begin, middle, depth + 1);
    bvh_.nodes[index].right_or_first = static_cast<std::uint32_t>(bvh_.nodes.size());
    build_node(middle, end, depth + 1);
  }

  // Sorts the primitives into two parts and returns where the second starts; `end` where a leaf is better.
  std::uint32_t choose_middle(std::uint32_t begin, std::uint32_t end, int depth, const Bounds3f& bounds,
                              const Bounds3f& centroids) {
    const std::uint32_t count = end - begin;
    if (count == 1) return end;
    Split split;
    if (depth < deepest_sah_split)
      for (std::size_t axis = 0; axis < 3; ++axis) consider_axis(split, begin, end, axis, centroids);

    const double area = Bounds3<double>{Vec3d(bounds.lower), Vec3d(bounds.upper)}.half_area();
    const bool is_split_better = split.cost + node_cost * area < count * area;
    if (count <= max_leaf_size_ && !is_split_better) return end;
    // Coincident centroids: any half is as good as another.
    if (!std::isfinite(split.cost)) return begin + count / 2;

    const Binning binning(centroids, split.axis, bins_);
    const auto first = bvh_.primitives.begin();
    const auto middle = std::partition(first + begin, first + end, [&](std::uint32_t primitive) {
      return binning.bin(centroid(bounds_[primitive])[split.axis]) < split.bin;
    });
    return static_cast<std::uint32_t>(middle - first);
  }

  // Takes the best split between bins along one axis where it is better than `best`.
  void consider_axis(Split& best, std::uint32_t begin, std::uint32_t end, std::size_t axis,
                     const Bounds3f& centroids) const {
    if (!(centroids.lower[axis] < centroids.upper[axis])) return;
    const Binning binning(centroids, axis, bins_);
    std::array<Bin, most_bins> bins;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Bounds3f& box = bounds_[bvh_.primitives[i]];
      bins[binning.bin(centroid(box)[axis])].add({box, 1});
    }
    std::array<double, most_bins> right_costs;
    std::array<std::uint32_t, most_bins> right_counts;
    Bin right;
    for (int i = bins_ - 1; i > 0; --i) {
      right.add(bins[i]);
      right_costs[i] = right.cost();
      right_counts[i] = right.count;
    }
    Bin left;
    for (int i = 1; i < bins_; ++i) {
      left.add(bins[i - 1]);
      const double cost = left.cost() + right_costs[i];
      if (left.count > 0 && right_counts[i] > 0 && cost < best.cost) best = {cost, axis, i};
    }
  }

  std::span<const Bounds3f> bounds_;
  int bins_;
  std::uint32_t max_leaf_size_;
  Bvh bvh_;
};

}  // namespace

Bvh build_binned_sah(std::span<const Bounds3f> bounds, const BvhConfig& config) {
  return BinnedSahBuilder(bounds, config).build();
}

}  // namespace basicrt
