// SPDX-License-Identifier: GPL-3.0-or-later
// Which kernel solves this machine's hits.
#pragma once

#include <string_view>

#include "geometry/kernels/point_kernel.h"

namespace basicrt {

// The best that this machine has, but no better than choose_point_kernel() was told, or until then the environment
// variable BASICRT_ISA says. All give the same numbers.
[[nodiscard]] const PointKernel& chosen_point_kernel();

// From now on the one that goes with this instruction set; with none, as at the start. Any thread may call it.
void choose_point_kernel(std::string_view isa);

// avx2 or plain; null where the machine or the program doesn't have it.
[[nodiscard]] const PointKernel* find_point_kernel(std::string_view name);

}  // namespace basicrt
