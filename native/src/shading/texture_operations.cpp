// SPDX-License-Identifier: GPL-3.0-or-later
// Images and Blender's simple patterns.
#include "shading/texture_operations.h"

#include <algorithm>
#include <cmath>

#include "image/environment_projection.h"
#include "math/constants.h"
#include "shading/evaluator.h"
#include "shading/noise.h"
#include "shading/surface_operations.h"
#include "shading/texture_values.h"

namespace basicrt {
namespace {

// Keeps what lies at whole coordinates, as edges of unit cubes do, on one side.
Vec3f off_edges(Vec3f p) { return (p + Vec3f(0.000001f)) * 0.999999f; }

float gradient(GradientKind kind, Vec3f p) {
  switch (kind) {
    case GradientKind::linear:
      return p.x;
    case GradientKind::quadratic:
      return std::max(p.x, 0.0f) * std::max(p.x, 0.0f);
    case GradientKind::easing: {
      const float r = std::clamp(p.x, 0.0f, 1.0f), t = r * r;
      return 3 * t - 2 * t * r;
    }
    case GradientKind::diagonal:
      return (p.x + p.y) * 0.5f;
    case GradientKind::radial:
      return std::atan2(p.y, p.x) / (2 * pi) + 0.5f;
    case GradientKind::quadratic_sphere:
    case GradientKind::spherical:
      break;
  }
  const float r = std::max(0.999999f - length(p), 0.0f);
  return kind == GradientKind::spherical ? r : r * r;
}

float wave_place(const WaveOperation& node, Vec3f p) {
  const auto axis = static_cast<std::size_t>(node.direction);
  if (!node.is_rings) return axis < 3 ? p[axis] * 20 : (p.x + p.y + p.z) * 10;
  if (axis < 3) p[axis] = 0;
  return length(p) * 20;
}

Vec3f from_middle(Vec3f place) { return (place - Vec3f(0.5f)) * 2; }

Vec2f around_sphere(Vec3f p) {
  const float distance = length(p);
  if (distance == 0) return {0, 0};
  const float u = p.x == 0 && p.y == 0 ? 0 : 0.5f - std::atan2(p.x, p.y) / (2 * pi);
  return {u, 1 - std::acos(std::clamp(p.z / distance, -1.0f, 1.0f)) / pi};
}

Vec2f around_tube(Vec3f p) {
  if (p.x == 0 && p.y == 0) return {0, 0};
  return {0.5f - std::atan2(p.x, p.y) / (2 * pi), (p.z + 1) / 2};
}

// How much of a box's sides across x, y and z is seen where the normal has such absolute components; of one side but for
// near its edges, of three near its corners.
Vec3f box_shares(Vec3f normal, float blend) {
  const Vec3f n = normal / (normal.x + normal.y + normal.z);
  const float limit = 0.5f * (1 + blend);
  const auto others = [](std::size_t i) { return std::pair{(i + 1) % 3, (i + 2) % 3}; };
  Vec3f shares(0.0f);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [j, k] = others(i);
    if (!(n[i] > limit * (n[i] + n[j]) && n[i] > limit * (n[i] + n[k]))) continue;
    shares[i] = 1;
    return shares;
  }
  if (!(blend > 0)) return {1, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [j, k] = others(i);
    if (n[i] >= (1 - limit) * (n[j] + n[k])) continue;
    shares[j] = std::clamp((n[j] / (n[j] + n[k]) - 0.5f * (1 - blend)) / blend, 0.0f, 1.0f);
    shares[k] = 1 - shares[j];
    return shares;
  }
  for (std::size_t i = 0; i < 3; ++i) shares[i] = ((2 - limit) * n[i] + (limit - 1)) / (2 * limit - 1);
  return shares;
}

// Fixed random numbers in [0, 1) of integers.
float brick_noise(std::uint32_t n) {
  n = (n + 1013) & 0x7fffffff;
  n = (n >> 13) ^ n;
  const std::uint32_t mixed = (n * (n * n * 60493 + 19990303) + 1376312589) & 0x7fffffff;
  return 0.5f * (static_cast<float>(mixed) / 1073741824.0f);
}

}  // namespace

Vec3f eval(const ImageOperation& node, const Evaluator& in) {
  const Vec3f place = in(node.vector);
  if (!node.texture.is_valid()) return Vec3f(0.0f);
  const auto at = [&](Vec2f uv) {
    const Rgba value = eval_texture_values(in.textures[node.texture], uv);
    return node.is_alpha ? Vec3f(value.alpha) : value.color;
  };
  switch (node.projection) {
    case TextureProjection::flat:
      break;
    case TextureProjection::sphere:
      return at(around_sphere(from_middle(place)));
    case TextureProjection::tube:
      return at(around_tube(from_middle(place)));
    case TextureProjection::equirectangular:
      return at(project_direction(EnvironmentProjection::equirectangular, place));
    case TextureProjection::mirror_ball:
      return at(project_direction(EnvironmentProjection::mirror_ball, place));
    case TextureProjection::box: {
      const Vec3f normal = eval(SurfaceOperation{SurfaceValue::object_normal}, in),
                  shares = box_shares(abs(normal), node.blend);
      Vec3f sum(0.0f);
      // Each pair of sides is seen the right way round from outside.
      if (shares.x > 0) sum += at({normal.x < 0 ? 1 - place.y : place.y, place.z}) * shares.x;
      if (shares.y > 0) sum += at({normal.y > 0 ? 1 - place.x : place.x, place.z}) * shares.y;
      if (shares.z > 0) sum += at({normal.z > 0 ? 1 - place.y : place.y, place.x}) * shares.z;
      return sum;
    }
  }
  return at({place.x, place.y});
}

Vec3f eval(const CheckerOperation& node, const Evaluator& in) {
  const Vec3f p = off_edges(in(node.vector) * in(node.scale));
  const auto cell = [](float x) { return static_cast<int>(std::abs(std::floor(x))); };
  return Vec3f((cell(p.x) + cell(p.y) + cell(p.z)) % 2 != 0 ? 1.0f : 0.0f);
}

Vec3f eval(const GradientOperation& node, const Evaluator& in) {
  return Vec3f(std::clamp(gradient(node.gradient, in(node.vector)), 0.0f, 1.0f));
}

Vec3f eval(const WaveOperation& node, const Evaluator& in) {
  const Vec3f p = off_edges(in(node.vector) * in(node.scale));
  float place = wave_place(node, p) + in(node.phase);
  if (const float distortion = in(node.distortion); distortion != 0) {
    const Octaves octaves{std::clamp(in(node.detail), 0.0f, 15.0f), in(node.detail_roughness), 2};
    const Vec3f q = p * in(node.detail_scale);
    place += distortion * (fractal_noise<3>({q.x, q.y, q.z}, octaves, true) * 2 - 1);
  }
  const float turns = place / (2 * pi);
  switch (node.profile) {
    case WaveProfile::sine:
      return Vec3f(0.5f + 0.5f * std::sin(place - pi / 2));
    case WaveProfile::saw:
      return Vec3f(turns - std::floor(turns));
    case WaveProfile::triangle:
      return Vec3f(std::abs(turns - std::floor(turns + 0.5f)) * 2);
  }
  return {};
}

Vec3f eval(const MagicOperation& node, const Evaluator& in) {
  const Vec3f vector = in(node.vector);
  const float scale = in(node.scale), distortion = in(node.distortion);
  const auto turn = [](float x) { return std::fmod(x, 2 * pi); };
  const float px = turn(vector.x), py = turn(vector.y), pz = turn(vector.z);
  float x = std::sin((px + py + pz) * 5 * scale), y = std::cos((-px + py - pz) * 5 * scale),
        z = -std::cos((-px - py + pz) * 5 * scale);
  const int depth = node.depth;
  if (depth > 0) x *= distortion, y *= distortion, z *= distortion;
  if (depth > 0) y = -std::cos(x - y + z) * distortion;
  if (depth > 1) x = std::cos(x - y - z) * distortion;
  if (depth > 2) z = std::sin(-x - y - z) * distortion;
  if (depth > 3) x = -std::cos(-x + y - z) * distortion;
  if (depth > 4) y = -std::sin(-x + y + z) * distortion;
  if (depth > 5) y = -std::cos(-x + y + z) * distortion;
  if (depth > 6) x = std::cos(x + y + z) * distortion;
  if (depth > 7) z = std::sin(x + y - z) * distortion;
  if (depth > 8) x = -std::cos(-x - y + z) * distortion;
  if (depth > 9) y = -std::sin(x - y + z) * distortion;
  const Vec3f result{x, y, z};
  return Vec3f(0.5f) - (distortion != 0 ? result / (distortion * 2) : result);
}

Vec3f eval(const BrickOperation& node, const Evaluator& in) {
  const Vec3f p = in(node.vector) * in(node.scale);
  const float height = in(node.row_height);
  float width = in(node.brick_width), shift = 0;
  const int row = static_cast<int>(std::floor(p.y / height));
  if (node.offset_frequency != 0 && node.squash_frequency != 0) {
    if (row % node.squash_frequency == 0) width *= node.squash;
    if (row % node.offset_frequency == 0) shift = width * node.offset;
  }
  const int brick = static_cast<int>(std::floor((p.x + shift) / width));
  const float x = p.x + shift - width * static_cast<float>(brick), y = p.y - height * static_cast<float>(row);
  const std::uint32_t seed = (static_cast<std::uint32_t>(row) << 16) + (static_cast<std::uint32_t>(brick) & 0xffffu);
  const float tint = std::clamp(brick_noise(seed) + in(node.bias), 0.0f, 1.0f);
  const float edge = std::min(std::min(x, y), std::min(width - x, height - y)), mortar = in(node.mortar_size);
  if (edge >= mortar) return {0, tint, 0};
  const float smooth = in(node.mortar_smooth);
  if (smooth == 0) return {1, tint, 0};
  const float t = std::clamp((1 - edge / mortar) / smooth, 0.0f, 1.0f);
  return {t * t * (3 - 2 * t), tint, 0};
}

}  // namespace basicrt
