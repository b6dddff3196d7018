// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges of described fields.
#include "base/validate_fields.h"

#include <gtest/gtest.h>

#include <cmath>

#include "error_of.h"
#include "math/vec.h"

namespace basicrt {
namespace {

struct Lamp {
  float share = 0.5f;
  Vec3f color{1.0f};
  int count = 1;
  float reach = INFINITY;
  bool is_on = true;
  static constexpr auto fields() {
    return fields_of(field("share", &Lamp::share, "", within(0, 1)), field("color", &Lamp::color, "", at_least(0)),
                     field("count", &Lamp::count, "", within(1, 8)),
                     field("reach", &Lamp::reach, "", above_or_infinite(0)), field("on", &Lamp::is_on, ""));
  }
};

std::string problem_of(const Lamp& lamp, std::string_view item = "lamps[3]") {
  return error_of([&] { validate_fields(lamp, item); });
}

TEST(ValidateFields, values_within_their_ranges_pass) {
  EXPECT_EQ(problem_of({}), "");
  EXPECT_EQ(problem_of({.share = 0, .count = 8}), "");
  EXPECT_EQ(problem_of({.share = 1, .count = 1, .reach = 1e-30f}), "");
}

TEST(ValidateFields, the_message_names_item_rule_and_value) {
  EXPECT_EQ(problem_of({.share = 1.5f}), "lamps[3].share: must be in [0, 1], is 1.5");
  EXPECT_EQ(problem_of({.color = {1, -0.25f, 1}}), "lamps[3].color: must be at least 0, is -0.25");
  EXPECT_EQ(problem_of({.count = 9}), "lamps[3].count: must be in [1, 8], is 9");
  EXPECT_EQ(problem_of({.reach = 0}), "lamps[3].reach: must be above 0, is 0");
  EXPECT_EQ(problem_of({.share = 2}, ""), "share: must be in [0, 1], is 2");
}

TEST(ValidateFields, only_a_field_that_says_so_may_be_infinite) {
  EXPECT_EQ(problem_of({.color = {1, 1, INFINITY}}), "lamps[3].color: must be a finite number, is inf");
  EXPECT_EQ(problem_of({.share = NAN}), "lamps[3].share: must be a finite number, is nan");
  EXPECT_EQ(problem_of({.reach = NAN}), "lamps[3].reach: must be a finite number, is nan");
  EXPECT_EQ(problem_of({.reach = -INFINITY}), "lamps[3].reach: must be above 0, is -inf");
}

}  // namespace
}  // namespace basicrt
