// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the surface nearby by rays through disks, as for light below a surface: King et al. 2013, "BSSRDF Importance
// Sampling".
#include "shading/bevel_operation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "math/frame.h"
#include "math/ray.h"
#include "shading/evaluator.h"
#include "shading/spread_points.h"
#include "shading/surface_operations.h"

namespace basicrt {
namespace {

// Below this density of a scattering of the path nobody sees the difference.
constexpr float least_sharp_pdf = 8;
constexpr std::uint64_t own_bits = 0xbe7e1;

float squared(float x) { return x * x; }

// How much the surface counts at a distance, in radii: the cube of what is left of the radius. Not normalised.
float falloff(float distance) {
  const float left = std::max(1 - distance, 0.0f);
  return left * left * left;
}

// Distances in radii whose density over the disk is the falloff. Their share below x is 1 - (1 - x)^4 (1 + 4 x): solved by
// Newton's method, within bounds that close in.
float sample_falloff(float u) {
  float low = 0, high = 1, x = 0.5f;
  for (int i = 0; i < 12; ++i) {
    const float left = 1 - x, cube = left * left * left;
    const float excess = 1 - cube * left * (1 + 4 * x) - u;
    if (std::abs(excess) < 1e-6f) break;
    (excess > 0 ? high : low) = x;
    const float next = x - excess / (20 * x * cube);
    x = next > low && next < high ? next : 0.5f * (low + high);
  }
  return x;
}

// A ray through a disk around the point, along one of three axes.
struct Axis {
  std::array<Vec3f, 3> directions;  // the first one the ray's
  std::array<float, 3> shares;      // how often each of them is picked
  float u;                          // what is left of the random number
};

// The surface's own is picked half of the time, the others in the other half.
Axis pick_axis(const Frame& frame, float u) {
  const Vec3f n = frame.normal, t = frame.tangent, b = frame.bitangent;
  if (u < 0.5f) return {{n, t, b}, {0.5f, 0.25f, 0.25f}, u * 2};
  if (u < 0.75f) return {{t, n, b}, {0.25f, 0.5f, 0.25f}, u * 4 - 2};
  return {{b, t, n}, {0.25f, 0.25f, 0.5f}, u * 4 - 3};
}

// The weight of what a ray along the first axis met, by the power heuristic over the three.
float weight_of(const Axis& axis, Vec3f normal) {
  std::array<float, 3> densities;
  for (std::size_t i = 0; i < 3; ++i) densities[i] = axis.shares[i] * std::abs(dot(axis.directions[i], normal));
  const float sum = squared(densities[0]) + squared(densities[1]) + squared(densities[2]);
  return sum > 0 ? densities[0] / sum : 0;
}

// Of the side that geometric normals are on. Zero where nothing was found.
Vec3f mean_normal(const RayProbe& probe, const SurfacePoint& point, float radius, const SpreadPoints& places,
                  int samples) {
  const Frame frame = make_frame(point.geometric_normal);
  Vec3f sum(0.0f);
  for (int i = 0; i < samples; ++i) {
    const Vec2f u = places[i];
    const Axis axis = pick_axis(frame, u.x);
    const float away = sample_falloff(u.y), angle = 2 * pi * axis.u, sampled = falloff(away);
    if (!(sampled > 0)) continue;
    const float height = std::sqrt(std::max(1 - away * away, 0.0f));
    const Vec3f from_point = axis.directions[0] * height +
                             (axis.directions[1] * std::cos(angle) + axis.directions[2] * std::sin(angle)) * away;
    Ray ray{.origin = point.position + from_point * radius,
            .direction = -axis.directions[0],
            .t_max = 2 * height * radius,
            .time = point.time};
    while (const std::optional<SurfacePoint> met = probe.next_hit(ray, point.instance)) {
      const float distance = length(met->position - point.position) / radius;
      sum += met->shading_normal * (weight_of(axis, met->geometric_normal) * falloff(distance) / sampled);
    }
  }
  return sum;
}

}  // namespace

Vec3f eval(const BevelOperation& node, const Evaluator& in) {
  const Vec3f own = viewed_normal(in), start = in(node.normal);
  const bool has_start = length_squared(start) > 0;
  const RayProbe* probe = in.context.probe;
  const float radius = in(node.radius);
  Vec3f bevelled = own;
  if (probe != nullptr && in.context.mesh != nullptr && radius > 0 && in.context.least_pdf >= least_sharp_pdf) {
    const SpreadPoints places(hash(in.context.random_bits, own_bits));
    const Vec3f sum = mean_normal(*probe, in.point, radius, places, node.samples);
    if (const float size = length(sum); size > 0 && std::isfinite(size))
      bevelled = sum * ((in.point.is_backfacing ? -1.0f : 1.0f) / size);
  }
  if (!has_start) return bevelled;
  const Vec3f turned = start + (bevelled - own);
  const float size = length(turned);
  return size > 0 ? turned / size : own;
}

}  // namespace basicrt
