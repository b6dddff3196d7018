// SPDX-License-Identifier: GPL-3.0-or-later
// Collects what a user should be told without stopping: each warning once, in the order it arose.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace basicrt {

class Report {
 public:
  void warn(std::string message) {
    if (std::find(warnings_.begin(), warnings_.end(), message) == warnings_.end())
      warnings_.push_back(std::move(message));
  }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> warnings_;
};

}  // namespace basicrt
