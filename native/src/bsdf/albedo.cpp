// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up the tables of albedos.
#include "bsdf/albedo.h"

#include <algorithm>
#include <cmath>

#include "bsdf/albedo_tables.h"
#include "bsdf/fresnel.h"
#include "bsdf/table_lookup.h"

namespace basicrt {
namespace {

namespace tables = albedo_tables;

float look_up(const std::uint16_t* table, AxisPlace x) { return basicrt::look_up(table, tables::unit, x); }

// Two axes, the roughness last.
float look_up(const std::uint16_t* table, AxisPlace x, AxisPlace roughness) {
  return basicrt::look_up(table, tables::unit, tables::roughnesses, x, roughness);
}

float look_up(const std::uint16_t* table, AxisPlace ior, AxisPlace cosine, AxisPlace roughness) {
  constexpr int slice_size = tables::cosines * tables::roughnesses;
  const std::uint16_t* slice = table + ior.index * slice_size;
  return lerp(look_up(slice, cosine, roughness), look_up(slice + slice_size, cosine, roughness), ior.fraction);
}

AxisPlace find_cosine(float cos_theta) { return find_place(std::sqrt(cos_theta), tables::cosines); }
AxisPlace find_roughness(float roughness) { return find_place(roughness, tables::roughnesses); }

// In [0, 1] along a table's axis of indices, which are at least one.
float ior_coordinate(float ior) { return (ior - 1) / (ior + 1) / tables::greatest_ior_coordinate; }

// For a single scattering that returns `albedo` of light from one direction, and `average` of light from all of them,
// and whose facets return `share` at each bounce. Kulla and Conty 2017, "Revisiting physically based shading at
// Imageworks": the geometric series of bounces.
Color keep_bounces(float albedo, float average, Color share) {
  const Color returned = share * average / (Color(1.0f) - share * (1 - average));
  return Color(1.0f) + returned * ((1 - albedo) / albedo);
}

}  // namespace

Color multiple_scattering(float roughness, float cos_theta, Color mean_fresnel) {
  const AxisPlace r = find_roughness(roughness);
  return keep_bounces(look_up(tables::reflection, find_cosine(cos_theta), r), look_up(tables::reflection_average, r),
                      mean_fresnel);
}

Color glass_multiple_scattering(float roughness, float eta, float cos_theta, Color tint) {
  const bool is_inside = eta < 1;
  const AxisPlace i = find_place(std::sqrt(ior_coordinate(is_inside ? 1 / eta : eta)), tables::iors);
  const AxisPlace r = find_roughness(roughness);
  const std::uint16_t* albedos = is_inside ? tables::glass_from_inside : tables::glass_from_outside;
  const std::uint16_t* averages = is_inside ? tables::glass_from_inside_average : tables::glass_from_outside_average;
  return keep_bounces(look_up(albedos, i, find_cosine(cos_theta), r), look_up(averages, i, r), tint);
}

DielectricLayer dielectric_layer(float roughness, float ior, float cos_theta) {
  const AxisPlace i = find_place(ior_coordinate(ior), tables::iors);
  const float single = look_up(tables::layer, i, find_cosine(cos_theta), find_roughness(roughness));
  const float scale = multiple_scattering(roughness, cos_theta, Color(mean_fresnel_dielectric(ior))).x;
  return {scale, std::min(single * scale, 1.0f)};
}

}  // namespace basicrt
