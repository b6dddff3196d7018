// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes from text.
#pragma once

#include <string>
#include <string_view>

#include "base/report.h"
#include "error_of.h"
#include "io/scene_json.h"

namespace basicrt {

inline Scene scene_of(std::string_view json, Report& report) { return parse_scene(json, ".", "test.json", report); }
inline Scene scene_of(std::string_view json) {
  Report report;
  return scene_of(json, report);
}
inline std::string load_problem_of(std::string_view json) {
  return error_of([&] { (void)scene_of(json); });
}

}  // namespace basicrt
