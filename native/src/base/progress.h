// SPDX-License-Identifier: GPL-3.0-or-later
// How far a long piece of work is, and the wish that it should end.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>

namespace basicrt {

// What work throws when it was cancelled.
class Cancelled : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "cancelled"; }
};

// Any thread may call anything at any time: those that work advance, one that waits looks on or cancels.
class WorkProgress {
 public:
  // In units of whoever does the work.
  void expect(std::uint64_t units) { expected_ += units; }
  // Throws Cancelled after cancel(). To be called often: several times in 100 ms.
  void advance(std::uint64_t units) {
    done_ += units;
    if (is_cancelled_) throw Cancelled();
  }
  void cancel() { is_cancelled_ = true; }
  // From 0 to 1; what is expected may be a guess.
  [[nodiscard]] double fraction() const {
    const std::uint64_t expected = expected_, done = done_;
    return expected == 0 ? 0 : static_cast<double>(std::min(done, expected)) / static_cast<double>(expected);
  }

 private:
  std::atomic<std::uint64_t> expected_ = 0, done_ = 0;
  std::atomic<bool> is_cancelled_ = false;
};

}  // namespace basicrt
