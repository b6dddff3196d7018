// SPDX-License-Identifier: GPL-3.0-or-later
// The scene is named by a hash of what it would be saved as, without the range.
#include "io/sample_range.h"

#include <array>
#include <cstdint>
#include <cstdio>

#include "io/json.h"
#include "io/scene_json.h"
#include "sampling/filter.h"

namespace basicrt {
namespace {

// FNV-1a of 64 bits (Fowler, Noll and Vo).
std::string hash_text(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

bool has_shadow_catchers(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    if (scene.instances[i].is_shadow_catcher) return true;
  return false;
}

}  // namespace

std::string range_metadata(const Scene& scene) {
  const RenderSettings& settings = scene.settings;
  Scene whole = scene;
  whole.settings.samples_from = whole.settings.samples_to = 0;
  const int width = settings.border_width > 0 ? settings.border_width : settings.width - settings.border_x;
  const int height = settings.border_height > 0 ? settings.border_height : settings.height - settings.border_y;
  Json json = {{"version", BASICRT_VERSION},
               {"scene", hash_text(scene_to_json(whole))},
               {"samples", settings.samples},
               {"from", settings.samples_from},
               {"to", settings.samples_end()},
               {"rect", {settings.border_x, settings.border_y, width, height}},
               {"negative_mass", PixelFilter(settings.filter).negative_mass()},
               {"shadow_catchers", has_shadow_catchers(scene)},
               {"passes", Json::array()}};
  for (const PassInfo& info : passes)
    if (settings.passes.has(info.pass)) json["passes"].push_back(info.name);
  return json.dump();
}

std::string sum_channel_name(std::size_t word) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "BasicRT sums.%04u", static_cast<unsigned>(word));
  return name.data();
}

}  // namespace basicrt
