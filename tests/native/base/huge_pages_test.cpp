// SPDX-License-Identifier: GPL-3.0-or-later
// HugeVector: a vector as any other, aligned, that doesn't write when it grows.
#include "base/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace basicrt {
namespace {

TEST(HugeVector, keeps_its_elements_while_it_grows_over_pages) {
  HugeVector<int> vector;
  for (int i = 0; i < 1'500'000; ++i) vector.push_back(i);
  for (int i = 0; i < 1'500'000; ++i) ASSERT_EQ(vector[static_cast<std::size_t>(i)], i);
  const HugeVector<int> copy = vector;
  EXPECT_EQ(copy, vector);
}

TEST(HugeVector, is_aligned_to_cache_lines) {
  for (const std::size_t size : {1u, 100u, 10'000u, 5'000'000u}) {
    const HugeVector<std::uint8_t> vector(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(vector.data()) % 64, 0u) << size;
  }
}

TEST(HugeVector, refuses_more_than_there_can_be) {
  HugeVector<std::uint64_t> vector;
  EXPECT_ANY_THROW(vector.resize(std::numeric_limits<std::size_t>::max() / 4));
  EXPECT_THROW((void)HugePageAllocator<std::uint64_t>().allocate(std::numeric_limits<std::size_t>::max() / 2),
               std::bad_array_new_length);
}

}  // namespace
}  // namespace basicrt
