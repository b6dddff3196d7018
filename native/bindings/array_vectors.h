// SPDX-License-Identifier: GPL-3.0-or-later
// Between numpy arrays and shapes' own vectors.
#pragma once

#include <cstring>
#include <string>
#include <tuple>
#include <vector>

#include "arrays.h"
#include "described.h"
#include "geometry/mesh.h"

namespace basicrt::bindings {

// What the arrays hold, as the shape's own elements. Each element is so many numbers in a row.
template <class Element, class T>
std::vector<Element> to_vector(const pybind11::array_t<T>& array) {
  static_assert(sizeof(Element) % sizeof(T) == 0);
  std::vector<Element> elements(static_cast<std::size_t>(array.size()) * sizeof(T) / sizeof(Element));
  if (!elements.empty())
    std::memcpy(static_cast<void*>(elements.data()), array.data(), elements.size() * sizeof(Element));
  return elements;
}

// An attribute's name, its domain and its values.
using NamedArray = std::tuple<std::string, std::string, ArrayLike>;

inline std::vector<MeshAttribute> to_attributes(const std::vector<NamedArray>& attributes, const std::string& item) {
  std::vector<MeshAttribute> result;
  for (const auto& [name, domain, values] : attributes)
    result.push_back({name, PythonValue<AttributeDomain>::read(pybind11::str(domain), item),
                      to_vector<Vec3f>(float_array(values, "attributes", {{any_length, 3}}))});
  return result;
}

// A view of each.
inline std::vector<std::tuple<std::string, std::string, pybind11::array_t<float>>> attribute_views(
    const std::vector<MeshAttribute>& attributes, const pybind11::object& owner) {
  std::vector<std::tuple<std::string, std::string, pybind11::array_t<float>>> views;
  for (const MeshAttribute& attribute : attributes)
    views.emplace_back(attribute.name, enum_names<AttributeDomain>[static_cast<std::size_t>(attribute.domain)],
                       read_only_view(reinterpret_cast<const float*>(attribute.values.data()),
                                      {static_cast<pybind11::ssize_t>(attribute.values.size()), 3}, owner));
  return views;
}

}  // namespace basicrt::bindings
