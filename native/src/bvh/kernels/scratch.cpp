// SPDX-License-Identifier: GPL-3.0-or-later
// One huge page for each thread: what a kernel touches lies far apart, and would need an entry of the processor's page table each.
#include "bvh/kernels/scratch.h"

#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace basicrt {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

struct Release {
  void operator()(void* memory) const { ::operator delete(memory, std::align_val_t{huge_page}); }
};

}  // namespace

void* kernel_scratch(std::size_t size) {
  thread_local std::unique_ptr<void, Release> memory;
  thread_local std::size_t capacity = 0;
  if (capacity < size) {
    capacity = (size + huge_page - 1) / huge_page * huge_page;
    memory.reset(::operator new(capacity, std::align_val_t{huge_page}));
#if defined(__linux__)
    madvise(memory.get(), capacity, MADV_HUGEPAGE);  // a wish: without it all works, slower
#endif
  }
  return memory.get();
}

}  // namespace basicrt
