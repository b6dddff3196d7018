// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values to JSON, so that reading them gives the same bits.
#pragma once

#include <type_traits>
#include <vector>

#include "base/describe.h"
#include "io/json.h"
#include "light/link_sets.h"
#include "math/transform.h"
#include "math/vec.h"

namespace basicrt {

// With the fewest digits that read back as the same float; null for what JSON can't say, infinity.
[[nodiscard]] Json write(float value);
[[nodiscard]] Json write(Vec2f value);
[[nodiscard]] Json write(Vec3f value);
[[nodiscard]] Json write(const Transform& value);  // 16 numbers, row by row
// Null for none.
[[nodiscard]] Json write(const std::vector<float>& values);
[[nodiscard]] Json write(const std::vector<Transform>& values);

// Their numbers; null for all.
[[nodiscard]] Json write(LinkSets sets);

template <class T>
  requires std::is_integral_v<T>
[[nodiscard]] Json write(T value) {
  return value;
}

template <class Enum>
  requires std::is_enum_v<Enum>
[[nodiscard]] Json write(Enum value) {
  return enum_names<Enum>[static_cast<std::size_t>(value)];
}

// One flat array.
template <class Array>
[[nodiscard]] Json write_array(const Array& values) {
  Json json = Json::array();
  for (const auto& value : values) {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_scalar_v<T>)
      json.push_back(write(value));
    else if constexpr (requires { value.size(); })
      for (const auto element : value) json.push_back(write(element));
    else
      for (const Json& element : write(value)) json.push_back(element);
  }
  return json;
}

}  // namespace basicrt
