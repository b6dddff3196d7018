// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as Python holds it, and the right to read it while other Python threads run.
#pragma once

#include <stdexcept>
#include <utility>

#include "scene/scene.h"

namespace basicrt::bindings {

// Python holds references to the environment and the settings and may write through them at any time, so they live
// apart from the scene and join it for the length of a lease. All members are guarded by the GIL.
class BoundScene {
 public:
  BoundScene() = default;
  explicit BoundScene(Scene scene)
      : environment(scene.environment), settings(scene.settings), scene_(std::move(scene)) {}

  Environment environment;
  RenderSettings settings;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  // To change tables and camera. Throws while another thread has a lease.
  [[nodiscard]] Scene& edit() {
    if (is_leased_) throw std::runtime_error("Scene: another thread is preparing or saving it");
    return scene_;
  }

 private:
  friend class SceneLease;

  Scene scene_;
  bool is_leased_ = false;
};

// While it lives nobody can change the scene, so it may be read without the GIL. Made and destroyed with the GIL.
class SceneLease {
 public:
  explicit SceneLease(BoundScene& bound) : bound_(bound) {
    Scene& scene = bound.edit();
    scene.environment = bound.environment;
    scene.settings = bound.settings;
    bound.is_leased_ = true;
  }
  ~SceneLease() { bound_.is_leased_ = false; }
  SceneLease(const SceneLease&) = delete;
  SceneLease& operator=(const SceneLease&) = delete;

  [[nodiscard]] const Scene& scene() const { return bound_.scene_; }

 private:
  BoundScene& bound_;
};

}  // namespace basicrt::bindings
