// SPDX-License-Identifier: GPL-3.0-or-later
// How much the parts of a shape emit whose material doesn't emit the same everywhere: what they are chosen by as lights.
#pragma once

#include <vector>

#include "light/emissive_instance.h"
#include "scene/prepare.h"

namespace basicrt {

// Of each triangle, or of the sphere, in the mean over some of its points, seen along the normal. Where the mesh shines
// at all nothing that may shine has an estimate of zero, for a bright spot can lie between those points. The same for any
// number of threads (0: one per processor).
[[nodiscard]] std::vector<EmissiveInstance::Estimate> estimate_emission(const PreparedScene& scene,
                                                                        std::uint32_t instance, int threads);

}  // namespace basicrt
