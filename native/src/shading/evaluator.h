// SPDX-License-Identifier: GPL-3.0-or-later
// What an operation sees when it runs: its inputs' values, and the point of the surface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/table.h"
#include "geometry/curves.h"
#include "geometry/mesh.h"
#include "geometry/placement.h"
#include "geometry/point_cloud.h"
#include "geometry/surface_point.h"
#include "math/ray.h"
#include "shading/inputs.h"

namespace basicrt {

// What users have noted about an object.
struct ObjectProperty {
  std::string name;
  Vec3f value;  // a number thrice
};

// Of an object, for Blender's Object Info, and for Attribute nodes that read objects.
struct ObjectInfo {
  Color color{1.0f};
  float alpha = 1;
  float random = 0;
  std::vector<ObjectProperty> properties{};
};

// The part of the plane that the picture shows: where z = 1 for a perspective camera, any across z for an orthographic one.
struct CameraWindow {
  Vec2f min{-1.0f, -1.0f}, size{2.0f, 2.0f};
  bool is_perspective = true;
};

// What programs may ask of the whole scene, of which they know nothing else.
class RayProbe {
 public:
  virtual ~RayProbe() = default;
  // Whether a ray from the point meets anything within the distance: only of the point's own object where `is_local`.
  [[nodiscard]] virtual bool is_occluded(const SurfacePoint& point, Vec3f direction, float distance,
                                         bool is_local) const = 0;
  // The next place where the ray meets this instance, through whatever else there is. The ray then goes on behind it.
  [[nodiscard]] virtual std::optional<SurfacePoint> next_hit(Ray& ray, std::uint32_t instance) const = 0;
};

// What surrounds a point that is shaded. All of it may be missing: then it counts as zero.
struct ShadingContext {
  const Mesh* mesh = nullptr;          // none on a sphere
  const Curves* curves = nullptr;      // only on them
  const PointCloud* points = nullptr;  // the same
  const Placement* placement = nullptr;
  const ObjectInfo* object = nullptr;
  const TransformD* world_to_camera = nullptr;  // z points where the camera looks
  const CameraWindow* window = nullptr;         // none of a panorama
  float footprint = 0;                          // how wide the ray is there, metres; 0 is unknown
  int object_index = 0, material_index = 0;
  std::uint32_t ray_kinds = 0;                               // RayKind bits
  bool is_singular_ray = false, is_translucent_ray = false;  // it left a mirror or smooth glass; a translucent shader
  const RayProbe* probe = nullptr;
  std::uint64_t random_bits = 0;  // others each time
  float least_pdf = infinity;     // of the densities of all scatterings on the way here
  int bounces = 0, diffuse_bounces = 0, glossy_bounces = 0, transmission_bounces = 0, transparent_bounces = 0;
};

class Evaluator {
 public:
  Evaluator(std::span<const Vec3f> values, const Table<Texture>& the_textures, const ShadingContext& surroundings,
            const SurfacePoint& surface_point, Vec3f to_viewer)
      : textures(the_textures), context(surroundings), point(surface_point), wo(to_viewer), values_(values) {}

  [[nodiscard]] float operator()(const NumberInput& input) const {
    if (input.operation.is_valid()) return values_[input.operation.index].x;
    if (!input.texture.is_valid()) return input.constant;
    const Rgba value = eval_texture(textures[input.texture], point.uv);
    return input.is_alpha ? value.alpha : luminance(value.color);
  }
  [[nodiscard]] Vec3f operator()(const ColorInput& input) const {
    if (input.operation.is_valid()) return values_[input.operation.index];
    return input.texture.is_valid() ? eval_texture(textures[input.texture], point.uv).color : input.constant;
  }

  // The same values at another point.
  [[nodiscard]] Evaluator at(const SurfacePoint& other) const { return {values_, textures, context, other, wo}; }

  const Table<Texture>& textures;
  const ShadingContext& context;
  const SurfacePoint& point;
  const Vec3f wo;

 private:
  std::span<const Vec3f> values_;
};

}  // namespace basicrt
