// SPDX-License-Identifier: GPL-3.0-or-later
// Appends to a vector without a copy.
#pragma once

#include <vector>

namespace basicrt {

// Appends what make() returns, built where it will stay. A copy of a struct that was just put together from single floats
// waits for them to be written.
template <class T, class Make>
T& append_result(std::vector<T>& values, const Make& make) {
  struct Result {
    const Make& make;
    operator T() const { return make(); }  // NOLINT: implicit, so that the new element is this call's own result
  };
  return values.emplace_back(Result{make});
}

}  // namespace basicrt
