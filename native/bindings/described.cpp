// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of binding described structs that don't depend on the struct.
#include "described.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/suggest.h"

namespace basicrt::bindings {
namespace py = pybind11;

std::string field_doc(std::string_view doc, const Range& range) {
  const std::string minimum = number_text(range.minimum);
  std::string text(doc);
  if (std::isfinite(range.maximum))
    text += std::string("; in ") + (range.is_minimum_excluded ? "(" : "[") + minimum + ", " +
            number_text(range.maximum) + "]";
  else if (std::isfinite(range.minimum))
    text += (range.is_minimum_excluded ? "; above " : "; at least ") + minimum;
  return text;
}

std::string to_text(const py::handle value) {
  if (py::isinstance<py::float_>(value)) {
    const std::string text = number_text(value.cast<float>());
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (!py::isinstance<py::tuple>(value)) return one_line_repr(value);
  std::string text;
  for (const py::handle element : value) text += (text.empty() ? "(" : ", ") + to_text(element);
  return text + ")";
}

std::string default_text(const py::object& value) {
  const std::string text = to_text(value);
  try {
    py::module_::import("ast").attr("literal_eval")(text);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_SyntaxError)) throw;
    return "...";
  }
  return text;
}

py::dict bind_arguments(const std::string& function, const std::vector<std::string>& names, const py::args& positional,
                        const py::dict& keywords) {
  if (positional.size() > names.size())
    throw py::type_error(function + "() takes at most " + std::to_string(names.size()) + " arguments, " +
                         std::to_string(positional.size()) + " were given");
  py::dict given;
  for (std::size_t i = 0; i < positional.size(); ++i) given[names[i].c_str()] = positional[i];
  for (const auto& [keyword, value] : keywords) {
    const std::string name = py::str(keyword);
    if (std::ranges::find(names, name) == names.end()) {
      const std::vector<std::string_view> known(names.begin(), names.end());
      throw py::type_error(function + "() has no argument \"" + name + "\": " + suggest(name, known));
    }
    if (given.contains(keyword)) throw py::type_error(function + "() got \"" + name + "\" twice");
    given[keyword] = value;
  }
  return given;
}

}  // namespace basicrt::bindings
