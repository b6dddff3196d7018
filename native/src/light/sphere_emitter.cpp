// SPDX-License-Identifier: GPL-3.0-or-later
// In object space the shape is a sphere; densities are carried over by the ratio of the solid angles.
#include "light/sphere_emitter.h"

#include <numbers>

#include "light/solid_angle.h"

namespace basicrt {
namespace {

// Knud Thomsen's approximation of an ellipsoid's surface, within 1.1 %, from lengths of the transformed axes.
double surface_area(const TransformD& object_to_world, double radius) {
  const double p = 1.6075;
  const auto axis = [&](int i) { return std::pow(radius * length(object_to_world.column(i)), p); };
  const double a = axis(0), b = axis(1), c = axis(2);
  return 4 * std::numbers::pi * std::pow((a * b + b * c + c * a) / 3, 1 / p);
}

}  // namespace

SphereEmitter::SphereEmitter(const EmissiveInstance& instance, const Sphere& sphere)
    : ball_{sphere.center, sphere.radius},
      placement_(instance.object_to_world),
      motion_(instance.motion),
      instance_(instance.instance),
      is_varying_(!instance.estimates.empty()),
      front_(instance.front.front()),
      back_(instance.back.front()),
      emitted_(is_varying_ ? instance.estimates.front()
                           : EmissiveInstance::Estimate{luminance(front_), luminance(back_)}),
      power_(std::numbers::pi * surface_area(instance.object_to_world, sphere.radius) *
             (double(emitted_.front) + emitted_.back)) {}

LightBounds SphereEmitter::bounds() const {
  LightBounds bounds;
  double area = 0;
  const std::vector<TransformD> places = motion_.empty() ? std::vector{placement_.object_to_world} : motion_;
  for (const TransformD& object_to_world : places) {
    const Vec3d center = object_to_world.point(Vec3d(ball_.center));
    const Vec3d x = object_to_world.column(0), y = object_to_world.column(1), z = object_to_world.column(2);
    const auto reach = [&](double a, double b, double c) { return std::sqrt(a * a + b * b + c * c); };
    const Vec3d half = Vec3d{reach(x.x, y.x, z.x), reach(x.y, y.y, z.y), reach(x.z, y.z, z.z)} * double(ball_.radius);
    bounds.box.extend({Vec3f(center - half), Vec3f(center + half)});
    area = std::max(area, surface_area(object_to_world, ball_.radius));
  }
  // Seen from outside, a convex body shows a quarter of its surface on average.
  const double intensity = area / 4 * double(std::max(emitted_.front, emitted_.back));
  bounds.intensity = static_cast<float>(std::min<double>(intensity, std::numeric_limits<float>::max()));
  return bounds;
}

std::optional<LightSample> SphereEmitter::sample(Vec3f position, Vec2f u, float time) const {
  const Placement placement = placement_at(time);
  const Vec3f local_position(placement.world_to_object.point(Vec3d(position)));
  const std::optional<BallSample> local = sample_ball(ball_, local_position, u);
  if (!local) return std::nullopt;
  const bool is_front = !is_inside(ball_, local_position);
  if (!((is_front ? emitted_.front : emitted_.back) > 0)) return std::nullopt;
  const Vec3d local_wi(local->wi), wi = placement.object_to_world.vector(local_wi);
  const double stretch = length(wi);
  LightSample sample{.wi = Vec3f(wi / stretch),
                     .distance = float(local->distance * stretch),
                     .radiance = is_front ? front_ : back_,
                     .pdf = local->pdf * float(solid_angle_ratio(placement.object_to_world, local_wi))};
  if (is_varying_) {
    sample.radiance = Color(1.0f);
    sample.emitter_instance = instance_;
  }
  return sample;
}

double SphereEmitter::pdf(Vec3f place, Vec3f position, float time) const {
  const Placement placement = placement_at(time);
  const Vec3f local_position(placement.world_to_object.point(Vec3d(position)));
  if (!((is_inside(ball_, local_position) ? emitted_.back : emitted_.front) > 0)) return 0;
  const Vec3d local_offset = placement.world_to_object.vector(Vec3d(place) - Vec3d(position));
  const double distance = length(local_offset);
  if (!(distance > 0)) return 0;
  return pdf_ball(ball_, local_position, distance) *
         solid_angle_ratio(placement.object_to_world, local_offset / distance);
}

}  // namespace basicrt
