// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling of the pictures around a scene and of the suns in its skies, each by its brightness. What is the same everywhere is left to BSDF
// sampling: that follows the cosine and the lobes, which is all that varies.
#pragma once

#include <optional>
#include <vector>

#include "light/environment.h"
#include "light/equirect_table.h"
#include "light/light.h"
#include "math/distribution.h"

namespace basicrt {

class EnvironmentSampler {
 public:
  EnvironmentSampler() = default;
  // Skies are drawn and tables are made by so many threads, 0: one per processor.
  explicit EnvironmentSampler(const Environment& environment, int threads = 0);

  [[nodiscard]] bool is_empty() const { return !(choices_.total() > 0); }  // nothing to sample
  [[nodiscard]] int light_group() const { return environment_.light_group; }
  // Watts that the pictures send through a sphere.
  [[nodiscard]] double power(float scene_radius) const;

  // What a ray sees that hits nothing, from a direction of unit length.
  [[nodiscard]] Color eval(Vec3f direction, bool is_camera_ray) const;
  // `choice` picks the picture or sun. The radiance is all of the environment's.
  [[nodiscard]] std::optional<LightSample> sample(float choice, Vec2f u) const;
  [[nodiscard]] float pdf(Vec3f direction) const;

 private:
  struct Picture {
    EquirectTable table;  // over directions in the layer's space, or in the world's
    bool is_in_world = true;
    TransformD to_image, to_world;  // between the two, where the table is in the layer's
  };
  struct Sun {
    SunDisc disc;
    Color scale;
    EnvironmentRays seen_by;
    TransformD to_sky;         // of a direction, as a point
    TransformD to_world = {};  // back, where the sun is sampled
    bool is_sampled = false;
    // Whether a direction is in the disc must be the same to the last bit for its radiance and its density.
    [[nodiscard]] Vec3d in_sky(Vec3f direction) const { return normalize(to_sky.point(Vec3d(direction))); }
  };
  void draw_skies(int threads);
  void add_sun(const SunDisc& disc, const EnvironmentLayer& layer);
  [[nodiscard]] static double sampling_weight(const Sun& sun);
  [[nodiscard]] static Vec3f sample_picture(const Picture& picture, Vec2f u);
  [[nodiscard]] static Vec3f sample_sun(const Sun& sun, Vec2f u);
  [[nodiscard]] double pdf_suns(Vec3f direction) const;
  [[nodiscard]] static Picture make_picture(const EnvironmentLayer& layer, int threads);

  Environment environment_;  // its skies are images
  std::vector<Picture> pictures_;
  std::vector<Sun> suns_;
  DiscreteDistribution choices_;  // pictures first, then suns
};

}  // namespace basicrt
