// SPDX-License-Identifier: GPL-3.0-or-later
// What a file with some of a picture's samples says of itself, so that such files can be merged.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace basicrt {

inline constexpr std::string_view range_metadata_key = "basicrt_range";

// JSON: which samples of how many, of which scene, and all that finishing the sums takes.
[[nodiscard]] std::string range_metadata(const Scene& scene);
// The name of an EXR channel with one of the words of each pixel's sums.
[[nodiscard]] std::string sum_channel_name(std::size_t word);

}  // namespace basicrt
