// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for names that do not exist.
#include "base/suggest.h"

#include <gtest/gtest.h>

#include <array>

namespace basicrt {
namespace {

constexpr std::array<std::string_view, 3> known = {"eta", "reflectance", "roughness"};

TEST(Suggest, the_edit_distance_counts_insertions_deletions_and_replacements) {
  EXPECT_EQ(edit_distance("eta", "eta"), 0u);
  EXPECT_EQ(edit_distance("", "eta"), 3u);
  EXPECT_EQ(edit_distance("eta", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);  // the textbook's example
  EXPECT_EQ(edit_distance("eta", "beta"), edit_distance("beta", "eta"));
}

TEST(Suggest, a_slip_of_the_pen_gets_the_nearest_name) {
  EXPECT_EQ(suggest("etta", known), "did you mean \"eta\"?");
  EXPECT_EQ(suggest("rougness", known), "did you mean \"roughness\"?");
  EXPECT_EQ(suggest("reflectence", known), "did you mean \"reflectance\"?");
}

TEST(Suggest, a_word_unlike_all_gets_the_list) {
  EXPECT_EQ(suggest("????????", known), "known are \"eta\", \"reflectance\", \"roughness\"");
  EXPECT_EQ(suggest("eta", {}), "there are none");
}

}  // namespace
}  // namespace basicrt
