// SPDX-License-Identifier: GPL-3.0-or-later
// Runs independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace basicrt {

// The number of threads to use: `requested`, or one per processor where that is 0.
[[nodiscard]] int resolve_thread_count(int requested);

// Calls work(index) once for each index in [0, count), on up to `threads` threads (0: one per processor), and returns
// when all are done. An exception from `work` stops handing out indices and is thrown again here.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace basicrt
