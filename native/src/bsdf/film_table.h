// SPDX-License-Identifier: GPL-3.0-or-later
// The Fourier transform of the eye's sensitivities; tools/make_film_table.py makes it and says how.
#pragma once

#include <cstdint>

namespace basicrt::film_table {

// Nodes lie evenly along the difference of optical paths, from zero to the greatest, in nanometres: beyond, light no
// longer interferes with itself.
inline constexpr int nodes = 512;
inline constexpr float greatest_difference = 9600;
inline constexpr float unit = 16384;  // this number stands for one

extern const std::int16_t sensitivity[6][nodes];  // real parts of red, green and blue, then the imaginary ones

}  // namespace basicrt::film_table
