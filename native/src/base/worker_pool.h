// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that stay, for work that comes in many short turns.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace basicrt {

class WorkerPool {
 public:
  explicit WorkerPool(int threads);  // including the caller's; 0: one for each processor
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  [[nodiscard]] int thread_count() const { return static_cast<int>(threads_.size()) + 1; }  // with the caller's

  // Calls work(index) once for each index in [0, count) and returns when all are done. An exception from `work` stops
  // handing out indices and is thrown again here. Only one thread may call it, and not from within `work`.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void wait_for_turns();
  void draw_indices(const std::function<void(std::size_t)>& work, std::size_t count);

  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;  // guards what follows
  std::condition_variable turn_begins_, turn_ends_;
  std::uint64_t turn_ = 0;
  std::size_t busy_ = 0;  // threads that take part in the turn
  bool is_over_ = false;
  std::exception_ptr error_;
  const std::function<void(std::size_t)>* work_ = nullptr;  // of the turn; null between turns
  std::size_t count_ = 0;

  std::vector<std::jthread> threads_;  // last, so that they end before what they use
};

}  // namespace basicrt
