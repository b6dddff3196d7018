// SPDX-License-Identifier: GPL-3.0-or-later
// WorkerPool: every index once in each of many turns, and errors come back.
#include "base/worker_pool.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace basicrt {
namespace {

TEST(WorkerPool, calls_each_index_once_in_every_turn) {
  for (const int threads : {0, 1, 2, 7}) {
    WorkerPool pool(threads);
    std::vector<std::atomic<int>> calls(50);
    for (int turn = 1; turn <= 300; ++turn) {
      pool.for_each(calls.size(), [&](std::size_t i) { ++calls[i]; });
      for (const std::atomic<int>& count : calls) ASSERT_EQ(count, turn);
    }
  }
}

TEST(WorkerPool, goes_on_after_an_exception) {
  for (const int threads : {1, 4}) {
    WorkerPool pool(threads);
    const auto fail = [](std::size_t i) {
      if (i == 57) throw std::runtime_error("57");
    };
    EXPECT_THROW(pool.for_each(100, fail), std::runtime_error);
    std::atomic<int> calls = 0;
    pool.for_each(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100);
  }
}

TEST(WorkerPool, no_work_is_no_call) {
  WorkerPool(3).for_each(0, [](std::size_t) { FAIL(); });
}

TEST(WorkerPool, counts_its_threads) {
  EXPECT_EQ(WorkerPool(5).thread_count(), 5);
  EXPECT_GE(WorkerPool(0).thread_count(), 1);
}

}  // namespace
}  // namespace basicrt
