// SPDX-License-Identifier: GPL-3.0-or-later
// At least one huge page for each thread: what a kernel touches lies far apart, and would need an entry of the processor's page table each.
#include "bvh/kernels/scratch.h"

#include <algorithm>

#include "base/huge_pages.h"

namespace basicrt {

void* kernel_scratch(std::size_t size) {
  thread_local HugeVector<std::byte> memory;
  if (memory.size() < size) {
    memory = {};  // nothing in it is kept
    memory.resize(std::max(size, huge_page_size));
  }
  return memory.data();
}

}  // namespace basicrt
