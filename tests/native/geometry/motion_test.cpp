// SPDX-License-Identifier: GPL-3.0-or-later
// What moves is at each time what would stand still there.
#include "geometry/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "geometry/surface_point.h"

namespace basicrt {
namespace {

TransformD translation(double x) {
  TransformD transform;
  transform.rows[0][3] = x;
  return transform;
}

// Two triangles with normals and uvs, whose vertices go their own ways over three keys.
Mesh deforming_mesh() {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto vectors = [&](std::size_t count, Vec3f middle) {
    std::vector<Vec3f> result;
    for (std::size_t i = 0; i < count; ++i) {
      const float x = uniform(rng), y = uniform(rng), z = uniform(rng);
      result.push_back(middle + Vec3f{x, y, z} * 0.3f);
    }
    return result;
  };
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_normals = vectors(6, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  for (int key = 0; key < 2; ++key) {
    std::vector<Vec3f>& positions = mesh.motion_positions.emplace_back(mesh.positions);
    const std::vector<Vec3f> moved = vectors(4, {0, 0, 0.5f});
    for (std::size_t i = 0; i < 4; ++i) positions[i] += moved[i];
    mesh.motion_corner_normals.push_back(vectors(6, {0.2f, 0, 1}));
  }
  return mesh;
}

Mesh still_at(const Mesh& mesh, float time) {
  Mesh still = mesh;
  still.motion_positions.clear();
  still.motion_corner_normals.clear();
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) {
      const std::size_t number = 3 * std::size_t{triangle} + static_cast<std::size_t>(corner);
      still.positions[mesh.triangles[triangle][corner]] = mesh.position_at(triangle, corner, time);
      still.corner_normals[number] = mesh.corner_normal_at(number, time);
    }
  return still;
}

TEST(Motion, times_lie_between_the_keys_around_them) {
  struct Case {
    float time;
    std::uint32_t first;
    float fraction;
  };
  for (const auto& [time, first, fraction] :
       {Case{0, 0, 0}, Case{0.125f, 0, 0.5f}, Case{0.25f, 1, 0}, Case{0.9375f, 3, 0.75f}, Case{1, 3, 1}}) {
    EXPECT_EQ(key_interval(4, time).first, first) << time;
    EXPECT_EQ(key_interval(4, time).fraction, fraction) << time;
  }
}

TEST(Motion, times_outside_the_shutter_count_as_its_ends) {
  for (const float time : {-1.0f, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(key_interval(3, time).first, 0u);
    EXPECT_EQ(key_interval(3, time).fraction, 0);
  }
  for (const float time : {2.0f, std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(key_interval(3, time).first, 2u);
    EXPECT_EQ(key_interval(3, time).fraction, 1);
  }
}

TEST(Motion, equal_keys_are_exactly_the_transform_that_they_are) {
  const TransformD transform({{{0.1, 0.7, 1e10, 3}, {-0.3, 1e-9, 2, 0.2}, {5, 6, 7.7, 1e5}}});
  const std::vector<TransformD> keys(3, transform);
  for (const float time : {0.0f, 0.3f, 0.77f, 1.0f}) EXPECT_EQ(transform_at(keys, time), transform);
}

TEST(Motion, a_point_on_what_moves_is_that_of_what_stands_there) {
  const Mesh mesh = deforming_mesh();
  const std::vector<TransformD> keys{translation(1), TransformD({{{0.9, 0.2, 0, 0}, {0, 1.1, 0.1, 0}, {0, 0, 1, -1}}})};
  for (const float time : {0.0f, 0.2f, 0.5f, 0.9f, 1.0f})
    for (const Vec2f uv : {Vec2f{0.2f, 0.3f}, Vec2f{0.6f, 0.1f}}) {
      const Mesh still = still_at(mesh, time);
      const Placement placement(transform_at(keys, time));
      const Vec3d target = Vec3d(still.position(1, 0)) * double(1 - uv.x - uv.y) +
                           Vec3d(still.position(1, 1)) * double(uv.x) + Vec3d(still.position(1, 2)) * double(uv.y);
      const Vec3f origin{0.3f, -0.4f, 6};
      const Ray ray{
          .origin = origin, .direction = Vec3f(placement.object_to_world.point(target)) - origin, .time = time};
      const Hit hit{.t = 1, .instance = 0, .primitive = 1, .u = uv.x, .v = uv.y};
      const auto point_on = [&](const Mesh& on) {
        SurfacePoint point = make_surface_point(on, placement, ray, hit);
        add_derivatives(point, on, placement);
        return point;
      };
      const SurfacePoint point = point_on(mesh), expected = point_on(still);
      EXPECT_EQ(point.position, expected.position);
      EXPECT_EQ(point.position_error, expected.position_error);
      EXPECT_EQ(point.geometric_normal, expected.geometric_normal);
      EXPECT_LT(length(point.shading_normal - expected.shading_normal), 1e-6f);
      EXPECT_EQ(point.uv, expected.uv);
      EXPECT_EQ(point.time, time);
      EXPECT_EQ(point.derivatives->dpdu, expected.derivatives->dpdu);
      EXPECT_EQ(point.derivatives->dndv, expected.derivatives->dndv);
      EXPECT_LT(length(point.position - Vec3f(placement.object_to_world.point(target))), 1e-5f);
    }
}

TEST(Motion, the_bounds_of_a_mesh_hold_it_at_all_times) {
  const Mesh mesh = deforming_mesh();
  for (int i = 0; i <= 20; ++i) EXPECT_TRUE(bounds(mesh).contains(bounds(still_at(mesh, static_cast<float>(i) / 20))));
}

TEST(Motion, a_mesh_that_deforms_must_have_all_its_arrays_at_each_key) {
  const auto message = [](const Mesh& mesh) -> std::string {
    try {
      validate(mesh, "it");
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(deforming_mesh()), "");
  Mesh mesh = deforming_mesh();
  mesh.motion_positions[1].pop_back();
  EXPECT_EQ(message(mesh), "it.motion_positions[1]: has 3 vectors, but at time 0 there are 4");
  mesh = deforming_mesh();
  mesh.motion_positions[0][2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message(mesh), "it.motion_positions[0][2]: must be finite, is NaN or infinite");
  mesh = deforming_mesh();
  mesh.motion_corner_normals.pop_back();
  EXPECT_NE(message(mesh).find("it.motion_corner_normals: must have as many keys"), std::string::npos);
  mesh = deforming_mesh();
  mesh.corner_normals.clear();
  EXPECT_NE(message(mesh).find("it.motion_corner_normals: must have as many keys"), std::string::npos);
  mesh = deforming_mesh();
  mesh.motion_corner_normals[1].resize(5);
  EXPECT_EQ(message(mesh), "it.motion_corner_normals[1]: has 5 vectors, but at time 0 there are 6");
}

TEST(Motion, a_mesh_that_deforms_keeps_triangles_that_have_no_area_yet) {
  Mesh mesh = deforming_mesh();
  mesh.positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  Report report;
  EXPECT_EQ(remove_degenerate_triangles(mesh, "it", report).triangles.size(), 2u);
  EXPECT_TRUE(report.warnings().empty());
}

}  // namespace
}  // namespace basicrt
