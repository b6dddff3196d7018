// SPDX-License-Identifier: GPL-3.0-or-later
// Floats in decimal, exactly.
#include "io/json_write.h"

#include <charconv>
#include <cmath>

namespace basicrt {

Json write(float value) {
  if (!std::isfinite(value)) return nullptr;
  // The library writes doubles: give it the double that the float's shortest text stands for, which it writes alike.
  char buffer[32];
  const char* end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  double shortest = 0;
  std::from_chars(buffer, end, shortest);
  const bool is_exact = static_cast<float>(shortest) == value;
  return is_exact ? shortest : static_cast<double>(value);
}

Json write(Vec2f value) { return Json::array({write(value.x), write(value.y)}); }
Json write(Vec3f value) { return Json::array({write(value.x), write(value.y), write(value.z)}); }

Json write(const Transform& value) {
  Json json = Json::array();
  for (const auto& row : value.rows)
    for (const float number : row) json.push_back(write(number));
  for (const float number : {0.0f, 0.0f, 0.0f, 1.0f}) json.push_back(write(number));
  return json;
}

Json write(const std::vector<float>& values) { return values.empty() ? Json(nullptr) : write_array(values); }
Json write(LinkSets sets) {
  if (sets.is_all()) return nullptr;
  Json json = Json::array();
  for (int set = 0; set < LinkSets::count; ++set)
    if (sets.has(set)) json.push_back(set);
  return json;
}

Json write(const std::vector<Transform>& values) {
  if (values.empty()) return nullptr;
  Json json = Json::array();
  for (const Transform& value : values) json.push_back(write(value));
  return json;
}

}  // namespace basicrt
