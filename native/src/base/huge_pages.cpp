// SPDX-License-Identifier: GPL-3.0-or-later
// Asks Linux for huge pages; elsewhere memory is just memory.
#include "base/huge_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace basicrt {
namespace {

constexpr std::size_t cache_line = 64;

std::align_val_t alignment_of(std::size_t bytes) {
  return static_cast<std::align_val_t>(bytes >= huge_page_size ? huge_page_size : cache_line);
}

}  // namespace

void* allocate_in_huge_pages(std::size_t bytes) {
  void* memory = ::operator new(bytes, alignment_of(bytes));
#if defined(__linux__)
  // Whole pages only, so that no memory is taken that nothing uses. The system may refuse: it is only advice.
  if (bytes >= huge_page_size) (void)madvise(memory, bytes / huge_page_size * huge_page_size, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_huge_pages(void* memory, std::size_t bytes) { ::operator delete(memory, alignment_of(bytes)); }

}  // namespace basicrt
