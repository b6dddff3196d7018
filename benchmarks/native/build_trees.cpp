// SPDX-License-Identifier: GPL-3.0-or-later
// How fast trees are built, and how large they are, beside Embree where it is installed.
//
// build_trees [--size small|full] [--runs N] [--threads N] [--scene NAME] [--builder split_sah]
// Medians of N interleaved runs. One thread is timed by the processor's clock, several by the wall's.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "bvh/mesh_tree.h"
#include "count_visits.h"
#include "meshes.h"

#if defined(BASICRT_WITH_EMBREE)
#include <embree3/rtcore.h>
#endif

namespace {

using namespace basicrt;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double now(int threads) {
  if (threads == 1) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Sample {
  double seconds = 0, bytes = 0;
};

#if defined(BASICRT_WITH_EMBREE)
class Embree {
 public:
  explicit Embree(int threads)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())), threads_(threads) {
    const auto count = [](void* bytes, ssize_t change, bool) {
      *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
  }
  ~Embree() { rtcReleaseDevice(device_); }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  Sample build(const Mesh& mesh) {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3f), mesh.positions.size() - 1);  // it reads past the last one
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0, 12,
                               mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    const std::ptrdiff_t bytes_before = bytes_;
    const double begin = now(threads_);
    rtcCommitScene(scene);
    const Sample sample{now(threads_) - begin, static_cast<double>(bytes_ - bytes_before)};
    rtcReleaseScene(scene);
    return sample;
  }

 private:
  RTCDevice device_;
  int threads_;
  std::atomic<std::ptrdiff_t> bytes_ = 0;
};
#endif

struct Shape {
  double children_per_node = 0, triangles_per_block = 0;
};

Shape shape_of(const MeshTree& tree, std::size_t triangles) {
  std::size_t children = 0;
  for (const TreeNode& node : tree.tree.nodes)
    for (const TreeReference child : node.children) children += child != no_reference;
  const auto ratio = [](std::size_t a, std::size_t b) { return static_cast<double>(a) / static_cast<double>(b); };
  return {ratio(children, tree.tree.nodes.size()), ratio(triangles, tree.blocks.size())};
}

void run(const char* name, Mesh mesh, BvhBuilder builder, int threads, int runs) {
  mesh.positions.emplace_back();  // never used
  const auto triangles = static_cast<double>(mesh.triangles.size());
  const BvhConfig config{.builder = builder, .threads = threads};
  std::vector<double> rates, embree_rates, ratios;
  Shape shape;
  double bytes = 0, embree_bytes = 0;
#if defined(BASICRT_WITH_EMBREE)
  Embree embree(threads);
#endif
  for (int i = 0; i < runs; ++i) {
    const double begin = now(threads);
    const MeshTree tree = build_mesh_tree(mesh, config);
    rates.push_back(triangles / (now(threads) - begin) / 1e6);
    bytes = static_cast<double>(tree.memory()) / triangles;
    shape = shape_of(tree, mesh.triangles.size());
#if defined(BASICRT_WITH_EMBREE)
    const Sample sample = embree.build(mesh);
    embree_rates.push_back(triangles / sample.seconds / 1e6);
    ratios.push_back(rates.back() / embree_rates.back());
    embree_bytes = sample.bytes / triangles;
#endif
  }
  std::printf("| %s | %.0f | %.2f |", name, triangles / 1000, median(rates));
  if (!ratios.empty()) std::printf(" %.2f | %.2f |", median(embree_rates), median(ratios));
  std::printf(" %.1f |", bytes);
  if (!ratios.empty()) std::printf(" %.1f |", embree_bytes);
  const benchmark::Visits visits = benchmark::count_visits(build_mesh_tree(mesh, config), mesh, 50000);
  std::printf(" %.2f | %.2f | %.2f | %.2f |\n", shape.children_per_node, shape.triangles_per_block, visits.nodes,
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
  std::printf("%d threads, medians of %d runs, beside Embree %s\n\n", threads, runs, RTC_VERSION_STRING);
  std::printf(
      "| mesh | thousand triangles | million/s | Embree | ratio | bytes each | Embree | children per node "
      "| triangles per block | nodes a ray visits | blocks |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
#else
  std::printf("%d threads, medians of %d runs; without Embree, which was not found\n\n", threads, runs);
  std::printf(
      "| mesh | thousand triangles | million/s | bytes each | children per node | triangles per block | nodes a ray "
      "visits "
      "| blocks |\n|---|---|---|---|---|---|---|---|\n");
#endif
  const auto scene = [&](const char* name, auto&& make, int detail) {
    if (only.empty() || only == name) run(name, make(detail), builder, threads, runs);
  };
  scene("cornell", benchmark::make_cornell, is_small ? 32 : 380);
  scene("terrain", benchmark::make_terrain, is_small ? 64 : 707);
  scene("soup", [](int count) { return benchmark::make_soup(count); }, is_small ? 10000 : 1000000);
  scene("overlap", [](int count) { return benchmark::make_soup(count, 0.2f); }, is_small ? 2000 : 200000);
  scene("hall", benchmark::make_hall, is_small ? 30 : 220);
  scene("hair", benchmark::make_hair, is_small ? 10000 : 1000000);
  return 0;
}
