// SPDX-License-Identifier: GPL-3.0-or-later
// The coefficients that Zeltner, Burley and Chiang 2022 fitted to simulated layers of fibres; the simulation is theirs,
// and the numbers are published with the paper under the Apache License 2.0 (github.com/tizian/ltc-sheen).
#pragma once

#include <cstdint>

namespace basicrt::sheen_tables {

// Nodes lie evenly along the roughness (a row each) and the viewer's cosine.
inline constexpr int nodes = 32;
inline constexpr float unit = 65535;  // this number stands for one

extern const std::uint16_t a[nodes * nodes];
extern const std::uint16_t minus_b[nodes * nodes];
extern const std::uint16_t albedo[nodes * nodes];

}  // namespace basicrt::sheen_tables
