// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons of all shapes in triangles.
#include "io/triangulate.h"

#include <gtest/gtest.h>

#include <random>

#include "math/constants.h"

namespace basicrt {
namespace {

// Twice the area, along the normal.
Vec3d area_of(std::span<const Vec3f> polygon) {
  Vec3d area(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    area += cross(Vec3d(polygon[i]) - Vec3d(polygon[0]), Vec3d(polygon[i + 1]) - Vec3d(polygon[0]));
  return area;
}

// Triangles that are all wound as the polygon, and whose areas add up to its, cover it without overlap.
void expect_covered(std::span<const Vec3f> polygon) {
  const auto triangles = triangulate(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  const Vec3d whole = area_of(polygon), normal = normalize(whole);
  double sum = 0;
  for (const auto& triangle : triangles) {
    const double area =
        dot(area_of(std::array{polygon[triangle[0]], polygon[triangle[1]], polygon[triangle[2]]}), normal);
    EXPECT_GE(area, -1e-6 * length(whole));
    sum += area;
  }
  EXPECT_NEAR(sum, length(whole), 1e-5 * length(whole));
}

TEST(Triangulate, covers_concave_polygons_wherever_they_begin) {
  const std::vector<Vec3f> arrow = {{0, 0, 0}, {0.5f, 0.5f, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Vec3f> comb = {{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {4, 2, 0}, {4, 1, 0}, {3, 1, 0},
                                   {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (std::vector<Vec3f> polygon : {arrow, comb}) {
    for (std::size_t begin = 0; begin < polygon.size(); ++begin) {
      expect_covered(polygon);
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
    std::reverse(polygon.begin(), polygon.end());
    expect_covered(polygon);
  }
}

TEST(Triangulate, covers_stars_in_any_plane) {
  constexpr unsigned seed = 20261122;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.1f, 1), any(-1, 1);
  for (int round = 0; round < 200; ++round) {
    const Vec3f u(any(random), any(random), any(random)), v(any(random), any(random), any(random));
    if (length(cross(u, v)) < 0.1f) continue;
    std::vector<Vec3f> star;  // around a point that sees every corner
    for (int i = 0; i < 23; ++i) {
      const float angle = 2 * pi * static_cast<float>(i) / 23, radius = uniform(random);
      star.push_back(Vec3f(3, 4, 5) + u * (radius * std::cos(angle)) + v * (radius * std::sin(angle)));
    }
    expect_covered(star);
  }
}

TEST(Triangulate, polygons_without_area_still_end) {
  EXPECT_EQ(triangulate(std::vector<Vec3f>(7, Vec3f(1, 2, 3))).size(), 5u);
  EXPECT_EQ(triangulate(std::vector<Vec3f>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);  // a bow tie
}

}  // namespace
}  // namespace basicrt
