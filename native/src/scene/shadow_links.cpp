// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/shadow_links.h"

#include <algorithm>

namespace basicrt {

std::vector<LinkSets> find_shadow_links(const Scene& scene) {
  std::vector<LinkSets> links;
  const auto add = [&](LinkSets blockers) {
    if (!blockers.is_all() && std::ranges::find(links, blockers) == links.end()) links.push_back(blockers);
  };
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
    std::visit([&](const auto& lamp) { add(lamp.blocker_sets); }, scene.lights[i]);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) add(scene.instances[i].blocker_sets);
  return links;
}

}  // namespace basicrt
