// SPDX-License-Identifier: GPL-3.0-or-later
// Passes of whole pictures: light passes put together are the picture, whatever is in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "render/session.h"
#include "render/tile_render.h"
#include "sampling/filter.h"

namespace basicrt {
namespace {

constexpr std::array not_compared = {Pass::crypto_object, Pass::crypto_material, Pass::crypto_asset};

Id<Material> add(Scene& scene, const std::string& name, const ShaderNode& node) {
  Material material{.name = name, .nodes = {}, .pass_index = static_cast<int>(scene.materials.size()) + 10};
  const NodeIndex index = material.add(node);
  (std::holds_alternative<VolumeShader>(node) ? material.volume : material.surface) = index;
  return scene.materials.append(material);
}

// One ball of each kind of scattering, a pane before one of them, and a floor under a lamp and a sky.
Scene make_scene() {
  Scene scene;
  scene.camera = make_look_at_camera({0, -6, 2}, {0, 0, 0.5f}, {0, 0, 1}, 0.7f, 1.5f);
  scene.settings.width = 48;
  scene.settings.height = 32;
  scene.settings.samples = 70;  // more than a block
  scene.settings.exposure = 0.5f;
  scene.settings.volume_bounces = 2;
  for (const PassInfo& info : passes) scene.settings.passes.enable(info.pass);
  scene.environment.radiance = Color(0.2f, 0.3f, 0.5f);
  scene.lights.append(PointLight{.position = {2, -2, 4}, .intensity = Color(20.0f), .radius = 0.5f});
  const std::vector<ShaderNode> nodes = {GlassShader{.roughness = 0.2f},
                                         GlassShader{},
                                         GlossyShader{.color = Color(0.8f, 0.6f, 0.3f), .roughness = 0.3f},
                                         PrincipledShader{.base_color = Color(0.2f, 0.5f, 0.9f)},
                                         EmissionShader{.radiance = Color(1, 2, 3)},
                                         VolumeShader{.absorption = Color(0.5f), .scattering = Color(1.0f)}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3f center{-2.5f + static_cast<float>(i), 0, 0.5f};
    scene.instances.append({.name = "ball " + std::to_string(i),
                            .shape = scene.shapes.append(Sphere{center, 0.45f}),
                            .object_to_world = {},
                            .materials = {add(scene, "material " + std::to_string(i), nodes[i])},
                            .pass_index = static_cast<int>(i) + 1});
  }
  Mesh square;
  square.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.instances.append(
      {.name = "floor", .shape = scene.shapes.append(square), .object_to_world = {}, .materials = {}});
  square.positions = {{0, -1, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}};
  scene.instances.append({.name = "pane",
                          .shape = scene.shapes.append(square),
                          .object_to_world = {},
                          .materials = {add(scene, "pane", TransparentShader{.color = Color(0.9f, 0.6f, 0.8f)})}});
  return scene;
}

Film render_scene(const Scene& scene, SessionOptions options = {}) {
  Report report;
  return render(prepare(scene, report), options);
}

// What Combined would be by the other passes.
float put_together(const Film& film, std::size_t pixel, std::size_t channel) {
  const auto value = [&](Pass pass) { return double{film.values(pass)[pixel * 3 + channel]}; };
  return static_cast<float>(
      (value(Pass::diffuse_direct) + value(Pass::diffuse_indirect)) * value(Pass::diffuse_color) +
      (value(Pass::glossy_direct) + value(Pass::glossy_indirect)) * value(Pass::glossy_color) +
      (value(Pass::transmission_direct) + value(Pass::transmission_indirect)) * value(Pass::transmission_color) +
      value(Pass::volume_direct) + value(Pass::volume_indirect) + value(Pass::emission) + value(Pass::environment));
}

void expect_put_together(const Scene& scene) {
  const Film film = render_scene(scene);
  const std::vector<float>& combined = film.values(Pass::combined);
  for (std::size_t pixel = 0; pixel < combined.size() / 4; ++pixel)
    for (std::size_t c = 0; c < 3; ++c) {
      const float expected = combined[pixel * 4 + c];
      ASSERT_NEAR(put_together(film, pixel, c), expected, 2e-5f * std::max(expected, 1.0f))
          << "pixel " << pixel % 48 << ", " << pixel / 48 << ", channel " << c;
    }
}

TEST(Passes, put_together_are_the_picture) { expect_put_together(make_scene()); }

TEST(Passes, put_together_are_the_picture_where_light_is_clamped_and_the_filter_has_negative_lobes) {
  Scene scene = make_scene();
  scene.settings.clamp_direct = 0.7f;
  scene.settings.clamp_indirect = 0.3f;
  scene.settings.filter = {.kind = FilterKind::mitchell, .radius = 2};
  expect_put_together(scene);
}

TEST(Passes, each_kind_of_scattering_has_its_own) {
  const Film film = render_scene(make_scene());
  // Columns and rows of the middles of balls: see make_scene().
  const auto sum_over = [&](Pass pass, float x) {
    const auto column = static_cast<std::size_t>(std::lround(24 + x * 8.2f));
    const std::size_t row = 16;
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += film.values(pass)[(row * 48 + column) * 3 + c];
    return sum;
  };
  EXPECT_GT(sum_over(Pass::transmission_indirect, -2.5f), 0);
  EXPECT_EQ(sum_over(Pass::diffuse_direct, -2.5f), 0);
  EXPECT_GT(sum_over(Pass::transmission_color, -1.5f), 2.5f);
  EXPECT_NEAR(sum_over(Pass::glossy_color, -0.5f), 1.7f, 0.1f);
  EXPECT_EQ(sum_over(Pass::diffuse_color, -0.5f), 0);
  EXPECT_NEAR(sum_over(Pass::emission, 1.5f), 0.5f * 6, 1e-4f);  // times the exposure
  EXPECT_GT(sum_over(Pass::volume_direct, 2.5f), 0);
}

TEST(Passes, are_the_same_bytes_for_any_number_of_threads_and_any_tile_size) {
  const Scene scene = make_scene();
  const Film reference = render_scene(scene, {.threads = 1, .tile_size = 64});
  const Film film = render_scene(scene, {.threads = 3, .tile_size = 7});
  for (const PassInfo& info : passes) {
    ASSERT_EQ(std::memcmp(film.values(info.pass).data(), reference.values(info.pass).data(),
                          film.values(info.pass).size() * sizeof(float)),
              0)
        << info.name;
  }
}

TEST(Passes, the_light_of_all_groups_is_the_picture) {
  Scene scene = make_scene();
  PointLight lamp = std::get<PointLight>(scene.lights[0]);
  lamp.light_group = 1;
  scene.lights.set({0}, lamp);
  scene.environment.light_group = 2;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    Instance instance = scene.instances[i];
    instance.light_group = light_groups;
    scene.instances.set({i}, instance);
  }
  const Film film = render_scene(scene);
  const auto& picture = film.values(Pass::combined);
  std::vector<float> total(picture.size() / 4 * 3);
  for (const int group : {1, 2, light_groups}) {
    const auto& light = film.values(light_group_pass(group));
    EXPECT_GT(std::ranges::max(light), 0.01f) << group;
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += light[i];
  }
  for (std::size_t i = 0; i < total.size(); ++i)
    ASSERT_NEAR(total[i], picture[i / 3 * 4 + i % 3], 1e-5f * std::max(1.0f, total[i]));
  EXPECT_EQ(std::ranges::max(film.values(light_group_pass(3))), 0);
}

TEST(Passes, asking_for_them_changes_no_picture) {
  Scene scene = make_scene();
  const Film film = render_scene(scene);
  scene.settings.passes = {};
  EXPECT_EQ(render_scene(scene).values(Pass::combined), film.values(Pass::combined));
}

TEST(Passes, the_first_hit_has_its_indices_and_its_place) {
  const Film film = render_scene(make_scene());
  const std::size_t emitting = 16 * 48 + 24 + 12;
  EXPECT_EQ(film.values(Pass::object_index)[emitting], 5);
  EXPECT_EQ(film.values(Pass::material_index)[emitting], 14);
  EXPECT_NEAR(film.values(Pass::position)[emitting * 3], 1.5f, 0.3f);
}

TEST(Passes, mist_is_the_power_of_the_share_of_the_way) {
  Scene scene;
  scene.camera = make_look_at_camera({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1e-3f, 1);
  scene.settings.width = scene.settings.height = 1;
  scene.settings.passes.enable(Pass::mist);
  scene.settings.mist_start = 2;
  scene.settings.mist_depth = 8;
  scene.settings.mist_falloff = 2;
  EXPECT_EQ(render_scene(scene).values(Pass::mist)[0], 1);
  Mesh square;
  square.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.instances.append(
      {.name = "floor", .shape = scene.shapes.append(square), .object_to_world = {}, .materials = {}});
  EXPECT_NEAR(render_scene(scene).values(Pass::mist)[0], 1.0f / 16, 1e-5f);
}

TEST(Passes, ranges_of_samples_render_what_they_have_of_the_whole) {
  Scene scene = make_scene();
  for (const Pass pass : not_compared)
    for (int i = 0; i < matte_passes; ++i)
      scene.settings.passes.enable(static_cast<Pass>(static_cast<int>(pass) + i), false);
  scene.settings.samples = 200;
  const Film whole = render_scene(scene, {.threads = 2, .tile_size = 13});
  Report report;
  const PixelFilter filter(scene.settings.filter);
  TileAccumulator merged({0, 0, 48, 32}, scene.settings.passes, accumulator_options(prepare(scene, report), filter));
  for (const auto& [from, to] : {std::pair(0, 64), std::pair(64, 128), std::pair(128, 200)}) {
    scene.settings.samples_from = from;
    scene.settings.samples_to = to;
    merged.add_words(render_scene(scene).sums());
  }
  Film film(48, 32, scene.settings.passes);
  film.write(merged.finish());
  for (const PassInfo& info : passes) EXPECT_EQ(film.values(info.pass), whole.values(info.pass)) << info.name;
}

}  // namespace
}  // namespace basicrt
