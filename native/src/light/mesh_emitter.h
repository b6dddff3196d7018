// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh that shines, each triangle for itself.
#pragma once

#include <optional>

#include "geometry/surface_point.h"
#include "light/emissive_instance.h"
#include "light/light.h"
#include "light/light_bounds.h"
#include "light/triangle_emitter.h"

namespace basicrt {

// Corners are taken from the shape and transformed when they are needed.
class MeshEmitter {
 public:
  MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh);

  [[nodiscard]] double power() const { return power_; }  // watts, of the luminance
  [[nodiscard]] double power(std::uint32_t triangle) const;
  [[nodiscard]] std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(mesh_->triangles.size()); }
  // At all times. Without intensity where the triangle is black.
  [[nodiscard]] LightBounds bounds(std::uint32_t triangle) const;
  [[nodiscard]] std::optional<LightSample> sample(std::uint32_t triangle, Vec3f position, Vec2f u, float time) const;
  // The density of sample() for a place on a triangle.
  [[nodiscard]] double pdf(std::uint32_t triangle, Vec3f point, Vec3f position, float time) const;

 private:
  // A triangle in the world at one time.
  struct PlacedTriangle {
    EmitterTriangle corners;
    bool is_mirrored;
  };
  [[nodiscard]] PlacedTriangle place(std::uint32_t triangle, float time) const;
  [[nodiscard]] bool is_moving() const { return mesh_->is_deforming() || !motion_.empty(); }
  [[nodiscard]] LightBounds moving_bounds(std::uint32_t triangle) const;
  [[nodiscard]] double mean_area(std::uint32_t triangle) const;                    // of its keys
  [[nodiscard]] EmissiveInstance::Estimate emitted(std::uint32_t triangle) const;  // luminance
  // Whether the side that is seen along `offset`, from a position to the triangle, is its front.
  [[nodiscard]] static bool is_front_along(Vec3d offset, const PlacedTriangle& placed);
  [[nodiscard]] std::size_t slot(std::uint32_t triangle) const;

  const Mesh* mesh_;
  TransformD object_to_world_;
  std::vector<TransformD> motion_;
  bool is_mirrored_;
  std::uint32_t instance_;
  std::vector<Color> front_, back_;
  std::vector<bool> is_varying_;
  std::vector<EmissiveInstance::Estimate> estimates_;  // none where nothing varies
  double power_ = 0;
};

}  // namespace basicrt
