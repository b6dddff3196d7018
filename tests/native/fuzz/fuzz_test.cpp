// SPDX-License-Identifier: GPL-3.0-or-later
// Replays what fuzzers kept, and a few random changes of it: a short run of the fuzzers that needs neither clang nor time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "fuzz/mutate.h"
#include "fuzz/trees.h"

namespace basicrt::fuzz {
namespace {

using FindFault = std::function<std::string(std::span<const std::uint8_t>)>;

struct CorpusFile {
  std::string name;
  Bytes bytes;
};

// tests/fuzz/corpus/<target>/*, in the same order everywhere.
std::vector<CorpusFile> read_corpus(const std::string& target) {
  std::vector<CorpusFile> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BASICRT_SOURCE_DIR) / "tests/fuzz/corpus" / target)) {
    std::ifstream file(entry.path(), std::ios::binary);
    files.push_back({entry.path().filename().string(), Bytes(std::istreambuf_iterator<char>(file), {})});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return files;
}

void replay(const std::string& target, const FindFault& find_fault, int mutations) {
  const std::vector<CorpusFile> corpus = read_corpus(target);
  ASSERT_GT(corpus.size(), 10u);
  for (const auto& [name, bytes] : corpus) EXPECT_EQ(find_fault(bytes), "") << name;

  constexpr std::uint32_t seed = 1;
  std::mt19937 rng(seed);
  for (int i = 0; i < mutations; ++i) {
    const CorpusFile& file = corpus[rng() % corpus.size()];
    const Bytes bytes = mutated(file.bytes, corpus[rng() % corpus.size()].bytes, rng);
    ASSERT_EQ(find_fault(bytes), "") << "seed " << seed << ", mutation " << i << ", of " << file.name;
  }
}

TEST(Fuzz, finds_no_fault_in_trees_and_kernels) { replay("trees", find_trees_fault, 600); }

}  // namespace
}  // namespace basicrt::fuzz
