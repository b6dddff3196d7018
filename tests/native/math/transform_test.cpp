// SPDX-License-Identifier: GPL-3.0-or-later
// Transforms and frames against their defining properties.
#include "math/transform.h"

#include <gtest/gtest.h>

#include <random>

#include "math/frame.h"

namespace basicrt {
namespace {

TransformD random_transform(std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(-2, 2);
  TransformD m;
  do {
    for (auto& row : m.rows)
      for (double& x : row) x = uniform(rng);
  } while (std::abs(m.determinant()) < 0.1);
  return m;
}

TEST(Transform, inverse_undoes) {
  std::mt19937 rng(1);
  for (int i = 0; i < 100; ++i) {
    const TransformD m = random_transform(rng);
    const Vec3d p{1.5, -2, 0.25};
    EXPECT_LT(length(inverse(m).point(m.point(p)) - p), 1e-12);
    EXPECT_LT(length((inverse(m) * m).point(p) - p), 1e-12);
  }
}

TEST(Transform, normals_stay_perpendicular_to_transformed_tangents) {
  std::mt19937 rng(2);
  for (int i = 0; i < 100; ++i) {
    const TransformD m = random_transform(rng);
    const Vec3d tangent{1, 2, 3}, normal = cross(tangent, Vec3d{0, 1, 1});
    EXPECT_NEAR(dot(m.vector(tangent), inverse(m).transposed_vector(normal)), 0, 1e-12);
  }
}

TEST(Transform, the_box_of_a_box_contains_its_points) {
  std::mt19937 rng(3);
  const TransformD m = random_transform(rng);
  const Bounds3<double> box{{-1, -2, -3}, {1, 0, 2}};
  const Bounds3<double> moved = transform_bounds(m, box);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Vec3d p = box.lower + box.extent() * Vec3d{u(rng), u(rng), u(rng)};
    const Bounds3<double> point{m.point(p), m.point(p)};
    EXPECT_TRUE(moved.contains(point));
  }
}

TEST(Frame, is_orthonormal_and_right_handed_for_every_normal) {
  std::mt19937 rng(4);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 1000; ++i) {
    Vec3f n = normalize(Vec3f{gauss(rng), gauss(rng), gauss(rng)});
    if (i == 0) n = {0, 0, -1};
    const Frame f = make_frame(n);
    EXPECT_NEAR(dot(f.tangent, f.bitangent), 0, 1e-6);
    EXPECT_NEAR(dot(f.tangent, f.normal), 0, 1e-6);
    EXPECT_NEAR(length(f.tangent), 1, 1e-6);
    EXPECT_LT(length(cross(f.tangent, f.bitangent) - f.normal), 1e-6f);
    const Vec3f v{0.1f, 0.7f, -0.4f};
    EXPECT_LT(length(f.to_world(f.to_local(v)) - v), 1e-6f);
  }
}

}  // namespace
}  // namespace basicrt
