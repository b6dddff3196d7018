// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up the tables of albedos.
#include "bsdf/albedo.h"

#include <algorithm>
#include <cmath>

#include "bsdf/albedo_tables.h"
#include "bsdf/fresnel.h"

namespace basicrt {
namespace {

namespace tables = albedo_tables;

// A place on an axis of `nodes` nodes, for a coordinate in [0, 1].
struct AxisPlace {
  int index;
  float fraction;
};

AxisPlace find_place(float coordinate, int nodes) {
  const float place = std::clamp(coordinate, 0.0f, 1.0f) * static_cast<float>(nodes - 1);
  const int index = std::min(static_cast<int>(place), nodes - 2);
  return {index, place - static_cast<float>(index)};
}

float look_up(const std::uint16_t* table, AxisPlace x) {
  return lerp(float(table[x.index]), float(table[x.index + 1]), x.fraction) / tables::unit;
}

float look_up(const std::uint16_t* table, AxisPlace cosine, AxisPlace roughness) {
  const std::uint16_t* row = table + cosine.index * tables::roughnesses;
  return lerp(look_up(row, roughness), look_up(row + tables::roughnesses, roughness), cosine.fraction);
}

float look_up(const std::uint16_t* table, AxisPlace i, float cos_theta, float roughness) {
  const AxisPlace c = find_place(std::sqrt(cos_theta), tables::cosines);
  const AxisPlace r = find_place(roughness, tables::roughnesses);
  const std::uint16_t* slice = table + i.index * tables::cosines * tables::roughnesses;
  return lerp(look_up(slice, c, r), look_up(slice + tables::cosines * tables::roughnesses, c, r), i.fraction);
}

// In [0, 1] along a table's axis of indices, which are at least one.
float ior_coordinate(float ior) { return (ior - 1) / (ior + 1) / tables::greatest_ior_coordinate; }

}  // namespace

Color multiple_scattering(float roughness, float cos_theta, Color mean_fresnel) {
  const AxisPlace r = find_place(roughness, tables::roughnesses);
  const float albedo = look_up(tables::reflection, find_place(std::sqrt(cos_theta), tables::cosines), r);
  const float average = look_up(tables::reflection_average, r);
  // Kulla and Conty 2017, "Revisiting physically based shading at Imageworks": the geometric series of bounces.
  const Color returned = mean_fresnel * average / (Color(1.0f) - mean_fresnel * (1 - average));
  return Color(1.0f) + returned * ((1 - albedo) / albedo);
}

float glass_multiple_scattering(float roughness, float eta, float cos_theta) {
  const bool is_inside = eta < 1;
  const AxisPlace i = find_place(std::sqrt(ior_coordinate(is_inside ? 1 / eta : eta)), tables::iors);
  const std::uint16_t* table = is_inside ? tables::glass_from_inside : tables::glass_from_outside;
  return 1 / look_up(table, i, cos_theta, roughness);
}

DielectricLayer dielectric_layer(float roughness, float ior, float cos_theta) {
  const AxisPlace i = find_place(ior_coordinate(ior), tables::iors);
  const float single = look_up(tables::layer, i, cos_theta, roughness);
  const float scale = multiple_scattering(roughness, cos_theta, Color(mean_fresnel_dielectric(ior))).x;
  return {scale, std::min(single * scale, 1.0f)};
}

}  // namespace basicrt
