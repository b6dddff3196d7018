// SPDX-License-Identifier: GPL-3.0-or-later
// The exception for bad input: it names the item, the rule and the value.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace basicrt {

// what() reads "<item>: <rule and value>", as in "materials[3].roughness: must be in [0, 1], is 1.5".
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string_view item, std::string_view problem)
      : std::runtime_error(std::string(item) + ": " + std::string(problem)) {}
};

}  // namespace basicrt
