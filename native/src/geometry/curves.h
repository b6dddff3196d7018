// SPDX-License-Identifier: GPL-3.0-or-later
// Hair: many curves in one shape, each as thick as it says.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "geometry/mesh.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

// What a curve looks like: all spheres with their middles on it, from outside; or a flat ribbon that always faces the ray.
enum class CurveForm : std::uint8_t { round, ribbon };
template <>
inline constexpr std::array enum_names<CurveForm> = std::to_array<std::string_view>({"round", "ribbon"});

// Each goes through its points as a cubic spline (Catmull and Rom 1974), and so does its radius. A segment is called by
// the number of its first point. A curve of a single point has none, and can't be hit.
struct Curves {
  std::vector<Vec3f> points;          // object space, metres; of one curve after the other
  std::vector<float> radii;           // of each point, metres
  std::vector<std::uint32_t> firsts;  // of each curve's points, ascending from 0: it ends where the next begins
  CurveForm form = CurveForm::round;
  std::vector<float> intercepts;          // of each point, how far along its curve it is; none: by its number
  std::vector<float> randoms;             // of each curve, or none at all: 0
  std::vector<Vec2f> uvs;                 // of each curve, where it is rooted; none: the intercept and 0
  std::vector<MeshAttribute> attributes;  // of the domains vertex, for points, and face, for curves
  static constexpr std::string_view kind = "curves";

  // Where a curve's points end.
  [[nodiscard]] std::uint32_t end_of(std::uint32_t curve) const {
    return curve + 1 < firsts.size() ? firsts[curve + 1] : static_cast<std::uint32_t>(points.size());
  }
  [[nodiscard]] std::uint32_t curve_of(std::uint32_t point) const;
  // Linear between two points: `segment` and `u` are those of a hit.
  [[nodiscard]] float intercept_at(std::uint32_t segment, float u) const;
  [[nodiscard]] float radius_at(std::uint32_t segment, float u) const;
  // Of the lines between its points, object space.
  [[nodiscard]] float length_of(std::uint32_t curve) const;
};

[[nodiscard]] bool has_segments(const Curves& curves);
[[nodiscard]] Bounds3f bounds(const Curves& curves);

// Throws SceneError, naming `item`, when a number is not finite or an array has the wrong length or order.
void validate(const Curves& curves, std::string_view item);

}  // namespace basicrt
