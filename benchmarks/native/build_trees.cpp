// SPDX-License-Identifier: GPL-3.0-or-later
// How fast trees are built, and how large they are, beside Embree where it is installed.
//
// build_trees [--size small|full] [--runs N] [--threads N] [--scene NAME] [--builder split_sah]
// Medians of N interleaved runs. One thread is timed by the processor's clock, several by the wall's.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "bvh/mesh_tree.h"
#include "count_visits.h"
#include "meshes.h"
#include "report.h"

#if defined(BASICRT_WITH_EMBREE)
#include "embree.h"
#endif

namespace {

using namespace basicrt;
using namespace basicrt::benchmark;

#if defined(BASICRT_WITH_EMBREE)
struct Sample {
  double seconds = 0, bytes = 0;
};

Sample build_with_embree(const EmbreeDevice& device, const Mesh& mesh, int threads) {
  EmbreeScene scene(device);
  scene.add(mesh);
  const std::ptrdiff_t bytes_before = device.bytes();
  const double begin = now(threads);
  scene.build();
  return {now(threads) - begin, static_cast<double>(device.bytes() - bytes_before)};
}
#endif

struct Fullness {
  double children_per_node = 0, triangles_per_block = 0;
};

Fullness fullness_of(const MeshTree& tree, std::size_t triangles) {
  std::size_t children = 0;
  for (const TreeNode& node : tree.tree.nodes)
    for (const TreeReference child : node.children) children += child != no_reference;
  const auto ratio = [](std::size_t a, std::size_t b) { return static_cast<double>(a) / static_cast<double>(b); };
  return {ratio(children, tree.tree.nodes.size()), ratio(triangles, tree.blocks.size())};
}

void run(const char* name, Mesh mesh, BvhBuilder builder, int threads, int runs) {
  mesh.positions.reserve(mesh.positions.size() + 1);  // Embree reads past the last one
  const auto triangles = static_cast<double>(mesh.triangles.size());
  const BvhConfig config{.builder = builder, .threads = threads};
  std::vector<double> rates, embree_rates, ratios;
  Fullness fullness;
  double bytes = 0, embree_bytes = 0;
#if defined(BASICRT_WITH_EMBREE)
  const EmbreeDevice embree(threads);
#endif
  for (int i = 0; i < runs; ++i) {
    const double begin = now(threads);
    const MeshTree tree = build_mesh_tree(mesh, config);
    rates.push_back(triangles / (now(threads) - begin) / 1e6);
    bytes = static_cast<double>(tree.memory()) / triangles;
    fullness = fullness_of(tree, mesh.triangles.size());
#if defined(BASICRT_WITH_EMBREE)
    const Sample sample = build_with_embree(embree, mesh, threads);
    embree_rates.push_back(triangles / sample.seconds / 1e6);
    ratios.push_back(rates.back() / embree_rates.back());
    embree_bytes = sample.bytes / triangles;
#endif
  }
  std::printf("| %s | %.0f | %.2f |", name, triangles / 1000, median(rates));
  if (!ratios.empty()) std::printf(" %.2f | %.2f |", median(embree_rates), median(ratios));
  std::printf(" %.1f |", bytes);
  if (!ratios.empty()) std::printf(" %.1f |", embree_bytes);
  const Visits visits = count_visits(build_mesh_tree(mesh, config), mesh, 50000);
  std::printf(" %.2f | %.2f | %.2f | %.2f |\n", fullness.children_per_node, fullness.triangles_per_block, visits.nodes,
              visits.blocks);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  bool is_small = false;
  int runs = 7, threads = 1;
  BvhBuilder builder = BvhBuilder::binned_sah;
  std::string_view only;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--size") is_small = argv[i + 1] == std::string_view("small");
    if (option == "--runs") runs = std::max(1, std::atoi(argv[i + 1]));
    if (option == "--threads") threads = std::max(1, std::atoi(argv[i + 1]));
    if (option == "--scene") only = argv[i + 1];
    if (option == "--builder" && argv[i + 1] == std::string_view("split_sah")) builder = BvhBuilder::split_sah;
  }
#if defined(BASICRT_WITH_EMBREE)
  std::printf("%s, commit %s, %d threads, medians of %d runs, beside Embree %s\n\n", machine().c_str(),
              commit().c_str(), threads, runs, RTC_VERSION_STRING);
  std::printf(
      "| mesh | thousand triangles | million/s | Embree | ratio | bytes each | Embree | children per node "
      "| triangles per block | nodes a ray visits | blocks |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
#else
  std::printf("%s, commit %s, %d threads, medians of %d runs; without Embree, which was not found\n\n",
              machine().c_str(), commit().c_str(), threads, runs);
  std::printf(
      "| mesh | thousand triangles | million/s | bytes each | children per node | triangles per block | nodes a ray "
      "visits "
      "| blocks |\n|---|---|---|---|---|---|---|---|\n");
#endif
  const auto scene = [&](const char* name, auto&& make, int detail) {
    if (only.empty() || only == name) run(name, make(detail), builder, threads, runs);
  };
  scene("cornell", make_cornell, is_small ? 32 : 380);
  scene("terrain", make_terrain, is_small ? 64 : 707);
  scene("soup", [](int count) { return make_soup(count); }, is_small ? 10000 : 1000000);
  scene("overlap", [](int count) { return make_soup(count, 0.2f); }, is_small ? 2000 : 200000);
  scene("hall", make_hall, is_small ? 30 : 220);
  scene("hair", make_hair, is_small ? 10000 : 1000000);
  return 0;
}
