// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzes what builds trees and what walks them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace basicrt::fuzz {

// Makes shapes, instances and rays of any bytes; builds trees with every builder, refits them, and traces with every kernel of this machine.
// Returns what is wrong, or an empty string: trees must be sound, kernels must agree bit for bit, in a batch as alone, and with double
// precision within rounding; no ray leaves a closed mesh; rays of unusable numbers miss.
[[nodiscard]] std::string find_trees_fault(std::span<const std::uint8_t> bytes);

}  // namespace basicrt::fuzz
