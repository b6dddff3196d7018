// SPDX-License-Identifier: GPL-3.0-or-later
// Integrators advance a batch of paths together and say what each camera sample sees.
#pragma once

#include <memory>
#include <span>

#include "camera/camera.h"
#include "film/film.h"
#include "sampling/sampler.h"
#include "scene/prepare.h"

namespace basicrt {

// A path before its first surface: where its camera ray starts, and the numbers it draws.
struct CameraPath {
  CameraRay camera_ray;
  Sampler sampler;
};

// Fills samples[i] for paths[i]. A batch of one gives the same sample as the same path in a batch of many. Not thread
// safe: each worker has its own, with the batch's memory in it. The scene must outlive it.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual void render(std::span<const CameraPath> paths, std::span<PixelSample> samples) = 0;
};

[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene);

}  // namespace basicrt
