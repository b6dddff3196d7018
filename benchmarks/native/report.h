// SPDX-License-Identifier: GPL-3.0-or-later
// What benchmarks say about figures: the middle of several runs, and where they were measured.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace basicrt::benchmark {

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double geometric_mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

// Seconds since some moment: of the processor's time where one thread works, so that other programs disturb little.
inline double now(int threads) {
  if (threads == 1) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

// Of the sources that the program was built from, as far as git still tells.
inline std::string commit() {
  std::array<char, 64> line{};
  std::FILE* git =
      popen("git -C '" BASICRT_SOURCE_DIR "' describe --always --dirty=-changed --exclude '*' 2>/dev/null", "r");
  if (git == nullptr) return "unknown";
  const bool is_known = std::fgets(line.data(), line.size(), git) != nullptr;
  pclose(git);
  const std::string text = line.data();
  return is_known ? text.substr(0, text.find('\n')) : "unknown";
}

}  // namespace basicrt::benchmark
