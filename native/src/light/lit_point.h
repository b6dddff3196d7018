// SPDX-License-Identifier: GPL-3.0-or-later
// A place that is to be lit, as far as choosing a light needs it.
#pragma once

#include "light/link_sets.h"
#include "math/vec.h"

namespace basicrt {

struct LitPoint {
  Vec3f position;
  // Of unit length: only light from its side counts, by the cosine. Zero: light from anywhere.
  Vec3f normal{0, 0, 0};
  int receiver_set = LinkSets::unlinked;  // what is there is in this one

  LitPoint(Vec3f at) : position(at) {}  // NOLINT: any position can be lit
  LitPoint(Vec3f at, Vec3f facing, int of_set = LinkSets::unlinked)
      : position(at), normal(facing), receiver_set(of_set) {}

  [[nodiscard]] bool has_normal() const { return normal.x != 0 || normal.y != 0 || normal.z != 0; }
};

}  // namespace basicrt
