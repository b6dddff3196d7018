// SPDX-License-Identifier: GPL-3.0-or-later
// Workers sleep between turns and draw indices from a shared counter.
#include "base/worker_pool.h"

#include <system_error>

#include "base/parallel_for.h"

namespace basicrt {

WorkerPool::WorkerPool(int threads) {
  try {
    for (int i = 1; i < resolve_thread_count(threads); ++i) threads_.emplace_back([this] { wait_for_turns(); });
  } catch (const std::system_error&) {
    // The system has no more threads: those that there are do the work.
  }
}

WorkerPool::~WorkerPool() {
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  turn_begins_.notify_all();
}

void WorkerPool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (threads_.empty() || count < 2) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    count_ = count;
    next_ = 0;
    ++turn_;
    turn_begins_.notify_all();
  }
  draw_indices(work, count);
  std::unique_lock lock(mutex_);
  work_ = nullptr;  // whoever wakes up now is too late
  turn_ends_.wait(lock, [&] { return busy_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void WorkerPool::wait_for_turns() {
  std::uint64_t last_turn = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    turn_begins_.wait(lock, [&] { return is_over_ || (turn_ != last_turn && work_ != nullptr); });
    if (is_over_) return;
    last_turn = turn_;
    ++busy_;
    const auto* const work = work_;
    const std::size_t count = count_;
    lock.unlock();
    draw_indices(*work, count);
    lock.lock();
    if (--busy_ == 0) turn_ends_.notify_one();
  }
}

void WorkerPool::draw_indices(const std::function<void(std::size_t)>& work, std::size_t count) {
  try {
    for (std::size_t i = next_++; i < count; i = next_++) work(i);
  } catch (...) {
    next_ = count;
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

}  // namespace basicrt
