// SPDX-License-Identifier: GPL-3.0-or-later
// The round body of a lamp: a sphere, or a disc of the same radius that faces whoever looks at it.
#pragma once

#include <optional>

#include "math/bounds.h"
#include "math/ray.h"

namespace basicrt {

struct Ball {
  Vec3f center;
  float radius = 0;
  bool is_soft = false;  // the disc; it has no inside
};

[[nodiscard]] inline Bounds3f box_of(const Ball& ball) {
  return {ball.center - Vec3f(ball.radius), ball.center + Vec3f(ball.radius)};
}

// A body this small (metres) is a point: 1 / radius^2 must stay a float.
inline constexpr float smallest_ball_radius = 1e-9f;

// A direction in which the ball is seen. The pdf is over solid angle and the same for every such direction: both bodies
// fill a cone, and a sphere fills all directions for those inside it.
struct BallSample {
  Vec3f wi;  // unit length
  float distance = 0;
  float pdf = 0;
};
// Nothing where the position is the centre of a disc, or where a place on the sphere would look outwards.
[[nodiscard]] std::optional<BallSample> sample_ball(const Ball& ball, Vec3f position, Vec2f u);

// The density of that for a place on the ball so far away.
[[nodiscard]] float pdf_ball(const Ball& ball, Vec3f position, double distance);
// In the sphere or on it, as near as can be told. A disc has no inside.
[[nodiscard]] bool is_inside(const Ball& ball, Vec3f position);

struct BallHit {
  float t = 0;  // along the ray as it was given
  float pdf = 0;
};
// From inside a sphere its far side is seen.
[[nodiscard]] std::optional<BallHit> intersect_ball(const Ball& ball, const Ray& ray);

// A point on the half of the sphere that looks in `direction`, uniform over its outline as seen from there.
struct BallPoint {
  Vec3f position, normal;
};
[[nodiscard]] BallPoint sample_ball_point(const Ball& ball, Vec3f direction, Vec2f u);
// Its density per area of the sphere.
[[nodiscard]] float ball_position_pdf(const Ball& ball, Vec3f position, Vec3f direction);

}  // namespace basicrt
