// SPDX-License-Identifier: GPL-3.0-or-later
// Checks numpy arrays before native code reads them.
#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "base/validate_fields.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

std::string to_text(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (const py::ssize_t length : shape) {
    if (text.size() > 1) text += ", ";
    text += length == any_length ? "N" : std::to_string(length);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::vector<py::ssize_t> shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

bool has_shape(const py::array& array, const ArrayShape& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t axis = 0; axis < shape.size(); ++axis)
    if (shape[axis] != any_length && array.shape(static_cast<py::ssize_t>(axis)) != shape[axis]) return false;
  return true;
}

bool may_be_empty(const ArrayShape& shape) {
  return std::ranges::any_of(shape, [](py::ssize_t length) { return length <= 0; });
}

// "[3, 1]": where in an array of this shape the element stands.
std::string position_text(const py::array& array, py::ssize_t element) {
  std::string text;
  for (py::ssize_t axis = array.ndim() - 1; axis >= 0; --axis) {
    text = std::to_string(element % array.shape(axis)) + (text.empty() ? "" : ", ") + text;
    element /= array.shape(axis);
  }
  return "[" + text + "]";
}

py::array checked_shape(py::handle value, const std::string& item, const std::vector<ArrayShape>& shapes,
                        std::string_view kinds, std::string_view rule) {
  py::array array;
  try {
    array = py::module_::import("numpy").attr("asarray")(value);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw SceneError(item, "can't be made an array: " + py::str(error.value()).cast<std::string>());
  }
  if (array.size() == 0 && may_be_empty(shapes.front())) {
    ArrayShape empty = shapes.front();
    for (py::ssize_t& length : empty) length = std::max<py::ssize_t>(length, 0);
    return py::array(array.dtype(), empty);
  }
  if (kinds.find(array.dtype().kind()) == std::string_view::npos)
    throw SceneError(item, std::string(rule) + ", is of " + py::str(array.dtype()).cast<std::string>());
  for (const ArrayShape& shape : shapes)
    if (has_shape(array, shape)) return array;

  std::string allowed;
  for (const ArrayShape& shape : shapes) allowed += (allowed.empty() ? "" : " or ") + to_text(shape);
  throw SceneError(item, "must have the shape " + allowed + ", is " + to_text(shape_of(array)));
}

}  // namespace

py::array_t<float> float_array(py::handle value, const std::string& item, const std::vector<ArrayShape>& shapes) {
  const py::array array = checked_shape(value, item, shapes, "fiu", "must hold real numbers");
  const py::array_t<float, py::array::c_style | py::array::forcecast> floats(array);
  for (py::ssize_t i = 0; i < floats.size(); ++i)
    if (!std::isfinite(floats.data()[i]))
      throw SceneError(item + position_text(floats, i), "must be a finite number, is " + number_text(floats.data()[i]));
  return floats;
}

py::array_t<std::uint32_t> index_array(py::handle value, const std::string& item,
                                       const std::vector<ArrayShape>& shapes) {
  const py::array array = checked_shape(value, item, shapes, "iu", "must hold integers");
  if (array.dtype().is(py::dtype::of<std::uint32_t>()))
    return py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>(array);

  // By way of 64 bits, so that a negative or too large number can't wrap around unseen.
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(array);
  py::array_t<std::uint32_t> indices(shape_of(array));
  for (py::ssize_t i = 0; i < wide.size(); ++i) {
    const std::int64_t index = wide.data()[i];
    if (index < 0 || index > std::numeric_limits<std::uint32_t>::max())
      throw SceneError(item + position_text(wide, i), "must be in [0, 2^32), is " + std::to_string(index));
    indices.mutable_data()[i] = static_cast<std::uint32_t>(index);
  }
  return indices;
}

}  // namespace basicrt::bindings
