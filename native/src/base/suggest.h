// SPDX-License-Identifier: GPL-3.0-or-later
// What to say of a name that does not exist: which one was probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace basicrt {

// `did you mean "eta"?` where one of `known` is near to `word`, else `known are "R", "T"`.
[[nodiscard]] std::string suggest(std::string_view word, std::span<const std::string_view> known);

// How many letters must be put in, left out or replaced to get from one to the other (Levenshtein 1966).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace basicrt
