// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of shapes' arrays, which throw a SceneError that names the array.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "geometry/mesh.h"

namespace basicrt {

inline std::string array_entry(std::string_view item, std::string_view array, std::size_t index) {
  return std::string(item) + "." + std::string(array) + "[" + std::to_string(index) + "]";
}

// Entries have numbers of 30 bits in trees.
inline void check_count(std::string_view item, std::string_view array, std::size_t count) {
  constexpr std::size_t limit = 0x3F80'0000;
  if (count >= limit)
    throw SceneError(std::string(item) + "." + std::string(array),
                     "must have fewer than " + std::to_string(limit) + " entries, has " + std::to_string(count));
}

inline void check_exact_length(std::string_view item, std::string_view array, std::size_t length, std::size_t expected,
                               std::string_view rule) {
  if (length == expected) return;
  throw SceneError(
      std::string(item) + "." + std::string(array),
      "must have " + std::string(rule) + " (" + std::to_string(expected) + "), has " + std::to_string(length));
}

// The array may also be left out.
inline void check_length(std::string_view item, std::string_view array, std::size_t length, std::size_t expected,
                         std::string_view rule) {
  if (length == 0 || length == expected) return;
  throw SceneError(
      std::string(item) + "." + std::string(array),
      "must have " + std::string(rule) + " (" + std::to_string(expected) + ") or none, has " + std::to_string(length));
}

inline bool is_finite_entry(float x) { return std::isfinite(x); }
inline bool is_finite_entry(Vec2f v) { return std::isfinite(v.x) && std::isfinite(v.y); }
inline bool is_finite_entry(Vec3f v) { return is_finite(v); }

template <class V>
void check_finite(std::string_view item, std::string_view array, const std::vector<V>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_finite_entry(values[i]))
      throw SceneError(array_entry(item, array, i), "must be finite, is NaN or infinite");
}

inline void check_radii(std::string_view item, const std::vector<float>& radii) {
  for (std::size_t i = 0; i < radii.size(); ++i)
    if (!(radii[i] >= 0 && std::isfinite(radii[i])))
      throw SceneError(array_entry(item, "radii", i), "must be at least 0 and finite, is " + std::to_string(radii[i]));
}

// How many values an attribute has that belongs to the domain.
struct DomainSize {
  AttributeDomain domain;
  std::size_t count;
};

inline void check_attributes(std::string_view item, const std::vector<MeshAttribute>& attributes,
                             std::initializer_list<DomainSize> domains) {
  for (const MeshAttribute& attribute : attributes) {
    const std::string name = "attributes[\"" + attribute.name + "\"]";
    const auto* const found = std::ranges::find(domains, attribute.domain, &DomainSize::domain);
    const std::string_view domain = enum_names<AttributeDomain>[static_cast<std::size_t>(attribute.domain)];
    if (found == domains.end())
      throw SceneError(std::string(item) + "." + name,
                       "has the domain " + std::string(domain) + ", which this kind of shape does not have");
    check_exact_length(item, name, attribute.values.size(), found->count, "one value for each " + std::string(domain));
    check_finite(item, name, attribute.values);
  }
}

}  // namespace basicrt
