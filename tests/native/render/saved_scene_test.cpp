// SPDX-License-Identifier: GPL-3.0-or-later
// A saved scene gives the picture of the scene that was saved.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/scene_text.h"
#include "render/session.h"

namespace basicrt {
namespace {

Film render_small(Scene scene) {
  scene.settings.width = 48;
  scene.settings.height = 32;
  scene.settings.samples = 4;
  Report report;
  return render(prepare(scene, report));
}

TEST(SavedScene, renders_to_the_same_bytes) {
  for (const char* name : {"cbox_no_light_refract", "cbox_path", "materials"}) {
    Report report;
    const Scene scene = load_scene(std::filesystem::path(BASICRT_SOURCE_DIR) / "scenes" / name / "scene.json", report);
    const Film film = render_small(scene), film_of_saved = render_small(scene_of(scene_to_json(scene)));
    for (const PassInfo& info : passes) EXPECT_EQ(film.values(info.pass), film_of_saved.values(info.pass)) << name;
  }
}

}  // namespace
}  // namespace basicrt
