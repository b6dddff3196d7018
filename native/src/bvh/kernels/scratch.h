// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that a kernel works in.
#pragma once

#include <cstddef>

namespace basicrt {

// At least `size` bytes that belong to this thread, aligned to 64, the same at each call.
[[nodiscard]] void* kernel_scratch(std::size_t size);

}  // namespace basicrt
