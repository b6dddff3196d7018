// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of lights, whose light has passes of its own: they are numbered from 1 on, 0 is none.
#pragma once

namespace basicrt {

inline constexpr int light_groups = 16;

}  // namespace basicrt
