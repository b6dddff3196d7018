// SPDX-License-Identifier: GPL-3.0-or-later
// Which names the ids of mattes stand for.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace basicrt {

[[nodiscard]] inline const std::string& asset_name(const Instance& instance) {
  return instance.asset_name.empty() ? instance.name : instance.asset_name;
}

// Entries of an EXR header for the mattes among the scene's passes; `prefix` comes before the layers' names.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> matte_metadata(const Scene& scene,
                                                                              std::string_view prefix = {});

}  // namespace basicrt
