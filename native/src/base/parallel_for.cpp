// SPDX-License-Identifier: GPL-3.0-or-later
// One turn of a pool of workers.
#include "base/parallel_for.h"

#include <algorithm>
#include <thread>

#include "base/worker_pool.h"

namespace basicrt {

int resolve_thread_count(int requested) {
  if (requested > 0) return requested;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  const std::size_t workers = std::min<std::size_t>(count, resolve_thread_count(threads));
  WorkerPool(std::max(1, static_cast<int>(workers))).for_each(count, work);
}

}  // namespace basicrt
