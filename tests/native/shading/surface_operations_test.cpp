// SPDX-License-Identifier: GPL-3.0-or-later
// Normals of maps and bumps, and what is read of meshes.
#include "shading/surface_operations.h"

#include <gtest/gtest.h>

#include "bsdf/bsdf.h"
#include "shading/program.h"

namespace basicrt {
namespace {

const Table<Texture> no_textures;

// A triangle in the plane z = 0, with corners at the origin and 1 along x and y.
Mesh make_triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

SurfacePoint point_at(float x, float y) {
  SurfacePoint point;
  point.position = {x, y, 0};
  point.barycentrics = {x, y};
  point.geometric_normal = point.shading_normal = {0, 0, 1};
  point.primitive = 0;
  point.t = 1;
  return point;
}

Vec3f value_of(const Operation& operation, const SurfacePoint& point, const ShadingContext& context) {
  Material material;
  material.operations = {operation};
  const ProgramRun run(material, no_textures, point, {0, 0, 1}, context);
  return run.values()(ColorInput(OperationIndex{0}));
}

TEST(SurfaceOperations, interpolates_attributes_of_each_domain) {
  Mesh mesh = make_triangle();
  mesh.attributes = {{"v", AttributeDomain::vertex, {Vec3f(0.0f), Vec3f(1.0f), Vec3f(2.0f)}},
                     {"f", AttributeDomain::face, {Vec3f(7.0f)}}};
  const Placement placement;
  const ShadingContext context{.mesh = &mesh, .placement = &placement};
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "v"}, point_at(0.25f, 0.5f), context).x, 1.25f);
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "f"}, point_at(0.25f, 0.5f), context).x, 7);
  EXPECT_FLOAT_EQ(value_of(AttributeOperation{.name = "no", .missing = 1}, point_at(0.25f, 0.5f), context).x, 1);
}

TEST(SurfaceOperations, wires_are_as_wide_as_they_say) {
  const Mesh mesh = make_triangle();
  const Placement placement;
  const ShadingContext context{.mesh = &mesh, .placement = &placement};
  const WireframeOperation wires{.size = 0.1f};
  EXPECT_EQ(value_of(wires, point_at(0.3f, 0.049f), context).x, 1);
  EXPECT_EQ(value_of(wires, point_at(0.3f, 0.051f), context).x, 0);
}

// The height x * x rises by 2 x for each metre, so that the normal leans back by as much.
TEST(SurfaceOperations, bumps_lean_by_their_slope) {
  const Mesh mesh = make_triangle();
  const Placement placement;
  const ShadingContext context{.mesh = &mesh, .placement = &placement, .footprint = 1e-3f};
  Material material;
  material.operations = {SurfaceOperation{SurfaceValue::position},
                         ComponentOperation{.value = OperationIndex{0}, .component = Component::x},
                         MathOperation{.operation = MathKind::multiply, .a = OperationIndex{1}, .b = OperationIndex{1}},
                         BumpOperation{.height = OperationIndex{2}}};
  material.add(DiffuseShader{.normal = OperationIndex{3}});
  material.surface = 0;
  const Material compiled = compile(material, no_textures);
  const ProgramRun run(compiled, no_textures, point_at(0.3f, 0.2f), {0, 0, 1}, context);
  const Vec3f normal = run.values()(ColorInput(OperationIndex{3}));
  EXPECT_NEAR(normal.x / normal.z, -0.6f, 2e-3f);
  EXPECT_NEAR(normal.y, 0, 1e-3f);
  EXPECT_EQ(std::get<BumpOperation>(compiled.operations[3]).steps, (std::vector<std::uint32_t>{0, 1, 2}));
}

// Each lobe counts with its own cosine.
TEST(SurfaceOperations, shaders_keep_normals_of_their_own) {
  const Vec3f tilted = normalize(Vec3f{0.6f, 0, 0.8f}), light = normalize(Vec3f{0.3f, 0.1f, 1});
  Material material;
  const NodeIndex first = material.add(DiffuseShader{.color = Color(1.0f)});
  const NodeIndex second = material.add(DiffuseShader{.color = Color(1.0f), .normal = tilted});
  material.surface = material.add(MixShader{.factor = 0.25f, .first = first, .second = second});
  const Bsdf bsdf = shade(material, no_textures, point_at(0.2f, 0.2f), {0, 0, 1}).bsdf;
  const float expected = (0.75f * light.z + 0.25f * dot(tilted, light)) / pi;
  EXPECT_NEAR(bsdf.eval({0, 0, 1}, light).value.x, expected, 1e-6f);
  EXPECT_NEAR(bsdf.eval({0, 0, 1}, light).pdf, expected, 1e-6f);
}

}  // namespace
}  // namespace basicrt
