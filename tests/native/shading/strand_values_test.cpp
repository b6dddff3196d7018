// SPDX-License-Identifier: GPL-3.0-or-later
// What operations read of curves and point clouds.
#include <gtest/gtest.h>

#include "shading/program.h"
#include "shading/surface_operations.h"

namespace basicrt {
namespace {

const Table<Texture> no_textures;

Vec3f value_of(const Operation& operation, const SurfacePoint& point, const ShadingContext& context) {
  Material material;
  material.operations = {operation};
  const ProgramRun run(material, no_textures, point, {0, 0, 1}, context);
  return run.values()(ColorInput(OperationIndex{0}));
}
Vec3f value_of(SurfaceValue value, const SurfacePoint& point, const ShadingContext& context) {
  return value_of(SurfaceOperation{value}, point, context);
}

// Two curves, the second of three points; at a quarter of its second segment.
TEST(StrandValues, are_those_of_the_curve_that_was_hit) {
  const Curves curves{.points = {{9, 0, 0}, {9, 1, 0}, {0, 0, 0}, {3, 0, 0}, {3, 4, 0}},
                      .radii = {1, 1, 0.5f, 0.3f, 0.1f},
                      .firsts = {0, 2},
                      .randoms = {0.1f, 0.7f},
                      .attributes = {{"v", AttributeDomain::vertex, {{}, {}, Vec3f(1.0f), Vec3f(2.0f), Vec3f(4.0f)}},
                                     {"f", AttributeDomain::face, {Vec3f(5.0f), Vec3f(6.0f)}}}};
  const Placement placement;
  const ShadingContext context{.curves = &curves, .placement = &placement};
  SurfacePoint point;
  point.primitive = 3;
  point.barycentrics = {0.25f, 0};
  point.derivatives.emplace().dpdu = {0, 2, 0};
  EXPECT_EQ(value_of(SurfaceValue::is_strand, point, context).x, 1);
  EXPECT_FLOAT_EQ(value_of(SurfaceValue::strand_intercept, point, context).x, 0.625f);
  EXPECT_FLOAT_EQ(value_of(SurfaceValue::strand_length, point, context).x, 7);
  EXPECT_FLOAT_EQ(value_of(SurfaceValue::strand_thickness, point, context).x, 0.5f);
  EXPECT_FLOAT_EQ(value_of(SurfaceValue::strand_random, point, context).x, 0.7f);
  EXPECT_EQ(value_of(SurfaceValue::strand_tangent_normal, point, context), (Vec3f{0, 0, 1}));
  EXPECT_EQ(value_of(SurfaceValue::point_radius, point, context).x, 0);
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "v"}, point, context).x, 2.5f);
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "f"}, point, context).x, 6);
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "no", .missing = 3}, point, context).x, 3);
}

TEST(StrandValues, are_those_of_the_point_that_was_hit) {
  const PointCloud cloud{.positions = {{0, 0, 0}, {1, 2, 3}},
                         .radii = {1, 0.25f},
                         .randoms = {0.5f, 0.75f},
                         .attributes = {{"v", AttributeDomain::vertex, {Vec3f(1.0f), Vec3f(2.0f)}}}};
  TransformD moved;
  moved.rows[0][3] = 10;
  const Placement placement(moved);
  const ShadingContext context{.points = &cloud, .placement = &placement};
  SurfacePoint point;
  point.primitive = 1;
  EXPECT_EQ(value_of(SurfaceValue::point_position, point, context), (Vec3f{11, 2, 3}));
  EXPECT_EQ(value_of(SurfaceValue::point_radius, point, context).x, 0.25f);
  EXPECT_EQ(value_of(SurfaceValue::point_random, point, context).x, 0.75f);
  EXPECT_EQ(value_of(SurfaceValue::is_strand, point, context).x, 0);
  EXPECT_EQ(value_of(AttributeOperation{.name = "v"}, point, context).x, 2);
}

}  // namespace
}  // namespace basicrt
