// SPDX-License-Identifier: GPL-3.0-or-later
// Which choices of blockers the lights of a scene make.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace basicrt {

// Each once, in the order of lamps, then instances; of those that all blockers dim, none.
[[nodiscard]] std::vector<LinkSets> find_shadow_links(const Scene& scene);

}  // namespace basicrt
