// SPDX-License-Identifier: GPL-3.0-or-later
// Which kernel solves this machine's hits.
#pragma once

#include <string_view>

#include "geometry/kernels/point_kernel.h"

namespace basicrt {

// The best that this machine has, but no better than the environment variable BASICRT_ISA says. All give the same
// numbers.
[[nodiscard]] const PointKernel& chosen_point_kernel();

// avx2 or plain; null where the machine or the program doesn't have it.
[[nodiscard]] const PointKernel* find_point_kernel(std::string_view name);

}  // namespace basicrt
