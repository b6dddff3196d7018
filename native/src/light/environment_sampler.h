// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling of the pictures around a scene, each by its brightness. What is the same everywhere is left to BSDF
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
  // The tables are made by so many threads, 0: one per processor.
  explicit EnvironmentSampler(const Environment& environment, int threads = 0);

  [[nodiscard]] bool is_empty() const { return !(choices_.total() > 0); }  // nothing to sample
  // Watts that the pictures send through a sphere.
  [[nodiscard]] double power(float scene_radius) const;

  // `choice` picks the picture. The radiance is all of the environment's.
  [[nodiscard]] std::optional<LightSample> sample(float choice, Vec2f u) const;
  [[nodiscard]] float pdf(Vec3f direction) const;

  [[nodiscard]] const Environment& environment() const { return environment_; }

 private:
  struct Picture {
    EquirectTable table;  // over directions in the layer's space, or in the world's
    bool is_in_world = true;
    TransformD to_image, to_world;  // between the two, where the table is in the layer's
  };
  [[nodiscard]] static Picture make_picture(const EnvironmentLayer& layer, int threads);

  Environment environment_;
  std::vector<Picture> pictures_;
  DiscreteDistribution choices_;
};

}  // namespace basicrt
