// SPDX-License-Identifier: GPL-3.0-or-later
// Integrators advance a batch of paths together and say what each camera sample sees.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "film/film.h"
#include "integrator/hit_shading.h"
#include "integrator/pass_recorder.h"
#include "math/ray.h"
#include "sampling/sampler.h"
#include "scene/prepare.h"

namespace basicrt {

// What counts of surfaces that are baked.
struct BakedParts {
  std::uint32_t kinds = ray_diffuse | ray_glossy | ray_transmission;  // RayKind bits: in which ways it scatters
  bool has_emission = true;
};

// Paths before their first surface: the camera ray of each, and the numbers it draws.
struct CameraPaths {
  std::vector<Ray> rays;
  std::vector<Sampler> samplers;
  // Of baking, which knows what each ray meets first: one for each ray, and of that only `parts` counts. Else none.
  std::vector<Hit> first_hits;
  BakedParts parts = {};

  void add(const Ray& ray, const Sampler& sampler) {
    rays.push_back(ray);
    samplers.push_back(sampler);
  }
  void clear() {
    rays.clear();
    samplers.clear();
    first_hits.clear();
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(rays.size()); }
};

// Fills samples[i] for the path i. A batch of one gives the same sample as the same path in a batch of many. Not thread
// safe: each worker has its own, with the batch's memory in it. The scene must outlive it.
class Integrator {
 public:
  explicit Integrator(const PreparedScene& scene) : recorder_(scene) {}
  virtual ~Integrator() = default;
  virtual void render(const CameraPaths& paths, std::span<PixelSample> samples) = 0;
  // What the last batch said of the passes that are in no PixelSample.
  [[nodiscard]] const PassRecorder& passes() const { return recorder_; }

 protected:
  // `sample` is samples[index], that has not seen anything yet.
  void note_first_hit(std::uint32_t index, const SurfacePoint& point, PixelSample& sample) {
    record_first_hit(recorder_.scene(), point, sample);
    if (recorder_.is_active()) recorder_.record_first_hit(index, point);
  }

  // `sample` has not seen anything, and here goes on for ever.
  void note_background(std::uint32_t index, const Ray& ray, const PixelSample& sample) {
    if (recorder_.is_active() && !sample.has_hit) recorder_.record_background(index, ray);
  }

  PassRecorder recorder_;
};

[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene);

}  // namespace basicrt
