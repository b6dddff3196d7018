// SPDX-License-Identifier: GPL-3.0-or-later
// Two steps: a triangle by its power, then a place on it.
#include "light/mesh_emitter.h"

#include <numbers>

namespace basicrt {

MeshEmitter::MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh)
    : mesh_(&mesh),
      object_to_world_(instance.object_to_world),
      is_mirrored_(instance.object_to_world.determinant() < 0),
      front_(instance.front),
      back_(instance.back) {
  std::vector<double> powers(mesh.triangles.size());
  for (std::uint32_t i = 0; i < powers.size(); ++i) {
    const double radiance = double(luminance(front_[slot(i)])) + luminance(back_[slot(i)]);
    if (radiance > 0) powers[i] = radiance * std::numbers::pi * world_triangle(i).area();
  }
  triangles_ = DiscreteDistribution(std::move(powers));
}

std::optional<LightSample> MeshEmitter::sample(Vec3f position, float choice, Vec2f u) const {
  const auto [triangle, probability, remainder] = triangles_.choose(choice);
  const EmitterTriangle corners = world_triangle(triangle);
  const std::optional<TrianglePlace> place = sample_triangle_emitter(corners, Vec3d(position), u);
  if (!place) return std::nullopt;
  const double distance = length(place->offset);
  return LightSample{.wi = Vec3f(place->offset / distance),
                     .distance = float(distance),
                     .radiance = radiance_along(place->offset, triangle, corners),
                     .pdf = float(probability * place->pdf)};
}

double MeshEmitter::pdf(std::uint32_t triangle, Vec3f place, Vec3f position) const {
  const double probability = triangles_.probability(triangle);
  if (probability == 0) return 0;
  const EmitterTriangle corners = world_triangle(triangle);
  const Vec3d offset = Vec3d(place) - Vec3d(position);
  if (is_black(radiance_along(offset, triangle, corners))) return 0;
  return probability * pdf_triangle_emitter(corners, Vec3d(position), offset);
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
