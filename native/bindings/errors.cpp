// SPDX-License-Identifier: GPL-3.0-or-later
// SceneError, SceneWarning and the messages that the bindings make themselves.
#include "errors.h"

#include "base/error.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

std::string describe_value(py::handle value) {
  constexpr std::size_t longest = 80;
  std::string text = one_line_repr(value);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

py::handle scene_warning() {
  PYBIND11_CONSTINIT static py::gil_safe_call_once_and_store<py::object> warning;
  return warning
      .call_once_and_store_result([] {
        const char* doc = "Part of a scene was changed or left out; the rest can be rendered.";
        PyObject* type = PyErr_NewExceptionWithDoc("basicrt._native.SceneWarning", doc, PyExc_UserWarning, nullptr);
        if (!type) throw py::error_already_set();
        return py::reinterpret_steal<py::object>(type);
      })
      .get_stored();
}

}  // namespace

std::string one_line_repr(py::handle value) {
  return py::str(" ").attr("join")(py::repr(value).attr("split")()).cast<std::string>();
}

void refuse_value(const std::string& item, std::string_view rule, py::handle value) {
  throw SceneError(item, std::string(rule) + ", is " + describe_value(value));
}

void refuse_type(const std::string& item, std::string_view rule, py::handle value) {
  throw py::type_error(item + ": " + std::string(rule) + ", is " + describe_value(value));
}

void issue_warnings(const Report& report, int stack_level) {
  for (const std::string& message : report.warnings())
    if (PyErr_WarnEx(scene_warning().ptr(), message.c_str(), stack_level) < 0) throw py::error_already_set();
}

void register_errors(py::module_& m) {
  py::register_exception<SceneError>(m, "SceneError", PyExc_ValueError).doc() =
      "Something can't be rendered: the message names the item, the rule and the value.";
  m.add_object("SceneWarning", scene_warning());
}

}  // namespace basicrt::bindings
