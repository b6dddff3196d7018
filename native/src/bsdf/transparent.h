// SPDX-License-Identifier: GPL-3.0-or-later
// Light that passes straight through, as if there were no surface.
#pragma once

#include "bsdf/lobe.h"

namespace basicrt {

struct Transparent {
  [[nodiscard]] bool is_delta() const { return true; }
  [[nodiscard]] LobeValue eval(Vec3f /*wo*/, Vec3f /*wi*/) const { return {}; }
  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float /*choice*/, Vec2f /*u*/) const {
    return LobeSample{-wo, Color(1.0f), 1, true, ScatterKind::transparent};
  }
};

}  // namespace basicrt
