// SPDX-License-Identifier: GPL-3.0-or-later
// Views: coarse pictures first, the same values as renders at the end, what is set meanwhile, and errors.
#include "render/view_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "base/error.h"
#include "integrator/integrator_scenes.h"

namespace basicrt {
namespace {

using namespace std::chrono_literals;

// A sphere under a white sky.
Scene make_scene(int samples) {
  Scene scene = scene_from_above(samples);
  scene.settings.width = 90;
  scene.settings.height = 50;
  scene.environment.radiance = Color(1.0f);
  add_instance(scene, Sphere{{0, 0, 0}, 1}, add_material(scene, DiffuseShader{}));
  return scene;
}

View view_of(const Scene& scene) { return {.camera = *scene.camera, .settings = scene.settings}; }

// All pictures until nothing more comes; the last one first.
std::vector<ViewPicture> wait_for_pictures(ViewSession& session) {
  std::vector<ViewPicture> pictures;
  while (true) {
    const bool is_done = session.status().is_done;
    if (std::optional<ViewPicture> picture = session.take_picture()) pictures.insert(pictures.begin(), *picture);
    if (is_done) return pictures;
    std::this_thread::sleep_for(1ms);
  }
}

std::vector<float> rendered(const Scene& scene) {
  Report report;
  return render(prepare(scene, report)).values(Pass::combined);
}

TEST(ViewSession, ends_with_the_values_of_a_render) {
  const Scene scene = make_scene(5);
  ViewSession session(2);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  const std::vector<ViewPicture> pictures = wait_for_pictures(session);
  ASSERT_FALSE(pictures.empty());
  EXPECT_EQ(pictures.front().samples, 5);
  EXPECT_EQ(pictures.front().rgba, rendered(scene));
}

TEST(ViewSession, shows_coarse_pictures_of_the_same_view_first) {
  const Scene scene = make_scene(1 << 20);
  ViewSession session(1);
  session.set_view(view_of(scene));
  session.set_scene(scene);
  std::optional<ViewPicture> first;
  while (!(first = session.take_picture())) std::this_thread::sleep_for(1ms);
  EXPECT_LE(first->film_width, 90);
  EXPECT_EQ(first->rgba.size(), static_cast<std::size_t>(first->rect.width * first->rect.height) * 4);
}

TEST(ViewSession, a_border_shows_the_same_pixels) {
  Scene scene = make_scene(2);
  const std::vector<float> whole = rendered(scene);
  scene.settings.border_x = 20;
  scene.settings.border_y = 10;
  scene.settings.border_width = 30;
  scene.settings.border_height = 15;
  ViewSession session(2);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  const ViewPicture picture = wait_for_pictures(session).front();
  ASSERT_EQ(picture.rect, (PixelRect{20, 10, 30, 15}));
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 30 * 4; ++x)
      ASSERT_EQ(picture.rgba[y * 30 * 4 + x], whole[((y + 10) * 90 + 20) * 4 + x]) << x << ", " << y;
}

TEST(ViewSession, shows_an_edited_scene_as_if_it_were_new) {
  Scene scene = make_scene(3);
  ViewSession session(2);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  const std::vector<float> before = wait_for_pictures(session).front().rgba;
  Instance moved = scene.instances[0];
  moved.object_to_world.rows[0][3] = 1;
  scene.instances.set(Id<Instance>{0}, moved);
  session.set_scene(scene);
  const std::vector<float> after = wait_for_pictures(session).front().rgba;
  EXPECT_NE(after, before);
  EXPECT_EQ(after, rendered(scene));
}

// With a tree of its own, so that moving it builds the tree over the instances alone.
TEST(ViewSession, shows_moved_instances_of_a_shared_shape_as_if_they_were_new) {
  Scene scene = make_scene(2);
  scene.lights.append(SunLight{});
  for (int i = 0; i < 9; ++i) {
    Instance copy = scene.instances[0];
    copy.object_to_world.rows[0][3] = static_cast<float>(i % 3) - 1;
    copy.object_to_world.rows[1][3] = static_cast<float>(i / 3) - 1;
    scene.instances.append(copy);
  }
  ViewSession session(2);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  (void)wait_for_pictures(session);
  for (const float z : {0.2f, -0.4f, 7.0f}) {  // the last one makes the scene larger
    Instance moved = scene.instances[5];
    moved.object_to_world.rows[2][3] = z;
    scene.instances.set(Id<Instance>{5}, moved);
    session.set_scene(scene);
    EXPECT_EQ(wait_for_pictures(session).front().rgba, rendered(scene)) << z;
  }
}

TEST(ViewSession, another_scene_is_not_taken_for_the_first) {
  const Scene first = make_scene(1);
  Scene second = make_scene(1);
  second.shapes.clear();
  second.shapes.append(Sphere{{0, 0, 0}, 1e-4f});
  ViewSession session(2);
  session.set_scene(first);
  session.set_view(view_of(first));
  (void)wait_for_pictures(session);
  session.set_scene(second);
  EXPECT_EQ(wait_for_pictures(session).front().rgba, rendered(second));
}

TEST(ViewSession, a_pass_is_shown_as_a_grey) {
  const Scene scene = make_scene(1);
  View view = view_of(scene);
  view.pass = Pass::depth;
  ViewSession session(1);
  session.set_scene(scene);
  session.set_view(view);
  const ViewPicture picture = wait_for_pictures(session).front();
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    ASSERT_NEAR(picture.rgba[i], 3, 1e-3);
    ASSERT_EQ(picture.rgba[i], picture.rgba[i + 2]);
    ASSERT_EQ(picture.rgba[i + 3], 1);
  }
}

TEST(ViewSession, further_passes_have_the_values_of_a_render_and_leave_the_picture_as_it_is) {
  Scene scene = make_scene(3);
  View view = view_of(scene);
  view.further_passes = {Pass::denoising_albedo, Pass::depth};
  ViewSession session(2);
  session.set_scene(scene);
  session.set_view(view);
  const std::vector<ViewPicture> pictures = wait_for_pictures(session);
  EXPECT_EQ(pictures.front().rgba, rendered(scene));
  scene.settings.passes.enable(Pass::denoising_albedo);
  scene.settings.passes.enable(Pass::depth);
  Report report;
  const auto whole = render(prepare(scene, report));
  ASSERT_EQ(pictures.front().further.size(), 2u);
  for (const ViewPass& made : pictures.front().further) EXPECT_EQ(made.values, whole.values(made.pass));
  for (const ViewPicture& picture : pictures) EXPECT_EQ(picture.further.empty(), picture.samples == 0);
}

TEST(ViewSession, pictures_tell_what_was_set_before_them) {
  const Scene scene = make_scene(1);
  ViewSession session(2);
  EXPECT_EQ(session.revision(), 0u);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  EXPECT_EQ(session.revision(), 2u);
  while (!session.status().is_done) std::this_thread::sleep_for(1ms);
  session.set_paused(true);
  session.set_view(view_of(scene));
  // Either that of the first view, which nobody has taken, or one of the second.
  const std::optional<ViewPicture> first = session.take_picture();
  ASSERT_TRUE(first.has_value());
  EXPECT_TRUE(first->revision == 2 || first->revision == 3) << first->revision;
  session.set_paused(false);
  for (const ViewPicture& picture : wait_for_pictures(session)) EXPECT_EQ(picture.revision, 3u);
}

TEST(ViewSession, pausing_ends_refinement_and_going_on_completes_it) {
  const Scene scene = make_scene(4);
  ViewSession session(1);
  session.set_paused(true);
  session.set_scene(scene);
  session.set_view(view_of(scene));
  EXPECT_LT(wait_for_pictures(session).front().samples, 4);
  session.set_paused(false);
  EXPECT_EQ(wait_for_pictures(session).front().rgba, rendered(scene));
}

TEST(ViewSession, ends_promptly_whatever_it_is_at) {
  const Scene scene = make_scene(1 << 20);
  for (const auto wait : {0ms, 1ms, 5ms, 50ms}) {
    ViewSession session(2);
    session.set_scene(scene);
    session.set_view(view_of(scene));
    std::this_thread::sleep_for(wait);
  }
}

TEST(ViewSession, says_once_what_can_not_be_rendered_and_goes_on_with_what_can) {
  Scene scene = make_scene(1);
  Scene bad = scene;
  bad.camera.reset();
  ViewSession session(1);
  session.set_view(view_of(scene));
  session.set_scene(bad);
  bool has_thrown = false;
  try {
    while (!session.status().is_done) std::this_thread::sleep_for(1ms);
    (void)session.status();
  } catch (const SceneError&) {
    has_thrown = true;
  }
  EXPECT_TRUE(has_thrown);
  EXPECT_NO_THROW((void)session.status());
  session.set_scene(scene);
  EXPECT_EQ(wait_for_pictures(session).front().rgba, rendered(scene));
}

}  // namespace
}  // namespace basicrt
