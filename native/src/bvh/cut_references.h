// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts triangles that fill their boxes badly into several references with smaller boxes.
#pragma once

#include "base/huge_pages.h"
#include "base/progress.h"
#include "base/worker_pool.h"
#include "bvh/references.h"
#include "geometry/mesh.h"

namespace basicrt {

// At most `most_cuts` more references than the mesh has triangles (Karras and Aila 2013, "Fast Parallel Construction of
// High-Quality Bounding Volume Hierarchies"). The boxes of a triangle's references cover it. The same for any number of
// threads.
[[nodiscard]] HugeVector<Reference> cut_references(const Mesh& mesh, std::size_t most_cuts, WorkerPool& pool,
                                                   WorkProgress* progress);

}  // namespace basicrt
