// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of extend and connect that are the same for every integrator: a whole batch goes to the tracer at once.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/tracer.h"

namespace basicrt {

// The next hit of each ray.
inline void find_hits(const Tracer& tracer, const std::vector<Ray>& rays, std::vector<Hit>& hits) {
  hits.resize(rays.size());
  tracer.intersect(rays, hits);
}

// Calls add(connection) for each one unless something is in its shadow ray's way. `occluded` is room for the tracer's
// answers.
template <class Connection, class Add>
void for_each_unoccluded(const Tracer& tracer, const std::vector<Ray>& shadow_rays,
                         const std::vector<Connection>& connections, std::vector<std::uint8_t>& occluded, Add&& add) {
  occluded.resize(shadow_rays.size());
  tracer.occluded(shadow_rays, occluded);
  for (std::size_t i = 0; i < connections.size(); ++i)
    if (!occluded[i]) add(connections[i]);
}

}  // namespace basicrt
