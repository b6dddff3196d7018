// SPDX-License-Identifier: GPL-3.0-or-later
// Tables: typed indices and revisions.
#include "base/table.h"

#include <gtest/gtest.h>

namespace basicrt {
namespace {

TEST(Table, a_written_entry_has_a_new_revision_and_the_others_keep_theirs) {
  Table<int> table;
  const Id<int> a = table.append(1), b = table.append(2);
  const auto revision_a = table.revision(a), revision_b = table.revision(b);
  table.set(a, 3);
  EXPECT_EQ(table[a], 3);
  EXPECT_NE(table.revision(a), revision_a);
  EXPECT_EQ(table.revision(b), revision_b);
}

TEST(Table, an_id_that_was_never_given_out_is_not_contained) {
  Table<int> table;
  EXPECT_FALSE(table.contains(Id<int>{}));
  EXPECT_FALSE(table.contains(Id<int>{0}));
  EXPECT_TRUE(table.contains(table.append(1)));
}

}  // namespace
}  // namespace basicrt
