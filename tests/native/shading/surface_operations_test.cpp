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

TEST(SurfaceOperations, read_properties_of_the_object_by_name) {
  const ObjectInfo object{.properties = {{"a", {1, 2, 3}}, {"b", Vec3f(4.0f)}}};
  const ShadingContext context{.object = &object};
  EXPECT_EQ(value_of(ObjectPropertyOperation{.name = "a"}, {}, context), (Vec3f{1, 2, 3}));
  EXPECT_EQ(value_of(ObjectPropertyOperation{.name = "b"}, {}, context), Vec3f(4.0f));
  EXPECT_EQ(value_of(ObjectPropertyOperation{.name = "c", .missing = 0.5f}, {}, context), Vec3f(0.5f));
  EXPECT_EQ(value_of(ObjectPropertyOperation{.name = "a"}, {}, {}), Vec3f(0.0f));
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

// A mesh that was flat and is a steep slope now: heights along the flat one count, and the normal that it had.
TEST(SurfaceOperations, bumps_of_the_undisplaced_surface_know_nothing_of_the_displacement) {
  Mesh mesh = make_triangle();
  mesh.rest_positions = mesh.positions;
  for (Vec3f& position : mesh.positions) position.z = 3 * position.x;
  mesh.corner_normals.assign(3, Vec3f{0, 0, 1});
  const Placement placement;
  const ShadingContext context{.mesh = &mesh, .placement = &placement, .footprint = 1e-3f};
  Material material;
  material.operations = {
      SurfaceOperation{SurfaceValue::generated},
      VectorMathOperation{.operation = VectorMathKind::dot_product, .a = OperationIndex{0}, .b = OperationIndex{0}},
      BumpOperation{.height = OperationIndex{1}, .is_undisplaced = true}};
  material.add(DiffuseShader{.normal = OperationIndex{2}});
  material.surface = 0;
  const Material compiled = compile(material, no_textures);
  SurfacePoint point = point_at(0.3f, 0.2f);
  point.position.z = 0.9f;
  point.geometric_normal = normalize(Vec3f{-3, 0, 1});
  const ProgramRun run(compiled, no_textures, point, {0, 0, 1}, context);
  const Vec3f normal = run.values()(ColorInput(OperationIndex{2}));
  EXPECT_NEAR(normal.x / normal.z, -0.6f, 3e-3f);
  EXPECT_NEAR(normal.y / normal.z, -0.4f, 3e-3f);
}

// Each lobe counts with its own cosine, and the turned one fades a little.
TEST(SurfaceOperations, shaders_keep_normals_of_their_own) {
  const Vec3f tilted = normalize(Vec3f{0.6f, 0, 0.8f}), light = normalize(Vec3f{0.3f, 0.1f, 1});
  Material material;
  const NodeIndex first = material.add(DiffuseShader{.color = Color(1.0f)});
  const NodeIndex second = material.add(DiffuseShader{.color = Color(1.0f), .normal = tilted});
  material.surface = material.add(MixShader{.factor = 0.25f, .first = first, .second = second});
  const Bsdf bsdf = shade(material, no_textures, point_at(0.2f, 0.2f), {0, 0, 1}).bsdf;
  // The tangents' squares are 0.5625 of the tilt and 0.1 of the light.
  const float fade = 2 / (1 + std::sqrt(1 + 0.5625f / 8 * 0.1f));
  const float even = 0.75f * light.z, turned = 0.25f * dot(tilted, light);
  EXPECT_NEAR(bsdf.eval({0, 0, 1}, light).value.x, (even + turned * fade) / pi, 1e-6f);
  EXPECT_NEAR(bsdf.eval({0, 0, 1}, light).pdf, (even + turned) / pi, 1e-6f);
}

TEST(SurfaceOperations, turned_lobes_scatter_what_they_evaluate_to) {
  const Vec3f tilted = normalize(Vec3f{0.6f, 0, 0.8f}), wo = normalize(Vec3f{-0.2f, 0.3f, 1});
  Material material;
  const NodeIndex first = material.add(DiffuseShader{.color = Color(0.9f), .normal = normalize(Vec3f{-0.5f, 0.4f, 1})});
  const NodeIndex second = material.add(DiffuseShader{.color = Color(0.6f), .normal = tilted});
  material.surface = material.add(MixShader{.factor = 0.4f, .first = first, .second = second});
  const Bsdf bsdf = shade(material, no_textures, point_at(0.2f, 0.2f), wo).bsdf;
  constexpr int side = 128, count = side * side;
  double sampled = 0, evaluated = 0;
  for (int i = 0; i < count; ++i) {
    const Vec2f u{(static_cast<float>(i % side) + 0.5f) / side, (static_cast<float>(i / side) + 0.5f) / side};
    for (int choice = 0; choice < 8; ++choice)
      if (const auto scattered = bsdf.sample(wo, (static_cast<float>(choice) + 0.5f) / 8, u)) {
        sampled += scattered->weight.x / 8;
        EXPECT_NEAR(bsdf.eval(wo, scattered->wi).value.x / scattered->pdf, scattered->weight.x, 1e-4f);
      }
    const float z = u.x, across = std::sqrt(1 - z * z), phi = 2 * pi * u.y;
    const Vec3f wi{across * std::cos(phi), across * std::sin(phi), z};
    evaluated += bsdf.eval(wo, wi).value.x * 2 * pi;
  }
  // Eight choices don't split quite as the lobes' shares do.
  EXPECT_NEAR(sampled / evaluated, 1, 0.01);
}

}  // namespace
}  // namespace basicrt
