// SPDX-License-Identifier: GPL-3.0-or-later
// Programs do as little as they can, and operations give the values that Blender's nodes are defined to give.
#include "shading/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bsdf/prepared_material.h"
#include "math/constants.h"
#include "shading/lattice.h"

namespace basicrt {
namespace {

const Table<Texture> no_textures;

Vec3f value_of(const Operation& operation, const SurfacePoint& point = {}) {
  Material material;
  material.add(operation);
  const ShadingContext context;
  const ProgramRun run(material, no_textures, point, {0, 0, 1}, context);
  return run.values()(ColorInput(OperationIndex{0}));
}

Material diffuse_by(std::vector<Operation> operations) {
  Material material;
  material.operations = std::move(operations);
  const auto last = static_cast<std::uint32_t>(material.operations.size() - 1);
  material.surface = material.add(ShaderNode(DiffuseShader{.color = OperationIndex{last}, .is_two_sided = true}));
  return material;
}

TEST(Program, folds_what_is_constant) {
  const Material material =
      compile(diffuse_by({MathOperation{.operation = MathKind::multiply, .a = 0.5f, .b = 0.5f},
                          MathOperation{.operation = MathKind::add, .a = OperationIndex{0}, .b = 0.125f}}),
              no_textures);
  EXPECT_TRUE(material.operations.empty());
  EXPECT_EQ(std::get<DiffuseShader>(material.nodes[0]).color, ColorInput(Color(0.375f)));
}

TEST(Program, constant_material_is_uniform) {
  const PreparedMaterial prepared(diffuse_by({MathOperation{}}), no_textures);
  EXPECT_TRUE(prepared.front.has_value());
}

TEST(Program, varying_material_is_not_uniform) {
  const PreparedMaterial prepared(diffuse_by({SurfaceOperation{SurfaceValue::uv}}), no_textures);
  EXPECT_FALSE(prepared.front.has_value());
}

TEST(Program, makes_equal_operations_one) {
  const Material material = compile(
      diffuse_by(
          {SurfaceOperation{SurfaceValue::uv}, SurfaceOperation{SurfaceValue::uv},
           VectorMathOperation{.operation = VectorMathKind::add, .a = OperationIndex{0}, .b = OperationIndex{1}}}),
      no_textures);
  ASSERT_EQ(material.operations.size(), 2u);
  const auto& sum = std::get<VectorMathOperation>(material.operations[1]);
  EXPECT_EQ(sum.a, sum.b);
}

TEST(Program, drops_what_nothing_refers_to) {
  const Material material =
      compile(diffuse_by({NoiseOperation{.vector = OperationIndex{}}, SurfaceOperation{SurfaceValue::position},
                          SurfaceOperation{SurfaceValue::uv}}),
              no_textures);
  ASSERT_EQ(material.operations.size(), 1u);
  EXPECT_EQ(std::get<SurfaceOperation>(material.operations[0]).value, SurfaceValue::uv);
}

TEST(Program, cuts_the_branch_that_a_constant_mix_leaves_out) {
  Material material;
  const OperationIndex uv = material.add(Operation(SurfaceOperation{SurfaceValue::uv}));
  const OperationIndex zero = material.add(Operation(MathOperation{.operation = MathKind::subtract}));
  const NodeIndex plain = material.add(ShaderNode(DiffuseShader{}));
  const NodeIndex varying = material.add(ShaderNode(DiffuseShader{.color = uv}));
  material.surface = material.add(ShaderNode(MixShader{.factor = zero, .first = plain, .second = varying}));
  EXPECT_TRUE(compile(material, no_textures).operations.empty());
}

TEST(Program, compiles_two_hundred_operations_in_five_milliseconds) {
  std::vector<Operation> operations{SurfaceOperation{SurfaceValue::position}};
  for (std::uint32_t i = 0; i < 199; ++i)
    operations.push_back(MathOperation{.operation = MathKind::add, .a = OperationIndex{i}, .b = static_cast<float>(i)});
  const Material material = diffuse_by(std::move(operations));
  double best = 1;  // of several: other processes take time, too
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(compile(material, no_textures).operations.size(), 200u);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  EXPECT_LT(best, 5e-3);
}

TEST(Program, shader_shows_the_operation_value) {
  SurfacePoint point;
  point.geometric_normal = point.shading_normal = {0, 0, 1};
  point.uv = {0.25f, 0.75f};
  Material material;
  const OperationIndex uv = material.add(Operation(SurfaceOperation{SurfaceValue::uv}));
  material.surface = material.add(ShaderNode(EmissionShader{.radiance = uv}));
  const PreparedMaterial prepared(material, no_textures);
  EXPECT_EQ(shade(prepared.material, no_textures, point, {0, 0, 1}).emission, Color(0.25f, 0.75f, 0));
  EXPECT_EQ(emitted_radiance(prepared.material, SurfaceSide::front), Color(0.0f));
  EXPECT_TRUE(has_varying_emission(prepared.material, SurfaceSide::front));
  EXPECT_TRUE(is_emissive(prepared.material));
}

TEST(Program, values_stay_in_the_range_of_the_input) {
  SurfacePoint point;
  point.geometric_normal = point.shading_normal = {0, 0, 1};
  point.position = {-1, 2, std::numeric_limits<float>::quiet_NaN()};
  Material material;
  const OperationIndex position = material.add(Operation(SurfaceOperation{SurfaceValue::position}));
  material.surface = material.add(ShaderNode(EmissionShader{.radiance = position}));
  const PreparedMaterial prepared(material, no_textures);
  EXPECT_EQ(shade(prepared.material, no_textures, point, {0, 0, 1}).emission, Color(0, 2, 0));
}

TEST(Operations, math_gives_zero_where_there_is_no_value) {
  EXPECT_EQ(value_of(MathOperation{.operation = MathKind::divide, .a = 1.0f, .b = 0.0f}).x, 0);
  EXPECT_EQ(value_of(MathOperation{.operation = MathKind::power, .a = -2.0f, .b = 0.5f}).x, 0);
  EXPECT_EQ(value_of(MathOperation{.operation = MathKind::power, .a = -2.0f, .b = 3.0f}).x, -8);
  EXPECT_EQ(value_of(MathOperation{.operation = MathKind::pingpong, .a = 1.25f, .b = 1.0f}).x, 0.75f);
  EXPECT_EQ(value_of(MathOperation{.operation = MathKind::wrap, .a = 2.5f, .b = 1.0f, .c = 0.0f}).x, 0.5f);
}

TEST(Operations, mix_blends) {
  const ColorInput half(Vec3f(0.5f)), a(Vec3f(0.25f)), b(Vec3f(0.75f));
  EXPECT_EQ(value_of(MixOperation{.blend = BlendKind::mix, .factor = half, .a = a, .b = b}).x, 0.5f);
  EXPECT_EQ(value_of(MixOperation{.blend = BlendKind::add, .factor = half, .a = a, .b = b}).x, 0.625f);
  EXPECT_EQ(value_of(MixOperation{.blend = BlendKind::difference, .factor = Vec3f(1.0f), .a = a, .b = b}).x, 0.5f);
}

TEST(Operations, colors_go_to_other_models_and_back) {
  for (const ColorModel model : {ColorModel::hsv, ColorModel::hsl}) {
    const Color color{0.2f, 0.7f, 0.4f};
    const Vec3f there = value_of(ConvertColorOperation{.color = color, .source = ColorModel::rgb, .target = model});
    const Color back = value_of(ConvertColorOperation{.color = there, .source = model, .target = ColorModel::rgb});
    EXPECT_LT(max_component(abs(back - color)), 1e-6f);
  }
}

TEST(Operations, table_is_looked_up_between_entries_and_beyond) {
  TableOperation table{.value = Vec3f(-0.5f, 0.5f, 3.0f), .colors = {0, 0, 0, 2, 4, 6}};
  EXPECT_EQ(value_of(table), Vec3f(0, 2, 6));
  table.is_extrapolated = true;
  EXPECT_EQ(value_of(table), Vec3f(-1, 2, 18));
}

TEST(Operations, mapping_of_texture_undoes_that_of_point) {
  const Vec3f place{0.3f, -0.2f, 0.9f};
  MappingOperation mapping{
      .vector = place, .location = Vec3f(1, 2, 3), .rotation = Vec3f(0.1f, 0.2f, 0.3f), .scale = Vec3f(2, 3, 4)};
  const Vec3f there = value_of(mapping);
  mapping.vector = there;
  mapping.mapping = MappingKind::texture;
  EXPECT_LT(max_component(abs(value_of(mapping) - place)), 1e-6f);
}

TEST(Operations, noise_is_a_half_at_whole_points) {
  EXPECT_EQ(value_of(NoiseOperation{.vector = Vec3f(1, 2, 3), .scale = 1.0f, .detail = 0.0f}).x, 0.5f);
}

TEST(Operations, voronoi_distance_is_that_to_its_position) {
  const Vec3f place{0.31f, 0.77f, 0.45f};
  VoronoiOperation cells{.vector = place, .scale = 3.0f};
  const float distance = value_of(cells).x;
  cells.output = VoronoiOutput::position;
  EXPECT_NEAR(length(value_of(cells) - place) * 3, distance, 1e-5f);
}

// Expected numbers: the paper's hashes (Jarzynski and Olano 2020) by whole numbers without bounds, cut to 32 bits.
TEST(Operations, cells_are_hashed_as_signed_numbers) {
  const auto share = [](double number) { return static_cast<float>(number / 2147483647); };
  const Lattice<2> two = hash_cell(Lattice<2>{1, -2});
  EXPECT_FLOAT_EQ(two[0], share(1240201675));
  EXPECT_FLOAT_EQ(two[1], share(555059549));
  const Lattice<3> three = hash_cell(Lattice<3>{1, -2, 3});
  EXPECT_FLOAT_EQ(three[0], share(908989604));
  EXPECT_FLOAT_EQ(three[2], share(792426977));
  const Lattice<4> four = hash_cell(Lattice<4>{1, -2, 3, -4});
  EXPECT_FLOAT_EQ(four[0], share(1763984726));
  EXPECT_FLOAT_EQ(four[3], share(1711506339));
}

TEST(Operations, voronoi_without_smoothness_is_that_of_the_nearest_point) {
  VoronoiOperation cells{.vector = Vec3f(0.3f, 0.6f, 0.2f), .smoothness = 0.0f};
  const Vec3f nearest = value_of(cells);
  cells.feature = VoronoiFeature::smooth_f1;
  EXPECT_EQ(value_of(cells), nearest);
}

TEST(Operations, gabor_value_is_the_sine_of_its_phase_times_its_intensity) {
  for (const int dimensions : {2, 3}) {
    GaborOperation waves{.dimensions = dimensions, .vector = Vec3f(0.3f, 0.6f, 0.2f), .anisotropy = 0.5f};
    const float value = value_of(waves).x;
    waves.output = GaborOutput::phase;
    const float phase = (2 * value_of(waves).x - 1) * pi;
    waves.output = GaborOutput::intensity;
    EXPECT_NEAR(value_of(waves).x * std::sin(phase), 2 * value - 1, 1e-6f);
  }
}

TEST(Operations, gamma_of_zero_is_white) {
  EXPECT_EQ(value_of(ToneOperation{.change = ToneKind::gamma, .color = Vec3f(-1, 0, 2), .a = 0.0f}), Vec3f(1.0f));
}

TEST(Operations, hues_beyond_a_turn_are_in_the_last_sector) {
  const auto color = [](float hue) {
    return value_of(
        ConvertColorOperation{.color = Vec3f(hue, 1, 1), .source = ColorModel::hsv, .target = ColorModel::rgb});
  };
  EXPECT_EQ(color(1), Vec3f(1, 0, 0));
  EXPECT_EQ(color(1.125f), Vec3f(1, 0, 0.25f));
}

}  // namespace
}  // namespace basicrt
