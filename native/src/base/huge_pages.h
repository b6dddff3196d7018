// SPDX-License-Identifier: GPL-3.0-or-later
// Memory for large arrays that are read all over the place: in huge pages where the system has them, so that fewer
// reads miss the table of pages.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace basicrt {

inline constexpr std::size_t huge_page_size = std::size_t{2} << 20;

// Aligned to at least a cache line; of smaller sizes than a huge page none is asked for. Throws std::bad_alloc.
[[nodiscard]] void* allocate_in_huge_pages(std::size_t bytes);
void free_huge_pages(void* memory, std::size_t bytes);

template <class T>
struct HugePageAllocator {
  using value_type = T;

  HugePageAllocator() = default;
  template <class U>
  HugePageAllocator(const HugePageAllocator<U>&) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_in_huge_pages(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) { free_huge_pages(memory, count * sizeof(T)); }
  // Leaves plain data as it is, so that resizing doesn't write what is written once more anyway.
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

// resize() leaves new elements of plain data uninitialised.
template <class T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace basicrt
