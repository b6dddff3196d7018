// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes, instances and rays made of a fuzzer's bytes: any that the tracer promises to cope with.
#pragma once

#include <vector>

#include "bvh/tracer.h"
#include "fuzz/byte_reader.h"
#include "geometry/shape.h"

namespace basicrt::fuzz {

struct FuzzScene {
  std::vector<Shape> shapes;
  std::vector<TracedInstance> instances;
  std::vector<Ray> rays;
  bool is_closed = false;  // every ray starts inside a closed mesh: none may miss
};

[[nodiscard]] FuzzScene make_scene(ByteReader& bytes);

// The same triangles with other positions.
[[nodiscard]] Mesh make_moved(ByteReader& bytes, Mesh mesh);

}  // namespace basicrt::fuzz
