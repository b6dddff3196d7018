// SPDX-License-Identifier: GPL-3.0-or-later
// From a pixel of a mesh's picture to the ray that sees its place on the mesh.
#include "integrator/baking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/validate_fields.h"

namespace basicrt {
namespace {

std::string at(const BakeTarget& target, const char* name, std::size_t index) {
  const auto width = static_cast<std::size_t>(target.width);
  return std::string("BakeTarget.") + name + "[" + std::to_string(index / width) + ", " +
         std::to_string(index % width) + "]";
}

bool is_inside(Vec2f barycentrics) {
  return barycentrics.x >= 0 && barycentrics.y >= 0 && barycentrics.x + barycentrics.y <= 1;
}

// Somewhere in the pixel, `place` in [0, 1)^2, but not outside of the triangle: what is next to it is not known here.
Vec2f spread(const BakePoint& point, Vec2f place) {
  Vec2f offset = point.change_x * (place.x - 0.5f) + point.change_y * (place.y - 0.5f);
  for (int i = 0; i < 8; ++i, offset = offset * 0.5f)
    if (is_inside(point.barycentrics + offset)) return point.barycentrics + offset;
  return point.barycentrics;
}

// A little towards the middle of the triangle where that is needed not to be on its edge: rays would slip along others'.
Vec2f keep_off_edges(Vec2f barycentrics) {
  constexpr float share = 1e-4f;
  const auto clamped = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
  Vec2f inside{clamped(barycentrics.x), clamped(barycentrics.y)};
  if (const float sum = inside.x + inside.y; sum > 1) inside = inside * (1 / sum);
  return inside + (Vec2f{1.0f / 3, 1.0f / 3} - inside) * share;
}

// For each of a mesh's triangles, its index among those that can be traced.
std::vector<std::uint32_t> find_prepared_triangles(const Mesh& mesh) {
  std::vector<std::uint32_t> indices(mesh.triangles.size(), BakePoint::nowhere);
  std::uint32_t next = 0;
  for (const std::uint32_t triangle : usable_triangles(mesh)) indices[triangle] = next++;
  return indices;
}

// Instances of empty meshes are left out of what is prepared.
std::uint32_t find_prepared_instance(const Scene& scene, const PreparedScene& prepared, std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t i = 0; i < index; ++i)
    if (!is_empty(prepared.shapes[scene.instances[i].shape.index])) ++result;
  return result;
}

}  // namespace

void validate(const BakeTarget& target, const BakeSettings& settings, const Scene& scene) {
  if (target.width < 1 || target.height < 1)
    throw SceneError("BakeTarget.triangles",
                     "must have pixels, is " + std::to_string(target.height) + " x " + std::to_string(target.width));
  if (target.instance >= scene.instances.size())
    throw SceneError("BakeTarget.instance", "is " + std::to_string(target.instance) + ", but the scene has " +
                                                std::to_string(scene.instances.size()) + " instances");
  const Id<Shape> shape = scene.instances[target.instance].shape;
  const Mesh* mesh = shape.index < scene.shapes.size() ? std::get_if<Mesh>(&scene.shapes[shape]) : nullptr;
  if (mesh == nullptr) throw SceneError("BakeTarget.instance", "must be of a mesh, is of another shape");
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    const BakePoint& point = target.points[i];
    if (point.triangle != BakePoint::nowhere && point.triangle >= mesh->triangles.size())
      throw SceneError(at(target, "triangles", i), "is " + std::to_string(point.triangle) + ", but the mesh has " +
                                                       std::to_string(mesh->triangles.size()) + " triangles");
  }
  if (scene.settings.integrator != IntegratorKind::path)
    throw SceneError("settings.integrator", "must be path for baking");
  if (settings.is_seen_from_camera && !scene.camera)
    throw SceneError("BakeSettings.from_camera", "the scene has no camera");
}

Baking::Baking(BakeTarget target, const BakeSettings& settings, const Scene& scene, const PreparedScene& prepared)
    : target_(std::move(target)), settings_(settings) {
  const auto& mesh = std::get<Mesh>(scene.shapes[scene.instances[target_.instance].shape]);
  target_.instance = find_prepared_instance(scene, prepared, target_.instance);
  const std::vector<std::uint32_t> triangles = find_prepared_triangles(mesh);
  for (BakePoint& point : target_.points)
    if (point.triangle != BakePoint::nowhere) point.triangle = triangles[point.triangle];
}

void Baking::apply_to(PreparedScene& prepared) const {
  RenderSettings& settings = prepared.settings;
  settings.width = target_.width;
  settings.height = target_.height;
  settings.border_x = settings.border_y = settings.border_width = settings.border_height = 0;
  settings.samples_from = settings.samples_to = 0;
  settings.passes = settings_.passes;
  settings.is_film_transparent = false;
  if (!settings_.has_indirect_light) settings.max_bounces = 0;
  prepared.pixel_width = mean_footprint(prepared);
  prepared.pixel_spread = 0;
}

BakedParts Baking::parts() const {
  std::uint32_t kinds = 0;
  if (settings_.has_diffuse) kinds |= ray_diffuse;
  if (settings_.has_glossy) kinds |= ray_glossy;
  if (settings_.has_transmission) kinds |= ray_transmission;
  return {kinds, settings_.has_emission};
}

std::optional<Baking::Start> Baking::start(const PreparedScene& prepared, int x, int y, Sampler& sampler,
                                           bool is_first) const {
  const BakePoint& pixel = point(x, y);
  if (pixel.triangle == BakePoint::nowhere) return std::nullopt;
  const Vec2f drawn = sampler.next_2d();
  const Vec2f barycentrics = keep_off_edges(spread(pixel, is_first ? Vec2f{0.5f, 0.5f} : drawn));
  const float time = prepared.has_motion ? prepared.shutter.sample(sampler.next_1d()) : 0.0f;
  const Place place = find_place(prepared, pixel.triangle, barycentrics, time);
  if (settings_.sees_environment) {
    const float distance = length(place.position);
    if (!(distance > 0)) return std::nullopt;
    return Start{{.direction = place.position * (1 / distance), .kinds = ray_camera, .time = time}, {}};
  }
  // From just above the surface: nothing is in between, and the ray begins in what surrounds the mesh.
  const Vec3f wo = direction_to_viewer(prepared, place);
  const float reach = 1e-4f * std::max(max_component(abs(place.position)), 1.0f);
  const Ray ray{.origin = place.position + wo * reach, .direction = -wo, .kinds = ray_camera, .time = time};
  return Start{ray, {reach, target_.instance, pixel.triangle, barycentrics.x, barycentrics.y}};
}

Baking::Place Baking::find_place(const PreparedScene& prepared, std::uint32_t triangle, Vec2f barycentrics,
                                 float time) const {
  const PreparedScene::PreparedInstance& instance = prepared.instances[target_.instance];
  const auto& mesh = std::get<Mesh>(prepared.shapes[instance.shape]);
  const Placement placement =
      instance.motion.empty() ? instance.placement : Placement(transform_at(instance.motion, time));
  const std::array<double, 3> shares{1.0 - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y};
  std::array<Vec3d, 3> corners;
  Vec3d position(0.0), normal(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = Vec3d(mesh.position_at(triangle, static_cast<int>(i), time));
    position += corners[i] * shares[i];
    if (!mesh.corner_normals.empty())
      normal += Vec3d(mesh.corner_normal_at(3 * std::size_t{triangle} + i, time)) * shares[i];
  }
  const auto to_world = [&](Vec3d local) { return normalize(placement.world_to_object.transposed_vector(local)); };
  const Vec3d geometric = to_world(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const Vec3d smooth = length_squared(normal) > 0 ? to_world(normal) : geometric;
  return {.position = Vec3f(placement.object_to_world.point(position)),
          .normal = Vec3f(dot(smooth, geometric) > 0 ? smooth : geometric),
          .geometric_normal = Vec3f(geometric)};
}

// A viewer who is behind the surface or sees it at a grazing angle is moved in front of it: something is to be seen
// everywhere. As Cycles does, so that pictures are alike.
Vec3f Baking::direction_to_viewer(const PreparedScene& prepared, const Place& place) const {
  constexpr float least_seen_cosine = 0.2f, least_geometric_cosine = 0.01f;
  Vec3f wo = place.normal;
  if (settings_.is_seen_from_camera) {
    const TransformD to_world = inverse(prepared.world_to_camera);
    const bool is_parallel = prepared.window && !prepared.window->is_perspective;
    wo = normalize(is_parallel ? -Vec3f(to_world.column(2)) : Vec3f(to_world.column(3)) - place.position);
    const float cosine = dot(wo, place.normal);
    if (cosine < least_seen_cosine) wo = normalize(wo + place.normal * (least_seen_cosine - cosine));
    if (cosine < 0) wo = normalize(wo * (1 + cosine) - place.normal * cosine);
  }
  const float geometric_cosine = dot(wo, place.geometric_normal);
  if (geometric_cosine >= least_geometric_cosine) return wo;
  return normalize(wo + place.geometric_normal * (least_geometric_cosine - geometric_cosine));
}

// Where pixels have no size, as those of vertices, a thousandth of the mesh.
float Baking::mean_footprint(const PreparedScene& prepared) const {
  const PreparedScene::PreparedInstance& instance = prepared.instances[target_.instance];
  const auto& mesh = std::get<Mesh>(prepared.shapes[instance.shape]);
  const TransformD to_world = instance.motion.empty() ? instance.placement.object_to_world : instance.motion.front();
  double sum = 0, count = 0;
  for (const BakePoint& point : target_.points) {
    if (point.triangle == BakePoint::nowhere) continue;
    const Vec3f corner = mesh.position(point.triangle, 0);
    const Vec3f edge1 = to_world.vector(mesh.position(point.triangle, 1) - corner);
    const Vec3f edge2 = to_world.vector(mesh.position(point.triangle, 2) - corner);
    const auto change = [&](Vec2f shares) { return length(edge1 * shares.x + edge2 * shares.y); };
    const float size = (change(point.change_x) + change(point.change_y)) * 0.5f;
    if (!(size > 0)) continue;
    sum += size;
    ++count;
  }
  if (count > 0) return static_cast<float>(sum / count);
  const Bounds3f box = transform_bounds(Transform(to_world), bounds(mesh));
  return length(box.upper - box.lower) * 1e-3f;
}

}  // namespace basicrt
