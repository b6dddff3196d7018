// SPDX-License-Identifier: GPL-3.0-or-later
// Conversions between Python objects and the types of described fields.
#include "values.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "arrays.h"
#include "base/error.h"
#include "base/suggest.h"
#include "base/validate_fields.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

// After a conversion that failed: forgets why, unless that was something else, such as an interrupt.
void clear_conversion_error() {
  for (PyObject* kind : {PyExc_TypeError, PyExc_ValueError, PyExc_OverflowError})
    if (PyErr_ExceptionMatches(kind)) return PyErr_Clear();
  throw py::error_already_set();
}

// A number from anything with __float__ or __index__ (numpy's scalars among them), or nothing.
std::optional<double> to_double(py::handle value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number != -1.0 || !PyErr_Occurred()) return number;
  clear_conversion_error();
  return std::nullopt;
}

// An integer from anything with __index__, clamped to 64 bits, or nothing.
std::optional<std::int64_t> to_integer(py::handle value) {
  const py::object integer = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!integer) {
    clear_conversion_error();
    return std::nullopt;
  }
  int overflow = 0;
  const std::int64_t number = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
  if (overflow != 0)
    return overflow > 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
  return number;
}

template <std::size_t size>
std::array<float, size> read_numbers(py::handle value, const std::string& item, const char* rule) {
  const auto elements = py::reinterpret_steal<py::object>(PySequence_Fast(value.ptr(), ""));
  if (!elements) {
    clear_conversion_error();
    refuse_type(item, rule, value);
  }
  std::array<float, size> numbers{};
  if (PySequence_Fast_GET_SIZE(elements.ptr()) != size) refuse_value(item, rule, value);
  for (std::size_t i = 0; i < size; ++i) {
    const std::optional<double> number = to_double(PySequence_Fast_GET_ITEM(elements.ptr(), i));
    if (!number) refuse_type(item, rule, value);
    numbers[i] = static_cast<float>(*number);
  }
  return numbers;
}

}  // namespace

float PythonValue<float>::read(py::handle value, const std::string& item) {
  const std::optional<double> number = to_double(value);
  if (!number) refuse_type(item, "must be a number", value);
  return static_cast<float>(*number);
}

template <class Integer>
  requires std::is_same_v<Integer, int> || std::is_same_v<Integer, std::int64_t>
Integer PythonValue<Integer>::read(py::handle value, const std::string& item) {
  const std::optional<std::int64_t> number = to_integer(value);
  if (!number) refuse_type(item, "must be an integer", value);
  if (*number < std::numeric_limits<Integer>::min() || *number > std::numeric_limits<Integer>::max())
    refuse_value(item, "must fit into " + std::to_string(8 * sizeof(Integer)) + " bits", value);
  return static_cast<Integer>(*number);
}
template struct PythonValue<int>;
template struct PythonValue<std::int64_t>;

bool PythonValue<bool>::read(py::handle value, const std::string& item) {
  py::detail::make_caster<bool> caster;
  if (!caster.load(value, /*convert=*/false)) refuse_type(item, "must be True or False", value);
  return py::detail::cast_op<bool>(caster);
}

std::string PythonValue<std::string>::read(py::handle value, const std::string& item) {
  if (!py::isinstance<py::str>(value)) refuse_type(item, "must be a string", value);
  return value.cast<std::string>();
}

Vec2f PythonValue<Vec2f>::read(py::handle value, const std::string& item) {
  const auto [x, y] = read_numbers<2>(value, item, "must be two numbers");
  return {x, y};
}

Vec3f PythonValue<Vec3f>::read(py::handle value, const std::string& item) {
  const auto [x, y, z] = read_numbers<3>(value, item, "must be three numbers");
  return {x, y, z};
}

Transform PythonValue<Transform>::read(py::handle value, const std::string& item) {
  const py::array_t<float> matrix = float_array(value, item, {{4, 4}, {3, 4}});
  const auto m = matrix.unchecked<2>();
  Transform transform;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) transform.rows[row][column] = m(row, column);
  if (m.shape(0) == 4 && (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1))
    refuse_value(item, "must have the last row 0 0 0 1", value);
  return transform;
}

py::object PythonValue<Transform>::write(const Transform& value) {
  py::array_t<float> matrix({4, 4});
  auto m = matrix.mutable_unchecked<2>();
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) m(row, column) = value.rows[row][column];
    m(3, column) = column == 3 ? 1.0f : 0.0f;
  }
  return matrix;
}

LinkSets PythonValue<LinkSets>::read(py::handle value, const std::string& item) {
  if (value.is_none()) return {};
  LinkSets sets = LinkSets::none();
  for (const int set : PythonValue<std::vector<int>>::read(value, item)) {
    validate_field(set, within(0, LinkSets::count - 1), item, "");
    sets.add(set);
  }
  return sets;
}

py::object PythonValue<LinkSets>::write(LinkSets value) {
  if (value.is_all()) return py::none();
  py::list sets;
  for (int set = 0; set < LinkSets::count; ++set)
    if (value.has(set)) sets.append(set);
  return sets;
}

ColorInput PythonValue<ColorInput>::read(py::handle value, const std::string& item) {
  ColorInput color;
  if (py::isinstance<OperationIndex>(value)) return value.cast<OperationIndex>();
  if (py::isinstance<TextureRef>(value)) {
    color.texture = Id<Texture>{value.cast<TextureRef>().index};
  } else {
    const auto [r, g, b] = read_numbers<3>(value, item, "must be three numbers, a TextureRef or an OperationRef");
    color.constant = {r, g, b};
  }
  return color;
}

py::object PythonValue<ColorInput>::write(const ColorInput& value) {
  if (value.operation.is_valid()) return py::cast(value.operation);
  if (value.texture.is_valid()) return py::cast(TextureRef{value.texture.index});
  return PythonValue<Vec3f>::write(value.constant);
}

NumberInput PythonValue<NumberInput>::read(py::handle value, const std::string& item) {
  if (py::isinstance<OperationIndex>(value)) return value.cast<OperationIndex>();
  NumberInput share;
  if (py::isinstance<TextureRef>(value)) {
    const TextureRef reference = value.cast<TextureRef>();
    share.texture = Id<Texture>{reference.index};
    share.is_alpha = reference.is_alpha;
    return share;
  }
  const std::optional<double> number = to_double(value);
  if (!number) refuse_type(item, "must be a number, a TextureRef or an OperationRef", value);
  share.constant = static_cast<float>(*number);
  return share;
}

py::object PythonValue<NumberInput>::write(const NumberInput& value) {
  if (value.operation.is_valid()) return py::cast(value.operation);
  if (value.texture.is_valid()) return py::cast(TextureRef{value.texture.index, value.is_alpha});
  return py::float_(value.constant);
}

NodeIndex PythonValue<NodeIndex>::read(py::handle value, const std::string& item) {
  if (value.is_none()) return no_node;
  const std::optional<std::int64_t> index = to_integer(value);
  if (!index) refuse_type(item, "must be an index or None", value);
  if (*index < 0 || *index >= no_node) refuse_value(item, "must be in [0, 2^32 - 1)", value);
  return static_cast<NodeIndex>(*index);
}

py::object PythonValue<NodeIndex>::write(NodeIndex value) {
  if (value == no_node) return py::none();
  return py::int_(value);
}

std::size_t read_enum(py::handle value, const std::string& item, std::span<const std::string_view> names) {
  if (!py::isinstance<py::str>(value)) refuse_type(item, "must be a string", value);
  const auto name = value.cast<std::string>();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw SceneError(item, "unknown name \"" + name + "\": " + suggest(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace basicrt::bindings
