// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest name by edit distance.
#include "base/suggest.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace basicrt {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // row[j]: from the letters of `a` so far to the first j letters of `b`.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string suggest(std::string_view word, std::span<const std::string_view> known) {
  if (known.empty()) return "there are none";
  const auto distance = [&](std::string_view name) { return edit_distance(word, name); };
  const std::string_view nearest = *std::ranges::min_element(known, {}, distance);
  if (distance(nearest) <= std::max<std::size_t>(2, word.size() / 2) && distance(nearest) < nearest.size())
    return "did you mean \"" + std::string(nearest) + "\"?";

  std::string list = "known are ";
  for (const std::string_view name : known)
    list.append(name == known.front() ? "\"" : ", \"").append(name).append("\"");
  return list;
}

}  // namespace basicrt
