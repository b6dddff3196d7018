// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up the fitted coefficients of the sheen layer.
#include "bsdf/sheen.h"

#include "bsdf/sheen_tables.h"

namespace basicrt {
namespace {

namespace tables = sheen_tables;

struct Place {
  int index;
  float fraction;
};
Place find_place(float coordinate) {
  const float place = std::clamp(coordinate, 0.0f, 1.0f) * static_cast<float>(tables::nodes - 1);
  const int index = std::min(static_cast<int>(place), tables::nodes - 2);
  return {index, place - static_cast<float>(index)};
}

float look_up(const std::uint16_t* table, Place roughness, Place cosine) {
  const auto along_row = [&](const std::uint16_t* row) {
    return lerp(float(row[cosine.index]), float(row[cosine.index + 1]), cosine.fraction);
  };
  const std::uint16_t* row = table + roughness.index * tables::nodes;
  return lerp(along_row(row), along_row(row + tables::nodes), roughness.fraction) / tables::unit;
}

}  // namespace

std::optional<SheenLayer> make_sheen(float roughness, Vec3f wo) {
  if (!(wo.z > 0)) return std::nullopt;
  const Place r = find_place(std::max(roughness, 1e-3f)), c = find_place(wo.z);
  const float a = look_up(tables::a, r, c), b = -look_up(tables::minus_b, r, c), albedo = look_up(tables::albedo, r, c);
  if (!(a > 1e-5f) || !(albedo > 1e-5f)) return std::nullopt;
  const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
  const bool is_above = !(sine > 1e-6f);
  return SheenLayer{{a, b, is_above ? 1 : wo.x / sine, is_above ? 0 : wo.y / sine}, albedo};
}

}  // namespace basicrt
