// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up the fitted coefficients of the sheen layer.
#include "bsdf/sheen.h"

#include "bsdf/sheen_tables.h"
#include "bsdf/table_lookup.h"

namespace basicrt {
namespace {

namespace tables = sheen_tables;

float look_up(const std::uint16_t* table, AxisPlace roughness, AxisPlace cosine) {
  return basicrt::look_up(table, tables::unit, tables::nodes, roughness, cosine);
}

}  // namespace

std::optional<SheenLayer> make_sheen(float roughness, Vec3f wo) {
  if (!(wo.z > 0)) return std::nullopt;
  const AxisPlace r = find_place(std::max(roughness, 1e-3f), tables::nodes), c = find_place(wo.z, tables::nodes);
  const float a = look_up(tables::a, r, c), b = -look_up(tables::minus_b, r, c), albedo = look_up(tables::albedo, r, c);
  if (!(a > 1e-5f) || !(albedo > 1e-5f)) return std::nullopt;
  const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
  const bool is_above = !(sine > 1e-6f);
  return SheenLayer{{a, b, is_above ? 1 : wo.x / sine, is_above ? 0 : wo.y / sine}, albedo};
}

}  // namespace basicrt
