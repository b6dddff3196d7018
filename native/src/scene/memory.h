// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory a scene takes, for who has a limit.
#pragma once

#include <cstddef>

#include "scene/prepare.h"

namespace basicrt {

// Bytes. What is left out is small or passes: materials, tables of lights, what builders of trees need meanwhile.
struct SceneMemory {
  std::size_t shapes = 0;     // twice: as they are described, and as they are rendered
  std::size_t instances = 0;  // the same, with what rays need to know of each
  std::size_t images = 0;     // of textures and the environment, each once: copies share their pixels
  std::size_t trees = 0;      // that rays walk, with the triangles that they hold
  std::size_t picture = 0;    // one number for each channel of the passes and each pixel within the border

  [[nodiscard]] std::size_t total() const { return shapes + instances + images + trees + picture; }
};

// Before anything is built, for a scene that is valid: trees are the smallest that there could be.
[[nodiscard]] SceneMemory expected_memory(const Scene& scene);
[[nodiscard]] SceneMemory memory_of(const PreparedScene& scene);

}  // namespace basicrt
