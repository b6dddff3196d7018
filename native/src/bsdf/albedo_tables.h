// SPDX-License-Identifier: GPL-3.0-or-later
// Precomputed shares of light that GGX microfacets return after a single scattering; tools/make_albedo_tables.py makes
// them and says how.
#pragma once

#include <cstdint>

namespace basicrt::albedo_tables {

// Nodes lie evenly along the square root of the cosine, the roughness (the square root of alpha), and the index: as
// x = (ior - 1) / (ior + 1) for a layer, the square root of that for glass, from 0 to x = greatest_ior_coordinate
// (ior 9). The roughness changes fastest, the index slowest.
inline constexpr int cosines = 24, roughnesses = 24, iors = 14;
inline constexpr float greatest_ior_coordinate = 0.8f;
inline constexpr float unit = 65535;  // this number stands for one

extern const std::uint16_t reflection[cosines * roughnesses];                 // perfectly reflecting facets
extern const std::uint16_t reflection_average[roughnesses];                   // over the cosine-weighted hemisphere
extern const std::uint16_t layer[iors * cosines * roughnesses];               // reflected by a dielectric, from outside
extern const std::uint16_t glass_from_outside[iors * cosines * roughnesses];  // reflected and refracted together
extern const std::uint16_t glass_from_inside[iors * cosines * roughnesses];
extern const std::uint16_t glass_from_outside_average[iors * roughnesses];
extern const std::uint16_t glass_from_inside_average[iors * roughnesses];

}  // namespace basicrt::albedo_tables
