// SPDX-License-Identifier: GPL-3.0-or-later
// Places on a mesh that are looked at instead of what a camera sees: pictures to be laid onto the mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/describe.h"
#include "film/channels.h"
#include "integrator/integrator.h"
#include "scene/prepare.h"

namespace basicrt {

// Where a pixel of the picture lies on the mesh.
struct BakePoint {
  static constexpr std::uint32_t nowhere = ~0u;

  std::uint32_t triangle = nowhere;
  std::uint32_t seed = 0;    // of points with the same one the noise is the same
  Vec2f barycentrics;        // the shares of the triangle's second and third corner
  Vec2f change_x, change_y;  // of those from side to side of what the pixel's samples are spread over
};

struct BakeTarget {
  std::uint32_t instance = 0;  // of the scene; its shape is a mesh
  int width = 0, height = 0;
  std::vector<BakePoint> points;  // of each pixel, row 0 at the bottom
};

// What is asked of each place.
struct BakeSettings {
  PassLayout passes;
  // What counts of the mesh itself: in which ways it scatters, what it emits, and light that was scattered before.
  bool has_diffuse = true, has_glossy = true, has_transmission = true, has_emission = true;
  bool has_indirect_light = true;
  bool sees_environment = false;     // not the mesh, but what is seen from the world's origin towards the place
  bool is_seen_from_camera = false;  // else along the shading normal

  static constexpr auto fields() {
    using S = BakeSettings;
    return fields_of(field("diffuse", &S::has_diffuse, "diffuse reflection by the mesh"),
                     field("glossy", &S::has_glossy, "glossy reflection by the mesh"),
                     field("transmission", &S::has_transmission, "transmission by the mesh"),
                     field("emission", &S::has_emission, "what the mesh emits"),
                     field("indirect_light", &S::has_indirect_light, "light that other surfaces have scattered"),
                     field("environment", &S::sees_environment,
                           "not the mesh, but what is seen from the world's origin towards each place"),
                     field("from_camera", &S::is_seen_from_camera,
                           "the mesh is seen from the camera, from in front of it even so; else along its normals"));
  }
};

// Throws SceneError, naming the item, the rule and the value.
void validate(const BakeTarget& target, const BakeSettings& settings, const Scene& scene);

// A target on what has been prepared of a scene.
class Baking {
 public:
  // `prepared` is made of the scene, and both others are valid.
  Baking(BakeTarget target, const BakeSettings& settings, const Scene& scene, const PreparedScene& prepared);

  // Makes the picture that is rendered the target's, seen as the settings say.
  void apply_to(PreparedScene& prepared) const;
  [[nodiscard]] BakedParts parts() const;
  // Pixels with the same draw the same numbers.
  [[nodiscard]] Vec2i sampler_pixel(int x, int y) const { return {static_cast<int>(point(x, y).seed), 0}; }

  struct Start {
    Ray ray;
    Hit hit;  // none: the ray goes past everything
  };
  // A sample of a pixel. The first of a pixel's samples is in its middle. Nothing where the pixel is nowhere.
  [[nodiscard]] std::optional<Start> start(const PreparedScene& prepared, int x, int y, Sampler& sampler,
                                           bool is_first) const;

 private:
  // A place in the world.
  struct Place {
    Vec3f position, normal, geometric_normal;
  };

  [[nodiscard]] const BakePoint& point(int x, int y) const {
    return target_.points[static_cast<std::size_t>(y) * static_cast<std::size_t>(target_.width) + x];
  }
  [[nodiscard]] Place find_place(const PreparedScene& prepared, std::uint32_t triangle, Vec2f barycentrics,
                                 float time) const;
  [[nodiscard]] Vec3f direction_to_viewer(const PreparedScene& prepared, const Place& place) const;
  // How far it is from pixel to pixel, in the mean.
  [[nodiscard]] float mean_footprint(const PreparedScene& prepared) const;

  BakeTarget target_;  // with the indices of the prepared scene
  BakeSettings settings_;
};

}  // namespace basicrt
