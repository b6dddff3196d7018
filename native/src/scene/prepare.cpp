// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the trees and the lights of a scene.
#include "scene/prepare.h"

#include <chrono>
#include <cstddef>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "base/overloaded.h"
#include "base/parallel_for.h"
#include "bsdf/bsdf.h"
#include "film/cryptomatte.h"
#include "scene/displace.h"
#include "scene/emission_estimate.h"
#include "scene/lamp_estimate.h"
#include "scene/mattes.h"
#include "scene/shadow_links.h"

namespace basicrt {
namespace {

// How often prepare_watched() calls.
constexpr std::chrono::milliseconds watch_interval{40};
// Shapes with fewer triangles, points or segments are built side by side, each by one thread.
constexpr std::size_t large_shape = 32768;

BvhConfig bvh_config(const RenderSettings& settings, const PrepareOptions& options) {
  BvhConfig config;
  config.builder = settings.bvh_builder;
  config.merges_small_meshes = !options.is_live;
  config.threads = options.threads;
  config.progress = options.progress;
  return config;
}

// Of triangles and the like.
std::size_t primitive_count(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Mesh& mesh) { return mesh.triangles.size(); }, [](const Sphere&) { return std::size_t{0}; },
                 [](const PointCloud& cloud) { return cloud.positions.size(); },
                 [](const Curves& curves) { return curves.points.size(); }},
      shape);
}

// Of all its trees.
std::size_t tree_primitive_count(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return primitive_count(shape) * (mesh && mesh->is_deforming() ? mesh->motion_intervals() : 1);
}

// Large shapes one by one with all threads, then the small ones side by side.
void build_trees(const std::vector<Shape>& shapes, const std::vector<std::uint32_t>& to_build, const BvhConfig& config,
                 std::vector<ShapeTree>& trees) {
  if (config.progress)
    for (const std::uint32_t i : to_build) config.progress->expect(build_work(tree_primitive_count(shapes[i])));
  std::vector<std::uint32_t> small;
  for (const std::uint32_t i : to_build) {
    if (primitive_count(shapes[i]) < large_shape)
      small.push_back(i);
    else
      trees[i] = build_shape_tree(shapes[i], config);
  }
  BvhConfig alone = config;
  alone.threads = 1;
  parallel_for(small.size(), config.threads,
               [&](std::size_t i) { trees[small[i]] = build_shape_tree(shapes[small[i]], alone); });
}

// The shape as it can be traced: perhaps an empty mesh.
Shape usable_shape(const Shape& shape, const std::string& item, Report& report) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh ? Shape(remove_degenerate_triangles(*mesh, item, report)) : shape;
}

std::vector<bool> find_instanced_shapes(const Scene& scene) {
  std::vector<bool> is_instanced(scene.shapes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) is_instanced[scene.instances[i].shape.index] = true;
  return is_instanced;
}

struct ShapeTrees {
  std::vector<ShapeTree> trees;
  std::vector<std::uint32_t> to_build;  // those that aren't yet there
};

// Copies the shapes, taking over from `previous` what has not changed, and its trees. An empty mesh keeps its place and is
// never instanced: whoever left out its instances (the reader of scene files) has told of it already.
ShapeTrees prepare_shapes(const Scene& scene, Report& report, PreparedScene& previous, PreparedScene& prepared,
                          const BvhConfig& config) {
  const bool is_same_builder = previous.settings.bvh_builder == scene.settings.bvh_builder;
  const std::vector<bool> is_instanced = find_instanced_shapes(scene);
  std::vector<ShapeTree> previous_trees = previous.tracer.take_trees();

  ShapeTrees shapes{std::vector<ShapeTree>(scene.shapes.size()), {}};
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const std::uint64_t revision = scene.shapes.revision(Id<Shape>{i});
    prepared.shape_revisions.push_back(revision);
    const bool is_known = i < std::min(previous_trees.size(), previous.shape_revisions.size());
    if (is_same_builder && is_known && previous.shape_revisions[i] == revision) {
      prepared.shapes.push_back(std::move(previous.shapes[i]));
      shapes.trees[i] = std::move(previous_trees[i]);
      continue;
    }
    if (config.progress) config.progress->advance(0);  // copying takes time too
    const std::string item = "shapes[" + std::to_string(i) + "]";
    prepared.shapes.push_back(usable_shape(scene.shapes[i], item, report));
    if (is_instanced[i] && is_empty(prepared.shapes.back()))
      report.warn(item + (std::holds_alternative<Mesh>(prepared.shapes.back())
                              ? ": the mesh has no triangles and is left out"
                              : ": has nothing that can be hit and is left out"));
    shapes.to_build.push_back(i);
  }
  return shapes;
}

// Gives instances whose materials displace them a mesh of their own. Those of the same mesh and materials share one, which
// is the first one's.
void displace_meshes(PreparedScene& prepared, ShapeTrees& shapes, int threads) {
  std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> displaced;
  std::vector<std::uint32_t> shape_of;  // each instance's
  for (std::uint32_t i = 0; i < prepared.instances.size(); ++i) {
    const PreparedScene::PreparedInstance& instance = prepared.instances[i];
    shape_of.push_back(instance.shape);
    if (!is_displaced(prepared, instance)) continue;
    const auto next = static_cast<std::uint32_t>(prepared.shapes.size());
    const auto [known, is_new] = displaced.try_emplace({instance.shape, instance.materials}, next);
    shape_of.back() = known->second;
    if (!is_new) continue;
    prepared.shapes.emplace_back(displaced_mesh(prepared, i, threads));
    shapes.to_build.push_back(next);
  }
  shapes.trees.resize(prepared.shapes.size());
  for (std::size_t i = 0; i < shape_of.size(); ++i) {
    PreparedScene::PreparedInstance& instance = prepared.instances[i];
    if (instance.shape == shape_of[i]) continue;
    instance.shape = shape_of[i];
    if (instance.needs_derivatives) instance.box = bounds(prepared.shapes[instance.shape]);
  }
}

Material default_material() {
  Material material;
  material.name = "default";
  material.surface = material.add(DiffuseShader{.color = Color(0.8f), .is_two_sided = true});
  return material;
}

// For each slot, the index of its material among the prepared ones; the last of those is the default.
std::vector<std::uint32_t> resolve_materials(const Instance& instance, std::uint32_t default_index) {
  std::vector<std::uint32_t> slots;
  for (const Id<Material> id : instance.materials) slots.push_back(id.is_valid() ? id.index : default_index);
  if (slots.empty()) slots.push_back(default_index);
  return slots;
}

// All keys, or none.
std::vector<TransformD> motion_of(const Instance& instance) {
  std::vector<TransformD> keys;
  if (instance.motion_transforms.empty()) return keys;
  keys.emplace_back(instance.object_to_world);
  for (const Transform& key : instance.motion_transforms) keys.emplace_back(key);
  return keys;
}

std::vector<TransformD> adjacent_of(const Instance& instance) {
  std::vector<TransformD> transforms;
  for (const Transform& transform : instance.adjacent_transforms) transforms.emplace_back(transform);
  return transforms;
}

// What it chooses itself, and what comes of what it is.
std::uint32_t traced_visibility(const Instance& instance, const PreparedScene& scene, bool is_linked_emitter) {
  std::uint32_t kinds = instance.visibility & ray_own_choice;
  if (instance.is_shadow_catcher) kinds |= ray_catcher;
  if (is_linked_emitter) kinds |= ray_linked_emitter;
  if ((kinds & ray_shadow) == 0) return kinds;
  for (std::size_t i = 0; i < scene.shadow_links.size(); ++i)
    if (scene.shadow_links[i].has(instance.blocker_set)) kinds |= shadow_link_kind(static_cast<int>(i));
  return kinds;
}

// Of the rays towards a light that those blockers dim.
std::uint32_t shadow_kind(const PreparedScene& scene, LinkSets blockers) {
  const auto link = std::ranges::find(scene.shadow_links, blockers);
  return link == scene.shadow_links.end() ? std::uint32_t{ray_shadow}
                                          : shadow_link_kind(static_cast<int>(link - scene.shadow_links.begin()));
}

// None where the surface is as smooth as its normals.
float shadow_terminator_offset(const Scene& scene, const Instance& instance) {
  const auto* mesh = std::get_if<Mesh>(&scene.shapes[instance.shape]);
  return mesh && !mesh->corner_normals.empty() ? instance.shadow_terminator_offset : 0;
}

bool shines(const PreparedScene& prepared, const PreparedScene::PreparedInstance& instance) {
  return std::ranges::any_of(instance.materials,
                             [&](std::uint32_t index) { return is_emissive(prepared.materials[index].material); });
}

// The shapes and materials must be there.
PreparedScene::PreparedInstance prepare_instance(const Scene& scene, const PreparedScene& prepared,
                                                 const Instance& instance) {
  const auto default_index = static_cast<std::uint32_t>(prepared.materials.size() - 1);
  PreparedScene::PreparedInstance result{.shape = instance.shape.index,
                                         .placement = Placement{TransformD(instance.object_to_world)},
                                         .motion = motion_of(instance),
                                         .adjacent = adjacent_of(instance),
                                         .materials = resolve_materials(instance, default_index),
                                         .info = instance.info,
                                         .has_inside = !std::holds_alternative<Curves>(scene.shapes[instance.shape]),
                                         .is_holdout = instance.is_holdout,
                                         .is_shadow_catcher = instance.is_shadow_catcher,
                                         .shadow_terminator_offset = shadow_terminator_offset(scene, instance),
                                         .shadow_terminator_shading_offset = instance.shadow_terminator_shading_offset,
                                         .pass_index = instance.pass_index,
                                         .light_group = instance.light_group,
                                         .object_id = matte_id(instance.name),
                                         .asset_id = matte_id(asset_name(instance)),
                                         .receiver_set = instance.receiver_set,
                                         .lit_sets = instance.lit_sets};
  for (const std::uint32_t index : result.materials) {
    const PreparedMaterial& material = prepared.materials[index];
    result.needs_derivatives = result.needs_derivatives || needs_derivatives(material.material) ||
                               (material.aovs && needs_derivatives(*material.aovs)) ||
                               (material.displacement && needs_derivatives(*material.displacement));
  }
  if (result.needs_derivatives) result.box = bounds(prepared.shapes[result.shape]);
  if (shines(prepared, result)) result.shadow_kind = shadow_kind(prepared, instance.blocker_sets);
  result.visibility = traced_visibility(instance, prepared, result.shadow_kind != ray_shadow);
  return result;
}

TracedInstance traced_instance(const PreparedScene::PreparedInstance& prepared) {
  return {.shape = prepared.shape,
          .object_to_world = prepared.placement.object_to_world,
          .world_to_object = prepared.placement.world_to_object,
          .visibility = prepared.visibility,
          .motion = prepared.motion};
}

template <class T>
PreparedScene::Stamp stamp(const Table<T>& table) {
  PreparedScene::Stamp result{.size = table.size()};
  for (std::uint32_t i = 0; i < table.size(); ++i) result.revisions += table.revision(Id<T>{i});
  return result;
}

// Of all tables but the instances'. Revisions only grow, so that equal sums are those of equal tables.
std::array<PreparedScene::Stamp, 4> stamps_of(const Scene& scene) {
  return {stamp(scene.shapes), stamp(scene.textures), stamp(scene.materials), stamp(scene.lights)};
}

// All that a struct describes.
template <class T>
bool is_same_description(const T& a, const T& b) {
  return T::fields()([&](const auto&... field) { return (... && (a.*field.member == b.*field.member)); });
}

bool is_same_layer(const EnvironmentLayer& a, const EnvironmentLayer& b) {
  if (a.sky.has_value() != b.sky.has_value() || !a.image.has_same_pixels(b.image)) return false;
  const auto is_same_sky = [&](const auto& sky) {
    const auto* other = std::get_if<std::decay_t<decltype(sky)>>(&*b.sky);
    return other != nullptr && is_same_description(sky, *other);
  };
  return is_same_description(a, b) && (!a.sky || std::visit(is_same_sky, *a.sky));
}

bool is_same_environment(const Environment& a, const Environment& b) {
  return is_same_description(a, b) && std::ranges::equal(a.layers, b.layers, is_same_layer);
}

// What an instance must have as before for lights and volumes to be what they were.
bool shines_or_scatters(const PreparedScene& prepared, const PreparedScene::PreparedInstance& instance) {
  return shines(prepared, instance) || std::ranges::any_of(instance.materials, [&](std::uint32_t index) {
           return prepared.materials[index].medium.has_value();
         });
}

// Puts instances that were written since where they are now; false, with nothing changed that counts, where more than
// that has to be prepared again.
bool move_instances(const Scene& scene, PreparedScene& prepared, const BvhConfig& config) {
  if (prepared.instances.size() != scene.instances.size() ||
      prepared.settings.bvh_builder != scene.settings.bvh_builder || prepared.stamps != stamps_of(scene) ||
      prepared.world_volume != scene.world_volume.index ||
      !is_same_environment(prepared.environment, scene.environment) || !scene.camera)
    return false;
  std::vector<Tracer::Move> moves;
  std::vector<PreparedScene::PreparedInstance> moved;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (prepared.instance_revisions[i] == scene.instances.revision(Id<Instance>{i})) continue;
    validate_instance(scene, Id<Instance>{i});
    const Instance& instance = scene.instances[i];
    if (is_empty(prepared.shapes[instance.shape.index])) return false;
    moved.push_back(prepare_instance(scene, prepared, instance));
    if (shines_or_scatters(prepared, moved.back()) || shines_or_scatters(prepared, prepared.instances[i]) ||
        is_displaced(prepared, moved.back()) || moved.back().shape != prepared.instances[i].shape ||
        moved.back().is_shadow_catcher != prepared.instances[i].is_shadow_catcher)
      return false;
    moves.push_back({i, traced_instance(moved.back())});
  }
  const Bounds3f bounds_before = prepared.tracer.bounds();
  if (!moves.empty() && !prepared.tracer.move_instances(moves, config)) return false;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    prepared.instances[moves[k].index] = std::move(moved[k]);
    prepared.instance_revisions[moves[k].index] = scene.instances.revision(Id<Instance>{moves[k].index});
  }
  const Bounds3f bounds_now = prepared.tracer.bounds();
  // Distant lights count with how large the scene is.
  return bounds_now.lower == bounds_before.lower && bounds_now.upper == bounds_before.upper;
}

// Where the volumes are, and whether there are any.
void find_volumes(const Scene& scene, PreparedScene& prepared) {
  const auto has_medium = [&](std::uint32_t material) { return prepared.materials[material].medium.has_value(); };
  for (const PreparedScene::PreparedInstance& instance : prepared.instances) {
    if (!instance.has_inside || !std::ranges::any_of(instance.materials, has_medium)) continue;
    const Bounds3f local = bounds(prepared.shapes[instance.shape]);
    Bounds3f world;
    const auto extend_by = [&](const TransformD& object_to_world) {
      world.extend(transform_bounds(Transform(object_to_world), local));
    };
    if (instance.motion.empty()) extend_by(instance.placement.object_to_world);
    for (const TransformD& key : instance.motion) extend_by(key);
    prepared.volume_bounds.push_back(world);
  }
  if (scene.world_volume.is_valid() && has_medium(scene.world_volume.index))
    prepared.world_volume = scene.world_volume.index;
  prepared.has_volumes = !prepared.volume_bounds.empty() || prepared.world_volume != Id<Material>::none;
}

// Points and curves that shine are not among the lights: what runs into them gathers all that they emit.
bool is_sampled_as_light(const Shape& shape) {
  return std::holds_alternative<Mesh>(shape) || std::holds_alternative<Sphere>(shape);
}

std::optional<EmissiveInstance> find_emission(const PreparedScene& scene, std::uint32_t index, int threads) {
  const PreparedScene::PreparedInstance& instance = scene.instances[index];
  if (!is_sampled_as_light(scene.shapes[instance.shape])) return std::nullopt;
  EmissiveInstance result{.instance = index,
                          .light_group = instance.light_group,
                          .lit_sets = instance.lit_sets,
                          .shadow_kind = instance.shadow_kind,
                          .shape = &scene.shapes[instance.shape],
                          .object_to_world = instance.placement.object_to_world,
                          .world_to_object = instance.placement.world_to_object,
                          .motion = instance.motion,
                          .front = {},
                          .back = {}};
  bool shines = false, varies = false;
  for (const std::uint32_t material : instance.materials) {
    const Material& described = scene.materials[material].material;
    shines = shines || is_emissive(described);
    result.front.push_back(emitted_radiance(described, SurfaceSide::front));
    result.back.push_back(emitted_radiance(described, SurfaceSide::back));
    const bool is_varying =
        has_varying_emission(described, SurfaceSide::front) || has_varying_emission(described, SurfaceSide::back);
    result.is_varying.push_back(is_varying);
    varies = varies || is_varying;
  }
  if (!shines) return std::nullopt;
  if (varies) result.estimates = estimate_emission(scene, index, threads);
  return result;
}

// What a lamp shines with, whatever its kind.
Color& light_of(Light& light) {
  return std::visit(Overloaded{[](SunLight& sun) -> Color& { return sun.irradiance; },
                               [](AreaLight& area) -> Color& { return area.radiance; },
                               [](auto& ball) -> Color& { return ball.intensity; }},
                    light);
}

// A material that is the same everywhere is only a factor; the others are asked about each ray of light.
std::vector<Lamp> prepare_lamps(const Scene& scene, PreparedScene& prepared, int threads) {
  std::vector<Lamp> lamps;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    Light light = scene.lights[i];
    PreparedScene::LampMaterial& of_lamp = prepared.lamp_materials.emplace_back();
    const auto prepare_material = [&](auto& of_kind) {
      if (!of_kind.material.is_valid()) return;
      const Material& material = prepared.materials[of_kind.material.index].material;
      if (has_varying_emission(material, SurfaceSide::front)) {
        of_lamp = {of_kind.material.index, Placement{TransformD(of_kind.object_to_world)}};
        return;
      }
      of_kind.material = {};
      light_of(light) *= emitted_radiance(material, SurfaceSide::front);
    };
    std::visit(prepare_material, light);
    Lamp& lamp = lamps.emplace_back(light);
    lamp.shadow_kind = shadow_kind(prepared, lamp.blocker_sets);
  }
  parallel_for(lamps.size(), threads, [&](std::size_t i) {
    if (lamps[i].is_varying)
      lamps[i].estimate = estimate_lamp(prepared, prepared.lamp_materials[i], lamps[i], prepared.tracer.bounds());
  });
  return lamps;
}

void set_window(PreparedScene& prepared, const Camera& camera, Vec2i film_size) {
  prepared.window.reset();
  const auto set = [&](const CameraBase& flat, bool is_perspective) {
    prepared.window = CameraWindow{flat.window_min, flat.window_max - flat.window_min, is_perspective};
  };
  if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) set(*perspective, true);
  if (const auto* orthographic = std::get_if<OrthographicCamera>(&camera)) set(*orthographic, false);
  const Vec2f middle{static_cast<float>(film_size.x) * 0.5f, static_cast<float>(film_size.y) * 0.5f};
  const RayDifferentials change = prepared.view.differentials(middle);
  prepared.pixel_width = (length(change.origin_dx) + length(change.origin_dy)) * 0.5f;
  prepared.pixel_spread = (length(change.direction_dx) + length(change.direction_dy)) * 0.5f;
}

}  // namespace

PreparedScene prepare(const Scene& scene, Report& report, PreparedScene previous, PrepareOptions options) {
  const BvhConfig config = bvh_config(scene.settings, options);
  if (!previous.instances.empty() && move_instances(scene, previous, config)) {
    validate_views(scene);
    previous.adjacent_cameras = scene.adjacent_cameras;
    apply_view(previous, *scene.camera, scene.settings);
    return previous;
  }
  validate(scene);

  PreparedScene prepared;
  prepared.settings.bvh_builder = scene.settings.bvh_builder;
  prepared.stamps = stamps_of(scene);
  prepared.environment = scene.environment;
  prepared.textures = scene.textures;
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
    prepared.materials.emplace_back(scene.materials[i], prepared.textures);
  prepared.materials.emplace_back(default_material(), prepared.textures);
  for (PreparedMaterial& prepared_material : prepared.materials)
    prepared_material.matte_id = matte_id(prepared_material.material.name);

  prepared.shadow_links = find_shadow_links(scene);
  ShapeTrees shapes = prepare_shapes(scene, report, previous, prepared, config);

  prepared.instances.reserve(scene.instances.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    prepared.instance_revisions.push_back(scene.instances.revision(Id<Instance>{i}));
    prepared.has_shadow_catchers = prepared.has_shadow_catchers || instance.is_shadow_catcher;
    if (is_empty(prepared.shapes[instance.shape.index])) continue;
    prepared.instances.push_back(prepare_instance(scene, prepared, instance));
    const PreparedScene::PreparedInstance& added = prepared.instances.back();
    const auto* mesh = std::get_if<Mesh>(&prepared.shapes[instance.shape.index]);
    prepared.has_moving_shapes = prepared.has_moving_shapes || !added.motion.empty() || (mesh && mesh->is_deforming());
    prepared.has_linked_emitters = prepared.has_linked_emitters || added.shadow_kind != ray_shadow;
  }
  for (const PreparedMaterial& prepared_material : prepared.materials)
    prepared.has_transparency = prepared.has_transparency || is_transparent(prepared_material.material);
  prepared.adjacent_cameras = scene.adjacent_cameras;
  apply_view(prepared, *scene.camera, scene.settings);
  displace_meshes(prepared, shapes, options.threads);
  find_volumes(scene, prepared);
  build_trees(prepared.shapes, shapes.to_build, config, shapes.trees);
  std::vector<TracedInstance> traced;
  traced.reserve(prepared.instances.size());
  for (const PreparedScene::PreparedInstance& instance : prepared.instances)
    traced.push_back(traced_instance(instance));
  prepared.tracer = Tracer(std::move(shapes.trees), std::move(traced), config);

  const std::vector<Lamp> lamps = prepare_lamps(scene, prepared, options.threads);
  std::vector<EmissiveInstance> emitters;
  for (std::uint32_t i = 0; i < prepared.instances.size(); ++i)
    if (std::optional<EmissiveInstance> emitter = find_emission(prepared, i, options.threads))
      emitters.push_back(std::move(*emitter));
  prepared.lights = LightSet(lamps, emitters, EnvironmentSampler(scene.environment, options.threads),
                             prepared.tracer.bounds(), prepared.has_volumes);
  return prepared;
}

void apply_view(PreparedScene& prepared, const Camera& camera, const RenderSettings& settings) {
  const Vec2i film_size{settings.width, settings.height};
  prepared.view = CameraView(camera, film_size);
  prepared.moving_camera = MovingCamera(camera, film_size);
  prepared.adjacent_views.clear();
  for (const Camera& adjacent : prepared.adjacent_cameras) prepared.adjacent_views.emplace_back(adjacent, film_size);
  prepared.has_motion = prepared.has_moving_shapes || prepared.moving_camera.is_moving();
  prepared.world_to_camera = prepared.view.world_to_camera();
  set_window(prepared, camera, film_size);
  prepared.shutter = Shutter(settings.shutter_curve);
  const BvhBuilder builder = prepared.settings.bvh_builder;
  prepared.settings = settings;
  prepared.settings.bvh_builder = builder;
}

PreparedScene prepare_watched(const Scene& scene, Report& report, int threads,
                              const std::function<bool(double)>& watch) {
  WorkProgress progress;
  const auto work = [&] { return prepare(scene, report, {}, {.threads = threads, .progress = &progress}); };
  std::future<PreparedScene> prepared;
  try {
    prepared = std::async(std::launch::async, work);
  } catch (const std::system_error&) {
    return work();  // the system has no more threads: nobody can watch
  }
  try {
    while (prepared.wait_for(watch_interval) != std::future_status::ready)
      if (!watch(progress.fraction())) progress.cancel();
  } catch (...) {
    progress.cancel();
    prepared.wait();
    throw;
  }
  return prepared.get();
}

}  // namespace basicrt
