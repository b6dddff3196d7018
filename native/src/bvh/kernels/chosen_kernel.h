// SPDX-License-Identifier: GPL-3.0-or-later
// Which kernel this machine gets.
#pragma once

#include <string_view>

#include "bvh/kernels/kernel.h"

namespace basicrt {

// The best that this machine has, or that which the environment variable BASICRT_ISA names: avx512, avx2, sse42 or scalar. Throws
// std::runtime_error where the machine or the program doesn't have that one.
[[nodiscard]] const Kernel& chosen_kernel();

// The kernel of this name, or the best where it is empty; null where the machine or the program doesn't have it.
[[nodiscard]] const Kernel* find_kernel(std::string_view name);

}  // namespace basicrt
