// SPDX-License-Identifier: GPL-3.0-or-later
// Ear clipping (Meisters 1975, "Polygons have ears").
#include "io/triangulate.h"

#include <algorithm>
#include <numeric>

namespace basicrt {
namespace {

class EarClipper {
 public:
  explicit EarClipper(std::span<const Vec3f> polygon) : polygon_(polygon), left_(polygon.size()) {
    std::iota(left_.begin(), left_.end(), 0u);
    // Newell's normal: twice the area, along the axis that the corners turn around.
    for (std::size_t i = 0; i < polygon.size(); ++i)
      normal_ += cross(position(i) - position(0), position(i + 1) - position(0));
  }

  std::vector<std::array<std::uint32_t, 3>> clip() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t corner = 1, misses = 0;
    while (left_.size() >= 3) {
      // With no ear in sight (the polygon crosses itself or has no area) any corner must do.
      if (!is_ear(corner) && misses++ < left_.size()) {
        corner = (corner + 1) % left_.size();
        continue;
      }
      triangles.push_back({before(corner), left_[corner], after(corner)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(corner));
      corner %= left_.size();
      misses = 0;
    }
    return triangles;
  }

 private:
  [[nodiscard]] Vec3d position(std::size_t index) const { return Vec3d(polygon_[index % polygon_.size()]); }
  [[nodiscard]] std::uint32_t before(std::size_t corner) const {
    return left_[(corner + left_.size() - 1) % left_.size()];
  }
  [[nodiscard]] std::uint32_t after(std::size_t corner) const { return left_[(corner + 1) % left_.size()]; }
  // Positive where c lies left of the line from a to b, seen against the normal.
  [[nodiscard]] double side(Vec3d a, Vec3d b, Vec3d c) const { return dot(cross(b - a, c - a), normal_); }

  // Convex, and no other corner in the triangle that it would cut off.
  [[nodiscard]] bool is_ear(std::size_t corner) const {
    const Vec3d a = position(before(corner)), b = position(left_[corner]), c = position(after(corner));
    if (!(side(a, b, c) > 0)) return false;
    return std::ranges::none_of(left_, [&](std::uint32_t index) {
      const Vec3d p = position(index);
      return p != a && p != b && p != c && side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0;
    });
  }

  std::span<const Vec3f> polygon_;
  std::vector<std::uint32_t> left_;  // the corners that are not cut off yet
  Vec3d normal_{0.0};
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3f> polygon) {
  if (polygon.size() == 3) return {{0, 1, 2}};
  return EarClipper(polygon).clip();
}

}  // namespace basicrt
