// SPDX-License-Identifier: GPL-3.0-or-later
// From a description to what can be traced.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "base/report.h"
#include "bsdf/prepared_material.h"
#include "bvh/tracer.h"
#include "geometry/placement.h"
#include "light/light_set.h"
#include "sampling/shutter.h"
#include "scene/scene.h"

namespace basicrt {

// Read-only while rendering. Holds its own copy of all that shading needs.
struct PreparedScene {
  struct PreparedInstance {
    std::uint32_t shape = 0;
    Placement placement;
    std::vector<TransformD> motion;        // object to world over time, instead of the placement; none: it stands still
    std::vector<TransformD> adjacent;      // object to world one frame before and after, or none
    std::vector<std::uint32_t> materials;  // for each slot, an index into `materials`
    bool needs_derivatives = false;        // one of the materials does
    ObjectInfo info;
    Bounds3f box;            // of the shape, in object space, where they are needed
    bool has_inside = true;  // curves have none that a volume could fill
    bool is_holdout = false;
    bool is_shadow_catcher = false;
    float shadow_terminator_offset = 0, shadow_terminator_shading_offset = 0;
    int pass_index = 0;
    int light_group = 0;
    std::uint32_t object_id = 0, asset_id = 0;  // of mattes
    std::uint32_t visibility = ray_all;         // RayKind bits, as the tracer has them
    int receiver_set = 0;
    LinkSets lit_sets;                       // of receivers, of what it emits
    std::uint32_t shadow_kind = ray_shadow;  // RayKind bits of shadow rays towards it
  };

  CameraView view;                       // of a camera that stands still
  MovingCamera moving_camera;            // of one that moves
  std::vector<Camera> adjacent_cameras;  // one frame before and one after, or none
  std::vector<CameraView> adjacent_views;
  TransformD world_to_camera;  // when the shutter opens; z points where the camera looks
  std::optional<CameraWindow> window;
  // How wide a pixel in the middle is at the camera, and how much wider with each metre.
  float pixel_width = 0, pixel_spread = 0;
  Shutter shutter;  // for what moves
  RenderSettings settings;
  std::vector<Shape> shapes;
  std::vector<std::uint64_t> shape_revisions, instance_revisions;
  // Of the description: how many textures, materials and lights there are, and the sums of their revisions.
  struct Stamp {
    std::uint32_t size = 0;
    std::uint64_t revisions = 0;
    constexpr bool operator==(const Stamp&) const = default;
  };
  std::array<Stamp, 4> stamps;
  Environment environment;
  Table<Texture> textures;
  std::vector<PreparedMaterial> materials;  // the last one is the default
  std::vector<PreparedInstance> instances;
  Tracer tracer;
  LightSet lights;
  // For each of the description's lamps, where its light varies: what makes it.
  struct LampMaterial {
    std::uint32_t material = ~0u;
    Placement placement;  // of what the material takes for its object
  };
  std::vector<LampMaterial> lamp_materials;
  std::uint32_t world_volume = ~0u;     // the index of its material; none: space is empty
  std::vector<Bounds3f> volume_bounds;  // of each instance that is filled with a volume, at all times
  bool has_volumes = false;             // paths must know what they are in
  bool has_transparency = false;        // shadow rays must look at what they hit
  bool has_moving_shapes = false;       // something but the camera moves or deforms
  bool has_motion = false;              // rays have a time
  bool has_shadow_catchers = false;
  std::vector<LinkSets> shadow_links;  // all choices of blockers that lights make; each has its kind of shadow ray
  bool has_linked_emitters = false;    // instances that shine have one

  [[nodiscard]] const PreparedMaterial& material_of(const SurfacePoint& point) const {
    const std::vector<std::uint32_t>& slots = instances[point.instance].materials;
    return materials[slots[std::min<std::size_t>(point.material_slot, slots.size() - 1)]];
  }
  // Of the volume that begins there, or null.
  [[nodiscard]] const Medium* medium_of(const SurfacePoint& point) const {
    const std::optional<Medium>& medium = material_of(point).medium;
    return medium && instances[point.instance].has_inside ? &*medium : nullptr;
  }
};

struct PrepareOptions {
  int threads = 0;                   // 0: one for each processor; the outcome is the same for any number
  bool is_live = false;              // instances will be moved: that is quick, tracing a bit slower
  WorkProgress* progress = nullptr;  // hears how far the trees are, and can cancel them
};

// Validates, then builds the trees and the lights. `previous`, the outcome of an earlier call for the same Scene object,
// lends the trees of shapes that have not changed since; where only the places of instances have changed, and no light is
// among them, nothing but the tree over the instances is built. Throws SceneError, and
// Cancelled where `options.progress` asks for it.
[[nodiscard]] PreparedScene prepare(const Scene& scene, Report& report, PreparedScene previous = {},
                                    PrepareOptions options = {});

// Another camera and another way to make the picture: all that a view changes without a tree or a light being touched.
// What builds trees stays as it was prepared. Both must be valid.
void apply_view(PreparedScene& prepared, const Camera& camera, const RenderSettings& settings);

// The same as prepare() on a thread of its own, while this one calls `watch` with the fraction done, several times in 100 ms. Where
// that returns false the work ends and Cancelled is thrown; what it throws ends the work too.
[[nodiscard]] PreparedScene prepare_watched(const Scene& scene, Report& report, int threads,
                                            const std::function<bool(double)>& watch);

}  // namespace basicrt
