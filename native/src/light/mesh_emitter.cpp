// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle is sampled as it lies in the world.
#include "light/mesh_emitter.h"

#include <numbers>

namespace basicrt {

MeshEmitter::MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh)
    : mesh_(&mesh),
      object_to_world_(instance.object_to_world),
      is_mirrored_(instance.object_to_world.determinant() < 0),
      front_(instance.front),
      back_(instance.back) {
  for (std::uint32_t i = 0; i < triangle_count(); ++i)
    if (const double shed = radiance(i); shed > 0) power_ += shed * std::numbers::pi * world_triangle(i).area();
}

LightBounds MeshEmitter::bounds(std::uint32_t triangle) const {
  LightBounds bounds;
  if (!(radiance(triangle) > 0)) return bounds;
  const float front = luminance(front_[slot(triangle)]), back = luminance(back_[slot(triangle)]);
  const EmitterTriangle corners = world_triangle(triangle);
  const Vec3d across = corners.cross_product();
  const double twice_area = length(across);
  if (!(twice_area > 0)) return bounds;
  for (const Vec3d corner : {corners.p0, corners.p1, corners.p2}) bounds.box.extend(Vec3f(corner));
  const bool is_turned = (front > 0) == is_mirrored_;
  bounds.axis = Vec3f(across * ((is_turned ? -1 : 1) / twice_area));
  bounds.cos_normals = 1;
  bounds.is_two_sided = front > 0 && back > 0;
  const double intensity = std::max(front, back) * twice_area / 2;
  bounds.intensity = static_cast<float>(std::min<double>(intensity, std::numeric_limits<float>::max()));
  return bounds;
}

std::optional<LightSample> MeshEmitter::sample(std::uint32_t triangle, Vec3f position, Vec2f u) const {
  const EmitterTriangle corners = world_triangle(triangle);
  const std::optional<TrianglePlace> place = sample_triangle_emitter(corners, Vec3d(position), u);
  if (!place) return std::nullopt;
  const double distance = length(place->offset);
  return LightSample{.wi = Vec3f(place->offset / distance),
                     .distance = float(distance),
                     .radiance = radiance_along(place->offset, triangle, corners),
                     .pdf = float(place->pdf)};
}

double MeshEmitter::pdf(std::uint32_t triangle, Vec3f place, Vec3f position) const {
  const EmitterTriangle corners = world_triangle(triangle);
  const Vec3d offset = Vec3d(place) - Vec3d(position);
  if (is_black(radiance_along(offset, triangle, corners))) return 0;
  return pdf_triangle_emitter(corners, Vec3d(position), offset);
}

double MeshEmitter::radiance(std::uint32_t triangle) const {
  return double(luminance(front_[slot(triangle)])) + luminance(back_[slot(triangle)]);
}

EmitterTriangle MeshEmitter::world_triangle(std::uint32_t triangle) const {
  const auto corner = [&](int i) { return object_to_world_.point(Vec3d(mesh_->position(triangle, i))); };
  return {corner(0), corner(1), corner(2)};
}

Color MeshEmitter::radiance_along(Vec3d offset, std::uint32_t triangle, const EmitterTriangle& corners) const {
  // The front is where the winding has it in object space: a mirror turns the winding round, not the front.
  const bool is_front = (dot(offset, corners.cross_product()) < 0) != is_mirrored_;
  return is_front ? front_[slot(triangle)] : back_[slot(triangle)];
}

// Slots beyond the last have the last one's material.
std::size_t MeshEmitter::slot(std::uint32_t triangle) const {
  const std::size_t slot = mesh_->material_slots.empty() ? 0 : mesh_->material_slots[triangle];
  return std::min(slot, front_.size() - 1);
}

}  // namespace basicrt
