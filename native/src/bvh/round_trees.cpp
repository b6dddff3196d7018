// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of points and of parts of curves go to a builder; what is in its leaves is put in their order.
#include "bvh/round_trees.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bvh/box_walk.h"
#include "bvh/tree_layout.h"
#include "geometry/curve_intersection.h"
#include "geometry/sphere.h"

namespace basicrt {
namespace {

constexpr double most_turn = 15 * std::numbers::pi / 180;  // of a part's direction
constexpr double longest_part = 24;                        // in radii
constexpr int most_parts_for_turns = 16, most_parts_for_length = 4;

// Puts `entries` into the order of the leaves. `boxes` are theirs.
template <class Entry>
LeafTree build_leaf_tree(const std::vector<Bounds3f>& boxes, HugeVector<Entry>& entries, const BvhConfig& config) {
  TreeLayout layout = build_box_layout(boxes, config);
  HugeVector<Entry> ordered;
  ordered.reserve(layout.primitives.size());
  for (const std::uint32_t primitive : layout.primitives) ordered.push_back(entries[primitive]);
  entries = std::move(ordered);
  return {.tree = {std::move(layout.nodes), layout.root, layout.bounds}, .leaf_begins = std::move(layout.leaf_begins)};
}

double distance_to_line(Vec3d point, Vec3d begin, Vec3d end) {
  const Vec3d along = end - begin;
  const double squared = length_squared(along);
  const double share = squared > 0 ? std::clamp(dot(point - begin, along) / squared, 0.0, 1.0) : 0;
  return length(point - begin - along * share);
}

CurveTree::Part make_part(std::uint32_t number, const CurveSegment& segment, CurveRange range) {
  const std::array<Vec3d, 4> hull = bezier_points(segment.points, range);
  CurveTree::Part part{.begin = Vec3f(hull[0]),
                       .end = Vec3f(hull[3]),
                       .reach = 0,
                       .u_begin = static_cast<float>(range.begin),
                       .u_end = static_cast<float>(range.end),
                       .segment = number,
                       .is_first = segment.is_first,
                       .is_last = segment.is_last};
  double bend = 0, largest = 0;
  for (const Vec3d point : hull) {
    bend = std::max(bend, distance_to_line(point, Vec3d(part.begin), Vec3d(part.end)));
    largest = std::max({largest, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  }
  // With room for what rounding takes.
  part.reach = static_cast<float>((bend + largest_radius(segment, range)) * (1 + 1e-6) + largest * 1e-12);
  return part;
}

// Whether the ray comes within reach of the line between a part's ends.
bool may_hit(const CurveTree::Part& part, const PreciseRay& ray, Vec3d unit, double inverse_length) {
  const Vec3d begin = Vec3d(part.begin) - ray.origin, end = Vec3d(part.end) - ray.origin;
  const double along_begin = dot(begin, unit), along_end = dot(end, unit);
  const double reach = part.reach;
  if ((std::min(along_begin, along_end) - reach) * inverse_length > ray.t_max) return false;
  if ((std::max(along_begin, along_end) + reach) * inverse_length < ray.t_min) return false;
  const Vec3d off_begin = begin - unit * along_begin, across = end - unit * along_end - off_begin;
  const double squared = length_squared(across);
  const double share = squared > 0 ? std::clamp(-dot(off_begin, across) / squared, 0.0, 1.0) : 0;
  // Far from the ray's origin rounding counts.
  const double noise = (std::abs(along_begin) + std::abs(along_end)) * 1e-14;
  return length_squared(off_begin + across * share) <= (reach + noise) * (reach + noise);
}

bool is_usable(const PreciseRay& ray) {
  const double squared = length_squared(ray.direction);
  return squared > 0 && std::isfinite(squared) && std::isfinite(length_squared(ray.origin));
}

bool is_before(double t, std::uint32_t number, double nearest_t, const std::optional<Hit>& nearest) {
  return !nearest || t < nearest_t || (t == nearest_t && number < nearest->primitive);
}

}  // namespace

int part_count(const CurveSegment& segment) {
  // How far the direction turns, looked at in a few places.
  double turn = 0;
  constexpr int places = 8;
  Vec3d before = segment.tangent(0);
  for (int i = 1; i <= places; ++i) {
    const Vec3d here = segment.tangent(static_cast<double>(i) / places);
    turn += std::atan2(length(cross(before, here)), dot(before, here));
    before = here;
  }
  const double radius = largest_radius(segment, {0, 1});
  const double reach = length(segment.point(1) - segment.point(0)) / std::max(radius * longest_part, 1e-300);
  const int for_turns = std::min(static_cast<int>(std::ceil(turn / most_turn)), most_parts_for_turns);
  const int for_length = static_cast<int>(std::min(std::ceil(reach), static_cast<double>(most_parts_for_length)));
  return std::max({1, for_turns, for_length});
}

PointTree build_point_tree(const PointCloud& cloud, const BvhConfig& config) {
  PointTree result;
  std::vector<Bounds3f> boxes;
  for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) {
    const Bounds3f box = point_bounds(cloud, i);
    if (box.is_empty()) continue;
    boxes.push_back(box);
    result.points.push_back({cloud.positions[i], cloud.radii[i], i});
  }
  result.boxes = build_leaf_tree(boxes, result.points, config);
  return result;
}

CurveTree build_curve_tree(const Curves& curves, const BvhConfig& config) {
  CurveTree result;
  result.points = curves.points;
  result.radii = curves.radii;
  result.form = curves.form;
  std::vector<Bounds3f> boxes;
  for_each_segment(curves, [&](std::uint32_t number, const CurveSegment& segment) {
    const int count = part_count(segment);
    for (int i = 0; i < count; ++i) {
      // As floats, so that parts begin where others end.
      const auto at = [&](int k) { return static_cast<double>(static_cast<float>(k) / static_cast<float>(count)); };
      const CurveRange range{at(i), at(i + 1)};
      if (!(largest_radius(segment, range) > 0)) continue;
      boxes.push_back(bounds_of_range(segment, range));
      result.parts.push_back(make_part(number, segment, range));
    }
  });
  result.boxes = build_leaf_tree(boxes, result.parts, config);
  return result;
}

std::optional<Hit> intersect_precisely(const PointTree& tree, PreciseRay ray) {
  std::optional<Hit> nearest;
  if (!is_usable(ray)) return nearest;
  walk_boxes(tree.boxes.tree, ray, [&](std::uint32_t leaf) {
    for (std::uint32_t i = tree.boxes.leaf_begins[leaf]; i < tree.boxes.leaf_begins[leaf + 1]; ++i) {
      const PointTree::Point& point = tree.points[i];
      const double t_before = ray.t_max;
      const auto t = intersect_sphere(ray, Sphere{point.center, point.radius});
      if (!t || !is_before(*t, point.number, t_before, nearest)) continue;
      nearest = Hit{.t = static_cast<float>(*t), .primitive = point.number};
    }
  });
  return nearest;
}

std::optional<Hit> intersect_precisely(const CurveTree& tree, PreciseRay ray) {
  std::optional<Hit> nearest;
  if (!is_usable(ray)) return nearest;
  const double inverse_length = 1 / length(ray.direction);
  const Vec3d unit = ray.direction * inverse_length;
  walk_boxes(tree.boxes.tree, ray, [&](std::uint32_t leaf) {
    for (std::uint32_t i = tree.boxes.leaf_begins[leaf]; i < tree.boxes.leaf_begins[leaf + 1]; ++i) {
      const CurveTree::Part& part = tree.parts[i];
      if (!may_hit(part, ray, unit, inverse_length)) continue;
      const CurveSegment segment =
          make_segment(tree.points.data(), tree.radii.data(), part.segment, part.is_first, part.is_last);
      const auto hit = intersect_curve(ray, segment, {part.u_begin, part.u_end}, tree.form);
      if (!hit || !is_before(hit->t, part.segment, ray.t_max, nearest)) continue;
      ray.t_max = hit->t;
      nearest = Hit{.t = static_cast<float>(hit->t),
                    .primitive = part.segment,
                    .u = static_cast<float>(hit->u),
                    .v = static_cast<float>(hit->v)};
    }
  });
  return nearest;
}

}  // namespace basicrt
