// SPDX-License-Identifier: GPL-3.0-or-later
// Every block of JSON in docs/scene_format.md is a scene.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/file.h"
#include "io/scene_text.h"

namespace basicrt {
namespace {

TEST(SceneFormatDoc, every_example_loads_without_a_warning_of_its_own) {
  const std::filesystem::path root = BASICRT_SOURCE_DIR;
  const std::string page = read_file(root / "docs/scene_format.md"), fence = "```json\n";
  int count = 0;
  for (std::size_t begin = page.find(fence); begin != std::string::npos; begin = page.find(fence, begin)) {
    begin += fence.size();
    const std::string example = page.substr(begin, page.find("```", begin) - begin);
    Report report;
    const std::string problem = error_of([&] {
      const Scene scene = parse_scene(example, root, "example " + std::to_string(++count), report);
      validate_description(scene);
    });
    EXPECT_EQ(problem, "") << example;
    for (const std::string& warning : report.warnings()) EXPECT_EQ(warning, "objects: the scene has none") << example;
  }
  EXPECT_GE(count, 5);
}

}  // namespace
}  // namespace basicrt
