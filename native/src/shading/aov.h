// SPDX-License-Identifier: GPL-3.0-or-later
// How many passes there are that materials write; they have numbers from 1 on.
#pragma once

namespace basicrt {

inline constexpr int aovs = 16;  // of colours, and of numbers

}  // namespace basicrt
