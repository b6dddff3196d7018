// SPDX-License-Identifier: GPL-3.0-or-later
// Two steps: a triangle by its power, then a place on it.
#include "light/mesh_emitter.h"

#include <numbers>

namespace basicrt {

MeshEmitter::MeshEmitter(const EmissiveInstance& instance, const Mesh& mesh)
    : mesh_(&mesh),
      object_to_world_(instance.object_to_world),
      motion_(instance.motion),
      is_mirrored_(instance.object_to_world.determinant() < 0),
      front_(instance.front),
      back_(instance.back) {
  std::vector<double> powers(mesh.triangles.size());
  for (std::uint32_t i = 0; i < powers.size(); ++i) {
    const double radiance = double(luminance(front_[slot(i)])) + luminance(back_[slot(i)]);
    if (radiance > 0) powers[i] = radiance * std::numbers::pi * mean_area(i);
  }
  triangles_ = DiscreteDistribution(std::move(powers));
}

std::optional<LightSample> MeshEmitter::sample(Vec3f position, float choice, Vec2f u, float time) const {
  const auto [triangle, probability, remainder] = triangles_.choose(choice);
  const PlacedTriangle placed = place(triangle, time);
  const std::optional<TrianglePlace> chosen = sample_triangle_emitter(placed.corners, Vec3d(position), u);
  if (!chosen) return std::nullopt;
  const double distance = length(chosen->offset);
  return LightSample{.wi = Vec3f(chosen->offset / distance),
                     .distance = float(distance),
                     .radiance = radiance_along(chosen->offset, triangle, placed),
                     .pdf = float(probability * chosen->pdf)};
}

double MeshEmitter::pdf(std::uint32_t triangle, Vec3f point, Vec3f position, float time) const {
  const double probability = triangles_.probability(triangle);
  if (probability == 0) return 0;
  const PlacedTriangle placed = place(triangle, time);
  const Vec3d offset = Vec3d(point) - Vec3d(position);
  if (is_black(radiance_along(offset, triangle, placed))) return 0;
  return probability * pdf_triangle_emitter(placed.corners, Vec3d(position), offset);
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

Color MeshEmitter::radiance_along(Vec3d offset, std::uint32_t triangle, const PlacedTriangle& placed) const {
  // The front is where the winding has it in object space: a mirror turns the winding round, not the front.
  const bool is_front = (dot(offset, placed.corners.cross_product()) < 0) != placed.is_mirrored;
  return is_front ? front_[slot(triangle)] : back_[slot(triangle)];
}

// Slots beyond the last have the last one's material.
std::size_t MeshEmitter::slot(std::uint32_t triangle) const {
  const std::size_t slot = mesh_->material_slots.empty() ? 0 : mesh_->material_slots[triangle];
  return std::min(slot, front_.size() - 1);
}

}  // namespace basicrt
