// SPDX-License-Identifier: GPL-3.0-or-later
// How the native core's complaints reach Python.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <string_view>

#include "base/report.h"

namespace basicrt::bindings {

// repr(value) without line breaks and runs of spaces.
[[nodiscard]] std::string one_line_repr(pybind11::handle value);

// `"<item>: <rule>, is <value>"` as a SceneError: the value is of the right type and wrong all the same.
[[noreturn]] void refuse_value(const std::string& item, std::string_view rule, pybind11::handle value);
// The same as a TypeError.
[[noreturn]] void refuse_type(const std::string& item, std::string_view rule, pybind11::handle value);

// Issues each warning as a basicrt.SceneWarning that points at the caller `stack_level` frames up, 1 being the
// innermost Python function. Throws where the user has made warnings errors.
void issue_warnings(const Report& report, int stack_level);

}  // namespace basicrt::bindings
