// SPDX-License-Identifier: GPL-3.0-or-later
// Splits where the surface area heuristic, evaluated between bins, expects the least work (Wald 2007, "On Fast
// Construction of SAH-based Bounding Volume Hierarchies").
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "bvh/builders.h"
#include "math/simd.h"

namespace basicrt {
namespace {

constexpr int most_bins = 64;
// A deeper node is halved by number, which ends within 32 more levels.
constexpr int deepest_sah_split = 64;
// The work of visiting a node, in tests of a primitive.
constexpr double node_cost = 1.0;

// Bounds with an axis in each lane, and one to spare.
struct Box {
  Float4 lower = Float4::all(std::numeric_limits<float>::infinity());
  Float4 upper = Float4::all(-std::numeric_limits<float>::infinity());

  Box() = default;
  explicit Box(const Bounds3f& box)
      : lower(Float4::of(box.lower.x, box.lower.y, box.lower.z, 0)),
        upper(Float4::of(box.upper.x, box.upper.y, box.upper.z, 0)) {}

  void extend(Float4 point) {
    lower = min(lower, point);
    upper = max(upper, point);
  }
  void extend(const Box& box) {
    lower = min(lower, box.lower);
    upper = max(upper, box.upper);
  }
  // That of an empty box is the origin.
  [[nodiscard]] Float4 center() const {
    const Float4 half = Float4::all(0.5f), middle = lower * half + upper * half;
    return select(middle == middle, middle, Float4::all(0));
  }
  [[nodiscard]] Bounds3f bounds() const {
    alignas(16) float l[4], u[4];
    lower.store(l);
    upper.store(u);
    return {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
  }
};

double half_area(const Box& box) {
  const Bounds3f bounds = box.bounds();
  return Bounds3<double>{Vec3d(bounds.lower), Vec3d(bounds.upper)}.half_area();
}

// A primitive, moved about rather than looked up, so that memory is read in order.
struct Reference {
  Box box;
  std::uint32_t primitive;
};

struct Bin {
  Box box;
  std::uint32_t count = 0;

  void add(const Box& other, std::uint32_t other_count) {
    box.extend(other);
    count += other_count;
  }
  // The chance that a ray meets the box, up to a factor, times the primitives to test then. An empty side is no split.
  [[nodiscard]] double cost() const {
    return count == 0 ? std::numeric_limits<double>::infinity() : half_area(box) * count;
  }
};

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0;
  int bin = 0;  // the first that goes right
};

// Which bin a centroid is in, along each axis. Where they are all at the same place, or their extent or its inverse is
// no float, that is bin 0.
class Binning {
 public:
  Binning(const Box& centroids, int bins) : lower_(centroids.lower), last_(bins - 1) {
    const Float4 largest = Float4::all(std::numeric_limits<float>::max());
    const Float4 scale = Float4::all(static_cast<float>(bins)) / (centroids.upper - centroids.lower);
    scale_ = select(scale <= largest, scale, Float4::all(0));
  }
  [[nodiscard]] std::array<int, 3> bins(Float4 centroid) const {
    alignas(16) float positions[4];
    // Infinity times zero counts as zero.
    max((centroid - lower_) * scale_, Float4::all(0)).store(positions);
    const auto bin = [&](float position) { return std::min(static_cast<int>(position), last_); };
    return {bin(positions[0]), bin(positions[1]), bin(positions[2])};
  }

 private:
  Float4 lower_, scale_;
  int last_;
};

class BinnedSahBuilder {
 public:
  BinnedSahBuilder(std::span<const Bounds3f> bounds, const BvhConfig& config)
      : bin_count_(std::clamp(config.bins, 2, most_bins)),
        max_leaf_size_(static_cast<std::uint32_t>(std::max(1, config.max_leaf_size))) {
    references_.reserve(bounds.size());
    for (std::uint32_t i = 0; i < bounds.size(); ++i) references_.push_back({Box(bounds[i]), i});
    bvh_.nodes.reserve(bounds.size());
  }

  Bvh build() {
    build_node(0, static_cast<std::uint32_t>(references_.size()), 0);
    bvh_.primitives.reserve(references_.size());
    for (const Reference& reference : references_) bvh_.primitives.push_back(reference.primitive);
    return std::move(bvh_);
  }

 private:
  // Over references_[begin, end).
  void build_node(std::uint32_t begin, std::uint32_t end, int depth) {
    const std::size_t index = bvh_.nodes.size();
    Box box, centroids;
    for (std::uint32_t i = begin; i < end; ++i) {
      box.extend(references_[i].box);
      centroids.extend(references_[i].box.center());
    }
    bvh_.nodes.push_back({.bounds = box.bounds()});

    const std::uint32_t middle = choose_middle(begin, end, depth, half_area(box), centroids);
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
  std::uint32_t choose_middle(std::uint32_t begin, std::uint32_t end, int depth, double area, const Box& centroids) {
    const std::uint32_t count = end - begin;
    if (count == 1) return end;
    const Binning binning(centroids, bin_count_);
    const Split split = depth < deepest_sah_split ? find_split(begin, end, binning) : Split{};
    const bool is_split_better = split.cost + node_cost * area < count * area;
    if (count <= max_leaf_size_ && !is_split_better) return end;
    // No bins to split between: any half is as good as another.
    if (!std::isfinite(split.cost)) return begin + count / 2;

    const auto first = references_.begin();
    const auto middle = std::partition(first + begin, first + end, [&](const Reference& reference) {
      return binning.bins(reference.box.center())[split.axis] < split.bin;
    });
    return static_cast<std::uint32_t>(middle - first);
  }

  // The best split between bins along any axis.
  [[nodiscard]] Split find_split(std::uint32_t begin, std::uint32_t end, const Binning& binning) {
    for (auto& axis_bins : bins_) std::fill_n(axis_bins.begin(), bin_count_, Bin{});
    for (std::uint32_t i = begin; i < end; ++i) {
      const Box& box = references_[i].box;
      const std::array<int, 3> bins = binning.bins(box.center());
      for (std::size_t axis = 0; axis < 3; ++axis) bins_[axis][bins[axis]].add(box, 1);
    }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) consider_axis(best, axis);
    return best;
  }

  // Takes the best split along one axis where it is better than `best`.
  void consider_axis(Split& best, std::size_t axis) const {
    const std::array<Bin, most_bins>& bins = bins_[axis];
    std::array<double, most_bins> right_costs;  // of bin i and those above
    Bin right, left;
    for (int i = bin_count_ - 1; i > 0; --i) {
      right.add(bins[i].box, bins[i].count);
      right_costs[i] = right.cost();
    }
    for (int i = 1; i < bin_count_; ++i) {
      left.add(bins[i - 1].box, bins[i - 1].count);
      const double cost = left.cost() + right_costs[i];
      if (cost < best.cost) best = {cost, axis, i};
    }
  }

  std::vector<Reference> references_;
  int bin_count_;
  std::uint32_t max_leaf_size_;
  std::array<std::array<Bin, most_bins>, 3> bins_;  // of the node being split
  Bvh bvh_;
};

}  // namespace

Bvh build_binned_sah(std::span<const Bounds3f> bounds, const BvhConfig& config) {
  return BinnedSahBuilder(bounds, config).build();
}

}  // namespace basicrt
