// SPDX-License-Identifier: GPL-3.0-or-later
// JSON text: parsing with places in messages, and writing in a layout that people can read.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace basicrt {

// Keeps the order of an object's members: it is the order of the scene's tables.
using Json = nlohmann::ordered_json;

// Throws SceneError("<name>:<line>:<column>: …") for text that is not JSON.
[[nodiscard]] Json parse_json(std::string_view text, std::string_view name);

// Arrays of plain values take one line, everything else a line for each member. Ends with a newline.
[[nodiscard]] std::string to_text(const Json& json);

}  // namespace basicrt
