// SPDX-License-Identifier: GPL-3.0-or-later
// Checked numpy arrays: anything that numpy takes for an array comes in, one clear SceneError comes out of the rest.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <string>
#include <vector>

namespace basicrt::bindings {

// An argument that numpy can make an array of.
class ArrayLike : public pybind11::object {
  PYBIND11_OBJECT(ArrayLike, pybind11::object, is_anything)
  static bool is_anything(PyObject*) { return true; }
};

// One axis of a shape: its exact length, or any.
inline constexpr pybind11::ssize_t any_length = -1;
using ArrayShape = std::vector<pybind11::ssize_t>;

// `value` as a C-contiguous array of one of `shapes`: itself where it is one, else a copy. An array without elements
// has the first shape. Floats take any real numbers that are finite; integers take integers from 0 to 2^32 - 1.
[[nodiscard]] pybind11::array_t<float> float_array(pybind11::handle value, const std::string& item,
                                                   const std::vector<ArrayShape>& shapes);
[[nodiscard]] pybind11::array_t<std::uint32_t> index_array(pybind11::handle value, const std::string& item,
                                                           const std::vector<ArrayShape>& shapes);

// A read-only view of native memory that keeps `owner` alive.
template <class T>
pybind11::array_t<T> read_only_view(const T* data, ArrayShape shape, pybind11::handle owner) {
  pybind11::array_t<T> view(std::move(shape), data, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

}  // namespace basicrt::bindings

namespace pybind11::detail {
template <>
struct handle_type_name<basicrt::bindings::ArrayLike> {
  static constexpr auto name = const_name("numpy.typing.ArrayLike");
};
}  // namespace pybind11::detail
