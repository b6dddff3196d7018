// SPDX-License-Identifier: GPL-3.0-or-later
// An array that is never changed once made, so that all copies of it are one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace basicrt {

// Copying one costs a counter: pictures go from a description to what is rendered without their pixels being copied.
template <class T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(std::vector<T> values)  // NOLINT: a vector's numbers, from now on not to be changed
      : values_(values.empty() ? nullptr : std::make_shared<const std::vector<T>>(std::move(values))) {}
  SharedArray(std::initializer_list<T> values) : SharedArray(std::vector<T>(values)) {}

  [[nodiscard]] std::size_t size() const { return values_ ? values_->size() : 0; }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] const T* data() const { return values_ ? values_->data() : nullptr; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size(); }
  const T& operator[](std::size_t index) const { return (*values_)[index]; }

  friend bool operator==(const SharedArray& a, const SharedArray& b) { return std::ranges::equal(a, b); }
  friend bool operator==(const SharedArray& a, const std::vector<T>& b) { return std::ranges::equal(a, b); }
  // Whether both are copies of one array, and not only alike.
  [[nodiscard]] bool is_same(const SharedArray& other) const { return values_ == other.values_; }

 private:
  std::shared_ptr<const std::vector<T>> values_;
};

}  // namespace basicrt
