// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh that shines: its triangles are chosen by their power, which is the same at all times.
#pragma once

#include <optional>

#include "geometry/surface_point.h"
#include "light/emissive_instance.h"
#include "light/light.h"
#include "light/triangle_emitter.h"
#include "math/distribution.h"

namespace basicrt {

// Keeps eight bytes for each triangle; corners are taken from the shape and transformed when they are needed.
class MeshEmitter {
 public:
  MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh);

  [[nodiscard]] double power() const { return triangles_.total(); }  // watts, of the luminance
  // `choice` picks the triangle.
  [[nodiscard]] std::optional<LightSample> sample(Vec3f position, float choice, Vec2f u, float time) const;
  // The density of sample() for a place on a triangle.
  [[nodiscard]] double pdf(std::uint32_t triangle, Vec3f point, Vec3f position, float time) const;

 private:
  // A triangle in the world at one time.
  struct PlacedTriangle {
    EmitterTriangle corners;
    bool is_mirrored;
  };
  [[nodiscard]] PlacedTriangle place(std::uint32_t triangle, float time) const;
  [[nodiscard]] double mean_area(std::uint32_t triangle) const;  // of its keys
  // Radiance of the side that is seen along `offset`, from a position to the triangle.
  [[nodiscard]] Color radiance_along(Vec3d offset, std::uint32_t triangle, const PlacedTriangle& placed) const;
  [[nodiscard]] std::size_t slot(std::uint32_t triangle) const;

  const Mesh* mesh_;
  TransformD object_to_world_;
  std::vector<TransformD> motion_;
  bool is_mirrored_;
  std::vector<Color> front_, back_;
  DiscreteDistribution triangles_;
};

}  // namespace basicrt
