// SPDX-License-Identifier: GPL-3.0-or-later
// Which kernel this machine gets.
#pragma once

#include <string_view>
#include <vector>

#include "bvh/kernels/kernel.h"

namespace basicrt {

// That which choose_kernel() was told; until then that which the environment variable BASICRT_ISA names (avx512, avx2, sse42 or
// scalar), or else the best that this machine has. Throws SceneError where the machine or the program doesn't have the one
// that the variable names.
[[nodiscard]] const Kernel& chosen_kernel();

// From now on rays are traced by the kernel of this name, and hits solved by what goes with it, in what is being rendered too: all
// find the same hits, so that pictures stay the same. An empty name leaves the choice to the variable and the machine again. Throws
// SceneError where the machine or the program doesn't have it. Any thread may call it.
void choose_kernel(std::string_view name);

// Of those that the machine and the program have, the best first.
[[nodiscard]] std::vector<std::string_view> kernel_names();

// The kernel of this name, or the best where it is empty; null where the machine or the program doesn't have it.
[[nodiscard]] const Kernel* find_kernel(std::string_view name);

}  // namespace basicrt
