// SPDX-License-Identifier: GPL-3.0-or-later
// The assignment's integrator: perfect refraction followed to a surface that is lit by one point light.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bsdf/bsdf.h"
#include "integrator/hit_shading.h"
#include "integrator/integrator.h"

namespace basicrt {

class IntersectionTest final : public Integrator {
 public:
  explicit IntersectionTest(const PreparedScene& scene) : Integrator(scene), scene_(scene) {}
  void render(const CameraPaths& paths, std::span<PixelSample> samples) override;

 private:
  struct Path {
    std::uint32_t sample;  // which of the batch's samples it is for
    Sampler sampler;
    Color throughput{1.0f};
  };
  // From a surface point.
  struct ToLight {
    Vec3f wi;
    float distance, inverse_distance;
  };
  struct ShadowTest {
    std::uint32_t sample;
    Color radiance;  // if nothing is in the way
  };

  void begin(const CameraPaths& paths, std::span<PixelSample> samples);
  void extend();                                                   // finds each path's next hit
  void shade(std::span<PixelSample> samples, bool is_camera_ray);  // refracts it, or asks for its light
  void connect(std::span<PixelSample> samples);                    // tests the shadow rays

  void find_points(std::size_t first);
  void gather_light(const Path& path, const Ray& ray, const SurfacePoint& point, const ToLight& to_light,
                    const Bsdf& bsdf);

  const PreparedScene& scene_;
  std::vector<Path> paths_;
  std::vector<Ray> rays_;  // the next one of each path
  std::vector<Hit> hits_;
  // Of some of the hits at a time.
  SurfacePoints points_;
  std::array<ToLight, SurfacePoints::at_once> to_light_;
  std::vector<Ray> shadow_rays_;
  std::vector<ShadowTest> shadow_tests_;
  std::vector<std::uint8_t> occluded_;
};

}  // namespace basicrt
