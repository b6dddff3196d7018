// SPDX-License-Identifier: GPL-3.0-or-later
// Luminaires looked up by direction.
#include "shading/ies_operation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/constants.h"
#include "shading/program.h"

namespace basicrt {
namespace {

float value_at(IesOperation node, Vec3f direction) {
  const Table<Texture> no_textures;
  const SurfacePoint point;
  node.vector = direction;
  return eval(node, Evaluator({}, no_textures, {}, point, {})).x;
}

Vec3f direction_of(float horizontal, float vertical) {
  return {-std::sin(horizontal) * std::sin(vertical), -std::cos(horizontal) * std::sin(vertical), -std::cos(vertical)};
}

IesOperation table() {
  return {.horizontal = {0, pi / 2, pi, 3 * pi / 2, 2 * pi},
          .vertical = {0, 0.5f, 1, 1.5f},
          .values = {8, 4, 2, 1, 8, 5, 3, 1, 8, 6, 4, 1, 8, 5, 3, 1, 8, 4, 2, 1}};
}

TEST(IesOperation, gives_the_table_s_own_values_at_its_angles) {
  const IesOperation node = table();
  for (std::size_t h = 0; h < 4; ++h)
    for (std::size_t v = 1; v < 3; ++v)
      EXPECT_NEAR(value_at(node, direction_of(node.horizontal[h], node.vertical[v])), node.values[h * 4 + v], 2e-4f)
          << h << " " << v;
  EXPECT_NEAR(value_at(node, {0, 0, -3}), 8, 1e-4f);  // the pole is the same at all horizontal angles
}

TEST(IesOperation, is_dark_beyond_the_angles) {
  EXPECT_EQ(value_at(table(), {0, 0, 1}), 0);
  EXPECT_GT(value_at(table(), direction_of(1, 1.49f)), 0);
  EXPECT_EQ(value_at(table(), direction_of(1, 1.51f)), 0);
}

TEST(IesOperation, is_smooth_across_the_beginning_of_the_circle) {
  const IesOperation node = table();
  const auto at = [&](float angle) { return value_at(node, direction_of(angle, 1)); };
  EXPECT_NEAR(at(0.01f), at(2 * pi - 0.01f), 1e-4f);  // the table is symmetric
  EXPECT_NEAR(at(0.0f), 2, 1e-4f);
  // A spline of equal neighbours is flat there: half a degree off changes nothing of first order.
  EXPECT_NEAR(at(0.01f), 2, 1e-3f);
}

TEST(IesOperation, interpolates_by_catmull_rom_splines) {
  // Between 4 and 2, whose neighbours are 8 and 1: half of each and a sixteenth of the difference.
  const float expected = (9 * (4.0f + 2.0f) - 8 - 1) / 16;
  EXPECT_NEAR(value_at(table(), direction_of(0, 0.75f)), expected, 1e-4f);
}

TEST(IesOperation, multiplies_by_the_strength_and_is_never_negative) {
  IesOperation node = table();
  node.strength = 3.0f;
  EXPECT_NEAR(value_at(node, direction_of(pi / 2, 0.5f)), 15, 1e-3f);
  node.values.assign(20, -1);
  EXPECT_EQ(value_at(node, direction_of(pi / 2, 0.5f)), 0);
}

}  // namespace
}  // namespace basicrt
