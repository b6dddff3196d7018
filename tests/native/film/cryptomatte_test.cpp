// SPDX-License-Identifier: GPL-3.0-or-later
// Names as ids of mattes.
#include "film/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

#include "film/film.h"

namespace basicrt {
namespace {

// From the reference implementation, seed 0.
TEST(Cryptomatte, the_hash_is_murmurs) {
  EXPECT_EQ(murmur_hash(""), 0u);
  EXPECT_EQ(murmur_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, every_id_is_an_ordinary_float) {
  for (int i = 0; i < 10000; ++i) {
    const auto value = std::bit_cast<float>(matte_id(std::to_string(i)));
    EXPECT_TRUE(std::isnormal(value)) << i;
  }
}

TEST(Cryptomatte, the_manifest_names_each_id) {
  const auto entries = matte_metadata("CryptoObject", {"a \"b\"", "hello"});
  const std::string key = "cryptomatte/" + matte_id_text(murmur_hash("CryptoObject")).substr(0, 7) + "/";
  ASSERT_EQ(entries.size(), 4u);
  EXPECT_EQ(entries[0], std::pair(key + "name", std::string("CryptoObject")));
  EXPECT_EQ(entries[3].second,
            "{\"a \\\"b\\\"\":\"" + matte_id_text(matte_id("a \"b\"")) + "\",\"hello\":\"248bfa47\"}");
}

TEST(TileAccumulator, mattes_are_ranked_by_coverage) {
  PassLayout layout;
  layout.enable(Pass::crypto_object);
  layout.enable(static_cast<Pass>(static_cast<int>(Pass::crypto_object) + 1));
  TileAccumulator accumulator({0, 0, 1, 1}, layout);
  for (std::uint32_t i = 0; i < 4; ++i) {
    accumulator.add(0, 0, {});
    accumulator.add_matte(0, 0, {i, {i == 3 ? 7u : 100 + i % 2, 0, 0}, i == 3 ? 0.5f : 1});
  }
  const Tile tile = accumulator.finish();
  const float* ranks = tile.values.data() + tile.pass_begin(Pass::crypto_object);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[0]), 100u);
  EXPECT_EQ(ranks[1], 0.5f);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[2]), 101u);
  EXPECT_EQ(ranks[3], 0.25f);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[4]), 7u);
  EXPECT_EQ(ranks[5], 0.125f);
  EXPECT_EQ(ranks[7], 0);
}

}  // namespace
}  // namespace basicrt
