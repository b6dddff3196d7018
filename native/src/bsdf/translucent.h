// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse transmission: the same radiance in all directions behind the surface.
#pragma once

#include "bsdf/lobe.h"
#include "math/warp.h"

namespace basicrt {

struct Translucent {
  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] LobeValue eval(Vec3f /*wo*/, Vec3f wi) const {
    const float pdf = pdf_cosine_hemisphere(-wi.z);
    return {Color(pdf), pdf};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f /*wo*/, float /*choice*/, Vec2f u) const {
    const Vec3f wi = -sample_cosine_hemisphere(u);
    return LobeSample{wi, Color(1.0f), pdf_cosine_hemisphere(-wi.z), false, ScatterKind::transmission};
  }
};

}  // namespace basicrt
