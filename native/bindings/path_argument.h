// SPDX-License-Identifier: GPL-3.0-or-later
// An argument that names a file.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

namespace basicrt::bindings {

class PathArgument : public pybind11::object {
  PYBIND11_OBJECT(PathArgument, pybind11::object, is_anything)
  static bool is_anything(PyObject*) { return true; }
  // Throws a TypeError where it is no path.
  [[nodiscard]] std::filesystem::path read() const {
    pybind11::detail::make_caster<std::filesystem::path> caster;
    if (!caster.load(*this, /*convert=*/true))
      throw pybind11::type_error("a path must be a str or os.PathLike, is " +
                                 pybind11::repr(*this).cast<std::string>());
    return pybind11::detail::cast_op<std::filesystem::path&>(caster);
  }
};

}  // namespace basicrt::bindings

namespace pybind11::detail {
template <>
struct handle_type_name<basicrt::bindings::PathArgument> {
  static constexpr auto name = const_name("str | os.PathLike[str]");
};
}  // namespace pybind11::detail
