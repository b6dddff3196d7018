// SPDX-License-Identifier: GPL-3.0-or-later
// Seen from a position, a ball fills a cone of directions.
#include "light/ball.h"

#include "light/solid_angle.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {
namespace {

// Rounding must not put a place on a sphere's surface in front of that same surface, which would then light itself.
// So whoever is this near to it, by the square of the distance over that of the radius, is inside,
constexpr double surface_slack = 1e-5;
// and, in radii, sees nothing as near as this: farther than it is across such a thin shell, however oblique.
constexpr double shell_width = 5e-3;

double squared_radius(const Ball& ball) { return double(ball.radius) * ball.radius; }

bool is_inside(const Ball& ball, double distance_squared) {
  return !ball.is_soft && distance_squared <= squared_radius(ball) * (1 + surface_slack);
}

double nearest_visible(const Ball& ball, double distance_squared) {
  const bool is_at_surface = std::abs(distance_squared / squared_radius(ball) - 1) <= surface_slack;
  return !ball.is_soft && is_at_surface ? shell_width * ball.radius : 0;
}

// 1 - cos of the half angle of the cone that the ball fills, or 2 (every direction) inside a sphere.
float subtended_cone(const Ball& ball, double distance_squared) {
  const double radius_squared = squared_radius(ball);
  if (ball.is_soft) return float(one_minus_cos_from_sin_squared(radius_squared / (radius_squared + distance_squared)));
  if (is_inside(ball, distance_squared)) return 2;
  return float(one_minus_cos_from_sin_squared(radius_squared / distance_squared));
}

// Along a direction at an angle to the ball's centre.
double distance_to_ball(const Ball& ball, double center_distance, double cos_theta, double sin_squared) {
  if (ball.is_soft) return center_distance / cos_theta;
  const double distance_squared = center_distance * center_distance;
  const double half_chord = std::sqrt(std::max(0.0, squared_radius(ball) - distance_squared * sin_squared));
  const double middle = center_distance * cos_theta;
  return is_inside(ball, distance_squared) ? middle + half_chord : middle - half_chord;
}

bool is_seen(const Ball& ball, double distance_squared, double cos_theta, double sin_squared) {
  if (is_inside(ball, distance_squared)) return true;
  const double cos_squared = ball.is_soft ? cos_theta * cos_theta : 1;
  return cos_theta > 0 && distance_squared * sin_squared < squared_radius(ball) * cos_squared;
}

}  // namespace

std::optional<BallSample> sample_ball(const Ball& ball, Vec3f position, Vec2f u) {
  const Vec3d to_center = Vec3d(ball.center) - Vec3d(position);
  const double distance_squared = length_squared(to_center);
  if (ball.is_soft && distance_squared == 0) return std::nullopt;
  const double center_distance = std::sqrt(distance_squared);
  const Vec3f axis = center_distance > 0 ? Vec3f(to_center / center_distance) : Vec3f{0, 0, 1};

  const float cone = subtended_cone(ball, distance_squared);
  const Vec3f local = sample_cone(u, cone);
  const Vec3f wi = normalize(make_frame(axis).to_world(local));
  const double distance = distance_to_ball(ball, center_distance, local.z, local.x * local.x + local.y * local.y);
  if (!(distance > nearest_visible(ball, distance_squared))) return std::nullopt;
  return BallSample{wi, float(distance), pdf_cone(cone)};
}

float pdf_ball(const Ball& ball, Vec3f position, double distance) {
  const double distance_squared = length_squared(Vec3d(ball.center) - Vec3d(position));
  if (!(distance > nearest_visible(ball, distance_squared))) return 0;
  return pdf_cone(subtended_cone(ball, distance_squared));
}

bool is_inside(const Ball& ball, Vec3f position) {
  return is_inside(ball, length_squared(Vec3d(ball.center) - Vec3d(position)));
}

std::optional<BallHit> intersect_ball(const Ball& ball, const Ray& ray) {
  const Vec3d to_center = Vec3d(ball.center) - Vec3d(ray.origin);
  const double distance_squared = length_squared(to_center);
  const double direction_length = length(Vec3d(ray.direction));
  const Vec3d direction = Vec3d(ray.direction) / direction_length;
  const double center_distance = std::sqrt(distance_squared);
  // At the centre of a sphere every direction is alike; a disc has no front there.
  if (center_distance == 0 && ball.is_soft) return std::nullopt;
  const Vec3d axis = center_distance > 0 ? to_center / center_distance : direction;

  const double cos_theta = dot(direction, axis);
  const double sin_squared = length_squared(cross(direction, axis));
  if (!is_seen(ball, distance_squared, cos_theta, sin_squared)) return std::nullopt;
  const double distance = distance_to_ball(ball, center_distance, cos_theta, sin_squared);
  const double t = distance / direction_length;
  if (!(distance > nearest_visible(ball, distance_squared) && t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
  return BallHit{float(t), pdf_cone(subtended_cone(ball, distance_squared))};
}

BallPoint sample_ball_point(const Ball& ball, Vec3f direction, Vec2f u) {
  // The outline is a disc: its points lifted onto the hemisphere are distributed as the cosine.
  const Vec3f normal = make_frame(direction).to_world(sample_cosine_hemisphere(u));
  return {ball.center + normal * ball.radius, normal};
}

float ball_position_pdf(const Ball& ball, Vec3f position, Vec3f direction) {
  const float cosine = dot(position - ball.center, direction) / ball.radius;
  return pdf_cosine_hemisphere(cosine) / (ball.radius * ball.radius);
}

}  // namespace basicrt
