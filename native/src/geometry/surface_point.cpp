// SPDX-License-Identifier: GPL-3.0-or-later
// From hits to surface points: solved in the object's space in double precision, then taken to the world. Hits on
// triangles are handed to a kernel that solves several at once.
#include "geometry/surface_point.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "base/overloaded.h"
#include "geometry/error_bounds.h"
#include "geometry/kernels/chosen_point_kernel.h"
#include "geometry/local_point.h"

namespace basicrt {
namespace {

static_assert(offsetof(Ray, origin) == 0 && offsetof(Ray, direction) == 4 * sizeof(float));

struct WorldPoint {
  Vec3d position, error;
  Vec3d normal;          // of any length
  Vec3f shading_normal;  // the same
};

// Taking the point to the world, and taking it back as the origin of the next ray, both round.
WorldPoint translate(const LocalPoint& local, Vec3d translation) {
  return {.position = local.position + translation,
          .error = local.error + (abs(local.position) + abs(translation)) * gamma(4),
          .normal = local.normal,
          .shading_normal = Vec3f(local.shading_normal)};
}

// Normals by the inverse transpose, which keeps the outward side outward under mirroring too.
WorldPoint transform(const LocalPoint& local, const TransformD& to_world, const TransformD& to_object) {
  const Vec3d position = to_world.point(local.position);
  return {.position = position,
          .error = point_error(to_world, local.position, local.error + point_error(to_object, position, Vec3d(0))),
          .normal = to_object.transposed_vector(local.normal),
          .shading_normal = Vec3f(to_object.transposed_vector(Vec3d(Vec3f(local.shading_normal))))};
}

// The direction that `v` has, or `otherwise` where it has none.
template <class T>
Vec3<T> direction_or(Vec3<T> v, Vec3<T> otherwise) {
  const T squared = length_squared(v);
  return squared >= std::numeric_limits<T>::min() && squared <= std::numeric_limits<T>::max()
             ? v * (1 / std::sqrt(squared))
             : otherwise;
}

// On anything but a mesh.
SurfacePoint make_point(const Shape& shape, const Placement& placement, const Ray& ray, const Hit& hit) {
  const PreciseRay local_ray = placement.to_object(ray);
  const LocalPoint local =
      std::visit(Overloaded{[](const Mesh&) { return LocalPoint(); },
                            [&](const auto& other) { return local_point_on(other, local_ray, hit); }},
                 shape);
  const WorldPoint world = placement.is_translation
                               ? translate(local, placement.object_to_world.column(3))
                               : transform(local, placement.object_to_world, placement.world_to_object);
  const auto normal = Vec3f(direction_or(world.normal, {0, 0, 1}));
  return {.position = Vec3f(world.position),
          .position_error = add_float_rounding(world.position, world.error),
          .geometric_normal = normal,
          .shading_normal = direction_or(world.shading_normal, normal),
          .uv = local.uv,
          .barycentrics = std::holds_alternative<Curves>(shape) ? Vec2f{hit.u, hit.v} : local.uv,
          .t = static_cast<float>(local.t),
          .time = ray.time,
          .instance = hit.instance,
          .primitive = std::holds_alternative<Sphere>(shape) ? Hit::none : hit.primitive,
          .material_slot = 0,
          .is_backfacing = local.is_backfacing,
          .derivatives = {}};
}

// Where a triangle is that moves: its corners, then their normals.
using MovedTriangle = float[6][3];

// `moved` keeps what the request looks at of a mesh that deforms.
PointRequest make_request(const Mesh& mesh, const SurfaceHit& surface_hit, MovedTriangle& moved) {
  const Hit& hit = *surface_hit.hit;
  const Placement& placement = *surface_hit.placement;
  const std::array<std::uint32_t, 3>& corners = mesh.triangles[hit.primitive];
  PointRequest request{
      .corners = {&mesh.positions[corners[0]].x, &mesh.positions[corners[1]].x, &mesh.positions[corners[2]].x},
      .corner_normals = mesh.corner_normals.empty() ? nullptr : &mesh.corner_normals[3 * std::size_t{hit.primitive}].x,
      .ray = &surface_hit.ray->origin.x,
      .to_object = placement.world_to_object.rows[0].data(),
      .to_world = placement.object_to_world.rows[0].data(),
      .t = hit.t,
      .u = hit.u,
      .v = hit.v};
  if (!mesh.is_deforming()) return request;
  const auto put = [&](std::size_t row, Vec3f v) {
    for (std::size_t axis = 0; axis < 3; ++axis) moved[row][axis] = v[axis];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    put(i, mesh.position_at(hit.primitive, static_cast<int>(i), surface_hit.ray->time));
    request.corners[i] = moved[i];
    if (!mesh.corner_normals.empty())
      put(3 + i, mesh.corner_normal_at(3 * std::size_t{hit.primitive} + i, surface_hit.ray->time));
  }
  if (request.corner_normals != nullptr) request.corner_normals = moved[3];
  return request;
}

void write_point(SurfacePoint& point, const Mesh& mesh, const Ray& ray, const Hit& hit, const PointResult& result) {
  const auto vector = [](const float (&numbers)[3]) { return Vec3f{numbers[0], numbers[1], numbers[2]}; };
  const float u = result.barycentrics[0], v = result.barycentrics[1];
  point.position = vector(result.position);
  point.position_error = vector(result.position_error);
  point.geometric_normal = vector(result.geometric_normal);
  point.shading_normal = vector(result.shading_normal);
  point.barycentrics = point.uv = {u, v};
  // Without texture coordinates the barycentrics parametrise the triangle.
  if (!mesh.uvs.empty()) {
    const Vec2f* corners = &mesh.uvs[3 * std::size_t{hit.primitive}];
    point.uv = corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
  }
  point.t = result.t;
  point.time = ray.time;
  point.instance = hit.instance;
  point.primitive = hit.primitive;
  point.material_slot = mesh.material_slots.empty() ? 0 : mesh.material_slots[hit.primitive];
  point.is_backfacing = result.is_backfacing != 0;
  point.derivatives.reset();
}

// Hits that a kernel can take together.
struct Group {
  std::size_t count = 0;
  const SurfaceHit* hits[surface_hits_at_once];
  PointRequest requests[surface_hits_at_once];
  MovedTriangle moved[surface_hits_at_once];

  void add(const Mesh& mesh, const SurfaceHit& hit) {
    hits[count] = &hit;
    requests[count] = make_request(mesh, hit, moved[count]);
    ++count;
  }
  void solve(PointKind kind) const {
    PointResult results[surface_hits_at_once];
    chosen_point_kernel().solve(kind, requests, results, count);
    for (std::size_t i = 0; i < count; ++i)
      write_point(*hits[i]->point, std::get<Mesh>(*hits[i]->shape), *hits[i]->ray, *hits[i]->hit, results[i]);
  }
};

void make_some_points(std::span<const SurfaceHit> hits) {
  Group groups[2][2];  // by PointKind
  for (const SurfaceHit& hit : hits) {
    if (const auto* mesh = std::get_if<Mesh>(hit.shape))
      groups[hit.placement->is_translation][!mesh->corner_normals.empty()].add(*mesh, hit);
    else
      *hit.point = make_point(*hit.shape, *hit.placement, *hit.ray, *hit.hit);
  }
  for (const bool is_translation : {false, true})
    for (const bool has_normals : {false, true})
      groups[is_translation][has_normals].solve({is_translation, has_normals});
}

}  // namespace

void make_surface_points(std::span<const SurfaceHit> hits) {
  for (; hits.size() > surface_hits_at_once; hits = hits.subspan(surface_hits_at_once))
    make_some_points(hits.first(surface_hits_at_once));
  make_some_points(hits);
}

SurfacePoint make_surface_point(const Shape& shape, const Placement& placement, const Ray& ray, const Hit& hit) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) return make_point(shape, placement, ray, hit);
  MovedTriangle moved;
  const PointRequest request = make_request(*mesh, {&shape, &placement, &ray, &hit, nullptr}, moved);
  PointResult result;
  chosen_point_kernel().solve({placement.is_translation, !mesh->corner_normals.empty()}, &request, &result, 1);
  SurfacePoint point;
  write_point(point, *mesh, ray, hit, result);
  return point;
}

}  // namespace basicrt
