// SPDX-License-Identifier: GPL-3.0-or-later
// What a lamp's material does to its light on the whole: how often such lamps are chosen.
#pragma once

#include "scene/prepare.h"

namespace basicrt {

// The mean luminance of what the lamp's material emits, over light that leaves the lamp and arrives somewhere within the
// scene. Above 0, also where all of that is dark: a bright spot may lie between. A function of the arguments alone.
[[nodiscard]] float estimate_lamp(const PreparedScene& scene, const PreparedScene::LampMaterial& of_lamp,
                                  const Lamp& lamp, const Bounds3f& bounds);

}  // namespace basicrt
