// SPDX-License-Identifier: GPL-3.0-or-later
// The rays of a picture: from the camera, and from what those hit to a light and onwards.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bvh/tracer.h"
#include "geometry/surface_point.h"
#include "math/frame.h"
#include "math/warp.h"
#include "scenes.h"

namespace basicrt::benchmark {

struct RaySet {
  std::string name;
  std::vector<Ray> rays;
  bool is_any = false;         // ask for any hit, not the nearest
  bool goes_together = false;  // packets are at their best here
};

// One for each of `side` x `side` pixels, a power of two, so that 16 in a row are a square of 4 x 4 and 256 one of 16 x 16.
inline std::vector<Ray> make_primary_rays(int side) {
  std::vector<Ray> rays;
  const auto every_other_bit = [](unsigned bits) {
    unsigned result = 0;
    for (unsigned i = 0; i < 16; ++i) result |= (bits >> (2 * i) & 1) << i;
    return result;
  };
  for (unsigned i = 0; i < static_cast<unsigned>(side * side); ++i) {
    const auto coordinate = [&](unsigned pixel) {
      return (2 * static_cast<float>(pixel) + 1) / static_cast<float>(side) - 1;
    };
    const Vec3f target{coordinate(every_other_bit(i)), coordinate(every_other_bit(i >> 1)), 0};
    const Vec3f origin{0.1f, 0.6f, 2.8f};
    rays.push_back({.origin = origin, .direction = normalize(target * 0.8f - origin)});
  }
  return rays;
}

// Adds to `shadow` a ray to a light above, and to `diffuse` one in a cosine-distributed direction, for each hit.
inline void add_secondary_rays(const BenchmarkScene& scene, const std::vector<Ray>& primary,
                               const std::vector<Hit>& hits, std::vector<Ray>& shadow, std::vector<Ray>& diffuse) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (std::size_t i = 0; i < primary.size(); ++i) {
    if (!hits[i].is_hit()) continue;
    const TracedInstance& instance = scene.instances[hits[i].instance];
    const SurfacePoint point =
        make_surface_point(scene.shapes[instance.shape], Placement(instance.object_to_world), primary[i], hits[i]);
    const Vec3f normal = point.is_backfacing ? -point.geometric_normal : point.geometric_normal;
    Ray ray{.from_instance = hits[i].instance, .from_primitive = hits[i].primitive};
    const Vec3f bounce = make_frame(normal).to_world(sample_cosine_hemisphere({uniform(rng), uniform(rng)}));
    ray.origin = offset_origin(point, bounce);
    ray.direction = bounce;
    diffuse.push_back(ray);
    const Vec3f to_light = Vec3f{0.3f, 0.9f, 0.2f} - point.position;
    ray.origin = offset_origin(point, to_light);
    ray.t_max = length(to_light);
    ray.direction = to_light / ray.t_max;
    shadow.push_back(ray);
  }
}

inline std::vector<RaySet> make_ray_sets(const BenchmarkScene& scene, const Tracer& tracer, int side) {
  RaySet primary{.name = "primary", .rays = make_primary_rays(side), .goes_together = true};
  RaySet shadow{.name = "shadow", .rays = {}, .is_any = true, .goes_together = true};
  RaySet diffuse{.name = "diffuse, tile order", .rays = {}};
  std::vector<Hit> hits(primary.rays.size());
  tracer.intersect(primary.rays, hits);
  add_secondary_rays(scene, primary.rays, hits, shadow.rays, diffuse.rays);
  RaySet shuffled{.name = "diffuse, shuffled", .rays = diffuse.rays};
  std::shuffle(shuffled.rays.begin(), shuffled.rays.end(), std::mt19937(12));
  return {std::move(primary), std::move(shadow), std::move(diffuse), std::move(shuffled)};
}

}  // namespace basicrt::benchmark
