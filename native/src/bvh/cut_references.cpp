// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts along the planes of a grid over the mesh, the coarsest first: those that nodes are likely to be split at.
#include "bvh/cut_references.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "math/next_float.h"

namespace basicrt {
namespace {

constexpr std::size_t chunk_size = 8192;    // triangles that a thread looks at in one go
constexpr std::uint32_t most_pieces = 256;  // of one triangle
constexpr double least_priority = 8;        // of triangles that are cut, in averages: others gain little
constexpr int finest_level = 20;            // the grid's cells are no smaller than the mesh by 2^20

using Triangle = std::array<Vec3d, 3>;

Triangle triangle_of(const Mesh& mesh, std::size_t index) {
  const auto corner = [&](int i) { return Vec3d(mesh.position(static_cast<std::uint32_t>(index), i)); };
  return {corner(0), corner(1), corner(2)};
}

Bounds3f bounds_of(const Mesh& mesh, std::size_t index) {
  Bounds3f box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.position(static_cast<std::uint32_t>(index), corner));
  return box;
}

struct Plane {
  std::size_t axis;
  double position;
  int level;  // of planes that halve the mesh 0, of those that halve its halves 1, and so on
};

// Planes at lower + extent * (odd number) / 2^(level + 1).
class Grid {
 public:
  explicit Grid(const Bounds3f& bounds) : lower_(bounds.lower), extent_(Vec3d(bounds.upper) - Vec3d(bounds.lower)) {}

  // The coarsest one through the inside of a box, and of equally coarse ones that across its longest side.
  [[nodiscard]] std::optional<Plane> coarsest_through(const Bounds3f& box) const {
    std::optional<Plane> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<Plane> plane = coarsest_through(box, axis);
      if (!plane) continue;
      const bool is_coarser = !best || plane->level < best->level;
      const bool is_longer = best && plane->level == best->level && box.extent()[axis] > box.extent()[best->axis];
      if (is_coarser || is_longer) best = plane;
    }
    return best;
  }

 private:
  [[nodiscard]] std::optional<Plane> coarsest_through(const Bounds3f& box, std::size_t axis) const {
    if (!(extent_[axis] > 0)) return std::nullopt;
    for (int level = 0; level < finest_level; ++level) {
      const double cells = std::ldexp(1.0, level + 1);
      const double first = (static_cast<double>(box.lower[axis]) - lower_[axis]) / extent_[axis] * cells;
      const double position = lower_[axis] + extent_[axis] * (std::floor(first) + 1) / cells;
      if (position > static_cast<double>(box.lower[axis]) && position < static_cast<double>(box.upper[axis]))
        return Plane{axis, position, level};
    }
    return std::nullopt;
  }

  Vec3d lower_, extent_;
};

// How much there is to gain by cutting.
double priority(const Triangle& triangle, const Bounds3f& box, const Grid& grid) {
  const std::optional<Plane> plane = grid.coarsest_through(box);
  if (!plane) return 0;
  const Vec3d normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  // A triangle fills at most half of the rectangle around it, seen along any axis.
  const double least_area = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  const double area = Bounds3<double>{Vec3d(box.lower), Vec3d(box.upper)}.half_area();
  return std::cbrt(std::ldexp(std::max(0.0, area - least_area), -plane->level));
}

float float_below(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) > x ? next_float_down(rounded) : rounded;
}
float float_above(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) < x ? next_float_up(rounded) : rounded;
}

// The box of what the triangle has in `box` on one side of the plane, large enough for all roundings.
Bounds3f cut_box(const Triangle& triangle, const Bounds3f& box, const Plane& plane, bool is_upper) {
  Bounds3<double> side;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &a = triangle[i], &b = triangle[(i + 1) % 3];
    const double at_a = a[plane.axis] - plane.position, at_b = b[plane.axis] - plane.position;
    if (is_upper ? at_a >= 0 : at_a <= 0) side.extend(a);
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0)) {
      Vec3d crossing = a + (b - a) * (at_a / (at_a - at_b));
      crossing[plane.axis] = plane.position;
      const Vec3d error = (abs(a) + abs(b)) * 1e-14;
      side.extend(crossing - error);
      side.extend(crossing + error);
    }
  }
  Bounds3f result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = std::max(box.lower[axis], float_below(side.lower[axis]));
    result.upper[axis] = std::min(box.upper[axis], float_above(side.upper[axis]));
  }
  return result;
}

// Cuts into `pieces`, or fewer, at `place` and after. Returns how many.
std::uint32_t cut(const Triangle& triangle, const Bounds3f& box, std::uint32_t primitive, std::uint32_t pieces,
                  const Grid& grid, Reference* place) {
  const std::optional<Plane> plane = pieces > 1 ? grid.coarsest_through(box) : std::nullopt;
  const Bounds3f lower = plane ? cut_box(triangle, box, *plane, false) : Bounds3f();
  const Bounds3f upper = plane ? cut_box(triangle, box, *plane, true) : Bounds3f();
  if (lower.is_empty() || upper.is_empty()) {
    *place = Reference(box, primitive);
    return 1;
  }
  const auto size = [](const Bounds3f& part) {
    const Vec3f extent = part.extent();
    return static_cast<double>(std::max({extent.x, extent.y, extent.z}));
  };
  const double share = size(lower) / (size(lower) + size(upper));
  const auto lower_pieces = static_cast<std::uint32_t>(share * (pieces - 2) + 0.5) + 1;
  const std::uint32_t count = cut(triangle, lower, primitive, lower_pieces, grid, place);
  return count + cut(triangle, upper, primitive, pieces - lower_pieces, grid, place + count);
}

std::uint32_t pieces_for(double priority, double scale) {
  return static_cast<std::uint32_t>(std::min(priority * scale, double{most_pieces - 1})) + 1;
}

// What priorities are scaled by for numbers of cuts.
double find_scale(const std::vector<double>& priorities, std::size_t most_cuts) {
  const double sum = std::accumulate(priorities.begin(), priorities.end(), 0.0);
  if (!(sum > 0) || !std::isfinite(sum)) return 0;
  // The largest that makes no more than so many: rounding down takes half a cut of each triangle on average, at most one.
  double lower = static_cast<double>(most_cuts) / sum;
  double upper = static_cast<double>(most_cuts + priorities.size()) / sum;
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (lower + upper);
    std::size_t cuts = 0;
    for (const double priority : priorities) cuts += pieces_for(priority, middle) - 1;
    (cuts <= most_cuts ? lower : upper) = middle;
  }
  return std::min(lower, static_cast<double>(priorities.size()) / (least_priority * sum));
}

}  // namespace

HugeVector<Reference> cut_references(const Mesh& mesh, std::size_t most_cuts, WorkerPool& pool,
                                     WorkProgress* progress) {
  const std::size_t count = mesh.triangles.size(), chunk_count = (count + chunk_size - 1) / chunk_size;
  const auto for_each_chunk =
      [&](const std::function<void(std::size_t chunk, std::size_t begin, std::size_t end)>& work) {
        pool.for_each(chunk_count, [&](std::size_t chunk) {
          if (progress != nullptr) progress->advance(0);
          work(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
        });
      };

  const Grid grid(bounds(mesh));
  std::vector<double> priorities(count);
  for_each_chunk([&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) priorities[i] = priority(triangle_of(mesh, i), bounds_of(mesh, i), grid);
  });
  const double scale = find_scale(priorities, most_cuts);

  std::vector<std::vector<Reference>> pieces(chunk_count);
  for_each_chunk([&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::array<Reference, most_pieces> cut_pieces;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t made = cut(triangle_of(mesh, i), bounds_of(mesh, i), static_cast<std::uint32_t>(i),
                                     pieces_for(priorities[i], scale), grid, cut_pieces.data());
      pieces[chunk].insert(pieces[chunk].end(), cut_pieces.begin(), cut_pieces.begin() + made);
    }
  });
  std::vector<std::size_t> begins{0};
  for (const auto& chunk : pieces) begins.push_back(begins.back() + chunk.size());
  HugeVector<Reference> references(begins.back());
  for_each_chunk([&](std::size_t chunk, std::size_t, std::size_t) {
    std::copy(pieces[chunk].begin(), pieces[chunk].end(),
              references.begin() + static_cast<std::ptrdiff_t>(begins[chunk]));
    pieces[chunk] = {};
  });
  return references;
}

}  // namespace basicrt
