// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle is sampled as it lies in the world.
#include "light/mesh_emitter.h"

#include <numbers>

namespace basicrt {

MeshEmitter::MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh)
    : mesh_(&mesh),
      object_to_world_(instance.object_to_world),
      motion_(instance.motion),
      is_mirrored_(instance.object_to_world.determinant() < 0),
      instance_(instance.instance),
      front_(instance.front),
      back_(instance.back),
      is_varying_(instance.is_varying),
      estimates_(instance.estimates) {
  for (std::uint32_t i = 0; i < triangle_count(); ++i) power_ += power(i);
}

double MeshEmitter::power(std::uint32_t triangle) const {
  const auto [front, back] = emitted(triangle);
  const double shed = double(front) + back;
  return shed > 0 ? shed * std::numbers::pi * mean_area(triangle) : 0;
}

LightBounds MeshEmitter::bounds(std::uint32_t triangle) const {
  LightBounds bounds;
  const auto [front, back] = emitted(triangle);
  if (!(front > 0 || back > 0)) return bounds;
  if (is_moving()) return moving_bounds(triangle);
  const EmitterTriangle corners = place(triangle, 0).corners;
  const Vec3d across = corners.cross_product();
  const double twice_area = length(across);
  if (!(twice_area > 0)) return bounds;
  for (const Vec3d corner : {corners.p0, corners.p1, corners.p2}) bounds.box.extend(Vec3f(corner));
  const bool is_turned = (front > 0) == is_mirrored_;
  bounds.axis = Vec3f(across * ((is_turned ? -1 : 1) / twice_area));
  bounds.cos_normals = 1;
  bounds.lowest = height_along(bounds.axis, corners.p0);
  bounds.is_two_sided = front > 0 && back > 0;
  const double intensity = std::max(front, back) * twice_area / 2;
  bounds.intensity = static_cast<float>(std::min<double>(intensity, std::numeric_limits<float>::max()));
  return bounds;
}

// What moves may face anywhere. Its corners stay within the hull of those that each of its shapes has in each of its places.
LightBounds MeshEmitter::moving_bounds(std::uint32_t triangle) const {
  LightBounds bounds{.is_two_sided = true};
  const std::size_t shapes = mesh_->motion_intervals() + 1;
  const std::vector<TransformD> places = motion_.empty() ? std::vector{object_to_world_} : motion_;
  for (std::size_t shape = 0; shape < shapes; ++shape)
    for (int i = 0; i < 3; ++i) {
      const float time = shapes == 1 ? 0 : float(shape) / float(shapes - 1);
      const Vec3d corner(mesh_->position_at(triangle, i, time));
      for (const TransformD& object_to_world : places) bounds.box.extend(Vec3f(object_to_world.point(corner)));
    }
  const auto [front, back] = emitted(triangle);
  const double intensity = double(std::max(front, back)) * mean_area(triangle);
  bounds.intensity = static_cast<float>(std::min<double>(intensity, std::numeric_limits<float>::max()));
  return bounds;
}

std::optional<LightSample> MeshEmitter::sample(std::uint32_t triangle, Vec3f position, Vec2f u, float time) const {
  const PlacedTriangle placed = place(triangle, time);
  const std::optional<TrianglePlace> chosen = sample_triangle_emitter(placed.corners, Vec3d(position), u);
  if (!chosen) return std::nullopt;
  const bool is_front = is_front_along(chosen->offset, placed);
  const auto [front, back] = emitted(triangle);
  if (!((is_front ? front : back) > 0)) return std::nullopt;
  const double distance = length(chosen->offset);
  LightSample sample{.wi = Vec3f(chosen->offset / distance), .distance = float(distance), .pdf = float(chosen->pdf)};
  const std::size_t of_slot = slot(triangle);
  if (!estimates_.empty() && is_varying_[of_slot]) {
    sample.radiance = Color(1.0f);
    sample.emitter_instance = instance_;
    sample.emitter_primitive = triangle;
  } else {
    sample.radiance = is_front ? front_[of_slot] : back_[of_slot];
  }
  return sample;
}

double MeshEmitter::pdf(std::uint32_t triangle, Vec3f point, Vec3f position, float time) const {
  const PlacedTriangle placed = place(triangle, time);
  const Vec3d offset = Vec3d(point) - Vec3d(position);
  const auto [front, back] = emitted(triangle);
  if (!((is_front_along(offset, placed) ? front : back) > 0)) return 0;
  return pdf_triangle_emitter(placed.corners, Vec3d(position), offset);
}

EmissiveInstance::Estimate MeshEmitter::emitted(std::uint32_t triangle) const {
  if (!estimates_.empty()) return estimates_[triangle];
  const std::size_t of_slot = slot(triangle);
  return {luminance(front_[of_slot]), luminance(back_[of_slot])};
}

MeshEmitter::PlacedTriangle MeshEmitter::place(std::uint32_t triangle, float time) const {
  const auto place_by = [&](const TransformD& object_to_world, bool is_mirrored) {
    const auto corner = [&](int i) { return object_to_world.point(Vec3d(mesh_->position_at(triangle, i, time))); };
    return PlacedTriangle{{corner(0), corner(1), corner(2)}, is_mirrored};
  };
  if (motion_.empty()) return place_by(object_to_world_, is_mirrored_);
  const TransformD object_to_world = transform_at(motion_, time);
  return place_by(object_to_world, object_to_world.determinant() < 0);
}

double MeshEmitter::mean_area(std::uint32_t triangle) const {
  const std::size_t intervals =
      std::max<std::size_t>(mesh_->motion_intervals(), motion_.empty() ? 0 : motion_.size() - 1);
  double sum = 0;
  for (std::size_t key = 0; key <= intervals; ++key)
    sum += place(triangle, intervals == 0 ? 0 : float(key) / float(intervals)).corners.area();
  return sum / double(intervals + 1);
}

// The front is where the winding has it in object space: a mirror turns the winding round, not the front.
bool MeshEmitter::is_front_along(Vec3d offset, const PlacedTriangle& placed) {
  return (dot(offset, placed.corners.cross_product()) < 0) != placed.is_mirrored;
}

// Slots beyond the last have the last one's material.
std::size_t MeshEmitter::slot(std::uint32_t triangle) const {
  const std::size_t slot = mesh_->material_slots.empty() ? 0 : mesh_->material_slots[triangle];
  return std::min(slot, front_.size() - 1);
}

}  // namespace basicrt
