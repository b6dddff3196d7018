// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions: the same bytes however they are run, prompt stops, monotone progress.
#include "render/session.h"

#include <gtest/gtest.h>

#include <thread>

namespace basicrt {
namespace {

using namespace std::chrono_literals;

// A glass ball on a diffuse floor under a lamp and a sky, with everything random that a path may meet.
Scene make_scene(int samples) {
  Scene scene;
  scene.camera = make_look_at_camera({0, -6, 2}, {0, 0, 0.5f}, {0, 0, 1}, 0.6f, 1.5f);
  scene.settings.width = 48;
  scene.settings.height = 32;
  scene.settings.samples = samples;
  scene.settings.passes.enable(Pass::depth);
  scene.settings.passes.enable(Pass::normal);
  scene.environment.radiance = Color(0.2f, 0.3f, 0.5f);
  scene.lights.append(PointLight{.position = {2, -2, 4}, .intensity = Color(20.0f), .radius = 0.5f});

  Material glass;
  glass.surface = glass.add(GlassShader{});
  const Id<Material> glass_id = scene.materials.append(glass);
  const Id<Shape> ball = scene.shapes.append(Sphere{{0, 0, 0.8f}, 0.8f});
  Mesh floor;
  floor.positions = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Id<Shape> floor_id = scene.shapes.append(floor);
  scene.instances.append({.name = "ball", .shape = ball, .object_to_world = {}, .materials = {glass_id}});
  scene.instances.append({.name = "floor", .shape = floor_id, .object_to_world = {}, .materials = {}});
  return scene;
}

PreparedScene prepared(const Scene& scene) {
  Report report;
  return prepare(scene, report);
}

void expect_same_values(const Film& a, const Film& b) {
  for (const PassInfo& info : passes) EXPECT_EQ(a.values(info.pass), b.values(info.pass)) << info.name;
}

TEST(Session, the_same_bytes_for_any_number_of_threads_and_any_tile_size) {
  const Scene scene = make_scene(7);
  const Film reference = render(prepared(scene), {.threads = 1, .tile_size = 64});
  for (const SessionOptions options : {SessionOptions{1, 5}, SessionOptions{3, 16}, SessionOptions{8, 1}})
    expect_same_values(render(prepared(scene), options), reference);
}

TEST(Session, another_seed_gives_other_noise) {
  Scene scene = make_scene(2);
  const Film reference = render(prepared(scene));
  scene.settings.seed = 1;
  EXPECT_NE(render(prepared(scene)).values(Pass::combined), reference.values(Pass::combined));
}

TEST(Session, a_border_renders_the_same_pixels_and_no_others) {
  Scene scene = make_scene(3);
  const Film whole = render(prepared(scene));
  scene.settings.border_x = 10;
  scene.settings.border_y = 4;
  scene.settings.border_width = 20;
  scene.settings.border_height = 9;
  const Film part = render(prepared(scene));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) {
      const bool is_inside = x >= 10 && x < 30 && y >= 4 && y < 13;
      const std::size_t i = (y * 48 + x) * 4;
      ASSERT_EQ(part.values(Pass::combined)[i], is_inside ? whole.values(Pass::combined)[i] : 0) << x << ", " << y;
    }
}

Scene make_adaptive_scene(int samples, float threshold) {
  Scene scene = make_scene(samples);
  scene.settings.adaptive_threshold = threshold;
  scene.settings.adaptive_min_samples = 16;
  return scene;
}

TEST(AdaptiveSampling, the_same_bytes_for_any_number_of_threads_and_any_tile_size) {
  const Scene scene = make_adaptive_scene(200, 0.05f);
  const Film reference = render(prepared(scene), {.threads = 1, .tile_size = 64});
  for (const SessionOptions options : {SessionOptions{1, 5}, SessionOptions{3, 16}, SessionOptions{4, 1}})
    expect_same_values(render(prepared(scene), options), reference);
}

// Pulls all tiles.
Progress finish(Session& session) {
  while (!session.is_done()) (void)session.next_tile(10ms);
  return session.progress();
}

TEST(AdaptiveSampling, spends_samples_where_the_noise_is) {
  Session all(prepared(make_scene(200))), few(prepared(make_adaptive_scene(200, 0.05f)));
  const Progress all_done = finish(all), few_done = finish(few);
  EXPECT_EQ(all_done.samples_per_pixel, 200);
  EXPECT_LT(few_done.samples_per_pixel, 150);
  EXPECT_GT(few_done.samples_per_pixel, 16);
  EXPECT_EQ(few_done.fraction, 1);
}

TEST(AdaptiveSampling, pixels_with_all_samples_have_the_bytes_of_a_fixed_number) {
  Scene scene = make_adaptive_scene(60, 0.5f);
  scene.settings.adaptive_min_samples = 60;
  expect_same_values(render(prepared(scene)), render(prepared(make_scene(60))));
}

TEST(TimeLimit, one_that_is_not_reached_changes_no_byte) {
  Scene scene = make_scene(50);
  const Film reference = render(prepared(scene));
  scene.settings.time_limit = 1000;
  expect_same_values(render(prepared(scene), {.threads = 3, .tile_size = 16}), reference);
}

TEST(TimeLimit, ends_a_render_with_all_pixels_sampled_about_alike) {
  Scene scene = make_scene(1 << 20);
  scene.settings.time_limit = 0.3f;
  const Film black(48, 32, scene.settings.passes);
  Film film = black;
  Session session(prepared(scene), {.threads = 2, .tile_size = 16});
  const auto begin = std::chrono::steady_clock::now();
  while (!session.is_done())
    if (const std::optional<Tile> tile = session.next_tile(10ms)) film.write(*tile);
  // Two seconds more than the limit, since the sanitizers' builds and a busy machine are slow.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 2300ms);
  const Progress progress = session.progress();
  EXPECT_TRUE(progress.is_time_up);
  EXPECT_EQ(progress.fraction, 1);
  EXPECT_GE(progress.samples_per_pixel, 1);
  for (std::size_t i = 3; i < film.values(Pass::combined).size(); i += 4)
    ASSERT_EQ(film.values(Pass::combined)[i], 1) << "no sample at " << i / 4;
}

TEST(TimeLimit, the_first_round_is_finished_however_short_the_time) {
  Scene scene = make_scene(100);
  scene.settings.time_limit = 1e-6f;
  const Film film = render(prepared(scene), {.threads = 2, .tile_size = 16});
  scene.settings.time_limit = 0;
  scene.settings.samples = 1;
  expect_same_values(film, render(prepared(scene)));
}

TEST(Session, progress_never_falls_and_ends_at_one) {
  Session session(prepared(make_scene(200)), {.threads = 2, .tile_size = 16});
  double last = 0;
  while (!session.is_done()) {
    const double fraction = session.progress().fraction;
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    (void)session.next_tile(1ms);
  }
  EXPECT_EQ(session.progress().fraction, 1);
  EXPECT_TRUE(session.progress().is_done);
}

TEST(Session, a_stop_takes_effect_within_a_tenth_of_a_second_and_hands_out_no_more_tiles) {
  auto session =
      std::make_unique<Session>(prepared(make_scene(1 << 20)), SessionOptions{.threads = 2, .tile_size = 48});
  std::this_thread::sleep_for(50ms);
  const auto begin = std::chrono::steady_clock::now();
  session->stop();
  EXPECT_FALSE(session->next_tile(10s).has_value());
  EXPECT_TRUE(session->is_done());
  session.reset();  // waits for the workers
  // A second more than the rule, since the sanitizers' builds and a busy machine are slow.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 1100ms);
}

TEST(Session, waiting_for_a_tile_ends_in_time) {
  Session session(prepared(make_scene(1 << 20)), {.threads = 1, .tile_size = 48});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(session.next_tile(30ms).has_value());
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 30ms);
  EXPECT_FALSE(session.is_done());
}

}  // namespace
}  // namespace basicrt
