// SPDX-License-Identifier: GPL-3.0-or-later
// Trees over points and curves, and the nearest hit in them in double precision.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/huge_pages.h"
#include "bvh/bvh.h"
#include "bvh/mesh_tree.h"
#include "geometry/curve_segment.h"
#include "geometry/curves.h"
#include "geometry/hit.h"
#include "geometry/point_cloud.h"
#include "geometry/precise_ray.h"

namespace basicrt {

// A tree whose leaf i is entries leaf_begins[i] up to before leaf_begins[i + 1] of whatever stands in the leaves' order.
struct LeafTree {
  NodeTree tree;
  HugeVector<std::uint32_t> leaf_begins;

  [[nodiscard]] std::size_t memory() const {  // bytes
    return tree.memory() + leaf_begins.size() * sizeof(std::uint32_t);
  }
};

struct PointTree {
  struct Point {
    Vec3f center;
    float radius;
    std::uint32_t number;
  };
  LeafTree boxes;
  HugeVector<Point> points;

  [[nodiscard]] std::size_t memory() const { return boxes.memory() + points.size() * sizeof(Point); }  // bytes
};

struct CurveTree {
  // A part of a segment, and the line between its ends. No point of its surface is farther from that than `reach`.
  struct Part {
    Vec3f begin, end;
    float reach;
    float u_begin, u_end;
    std::uint32_t segment;
    bool is_first, is_last;  // the segment is, of its curve
  };
  LeafTree boxes;
  HugeVector<Part> parts;
  std::vector<Vec3f> points;
  std::vector<float> radii;
  CurveForm form = CurveForm::round;

  [[nodiscard]] std::size_t memory() const {  // bytes
    return boxes.memory() + parts.size() * sizeof(Part) + points.size() * (sizeof(Vec3f) + sizeof(float));
  }
};

// The same for any number of threads.
[[nodiscard]] PointTree build_point_tree(const PointCloud& cloud, const BvhConfig& config);
[[nodiscard]] CurveTree build_curve_tree(const Curves& curves, const BvhConfig& config);

// The nearest hit in [t_min, t_max], of equally near ones that of the lowest number, without its instance.
[[nodiscard]] std::optional<Hit> intersect_precisely(const PointTree& tree, PreciseRay ray);
[[nodiscard]] std::optional<Hit> intersect_precisely(const CurveTree& tree, PreciseRay ray);

// How a segment is cut into parts that hardly bend, and whose boxes are not all too empty.
[[nodiscard]] int part_count(const CurveSegment& segment);

}  // namespace basicrt
