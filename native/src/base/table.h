// SPDX-License-Identifier: GPL-3.0-or-later
// A table of described things, addressed by Id<T>, that remembers which entries were written.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "base/id.h"

namespace basicrt {

// Each write stamps its entry with a new revision; whoever prepared an entry keeps the revision it saw, and
// redoes the work when the two differ.
template <class T>
class Table {
 public:
  Id<T> append(T value) {
    entries_.push_back({std::move(value), ++latest_revision_});
    return Id<T>{static_cast<std::uint32_t>(entries_.size() - 1)};
  }
  void set(Id<T> id, T value) {
    BASICRT_ASSERT(id.index < entries_.size());
    entries_[id.index] = {std::move(value), ++latest_revision_};
  }
  void clear() { entries_.clear(); }

  [[nodiscard]] bool contains(Id<T> id) const { return id.index < entries_.size(); }
  [[nodiscard]] const T& operator[](Id<T> id) const {
    BASICRT_ASSERT(contains(id));
    return entries_[id.index].value;
  }
  [[nodiscard]] const T& operator[](std::uint32_t index) const { return (*this)[Id<T>{index}]; }
  [[nodiscard]] std::uint64_t revision(Id<T> id) const { return entries_[id.index].revision; }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    T value;
    std::uint64_t revision;
  };
  std::vector<Entry> entries_;
  std::uint64_t latest_revision_ = 0;
};

}  // namespace basicrt
