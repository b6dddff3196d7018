// SPDX-License-Identifier: GPL-3.0-or-later
// Our kernels as a plug-in of the rtbench driver, beside its other peers: built where rtb_plugin.h is given.
#include "rtb_plugin.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bvh/kernels/chosen_kernel.h"
#include "bvh/tracer.h"

namespace {

using namespace basicrt;

constexpr std::array kernel_names{"avx512", "avx2", "sse42", "scalar"};

// The first are streams, the others give the kernel one ray at a time.
constexpr std::uint32_t variant_count = 2 * kernel_names.size();
bool is_stream(std::uint32_t variant) { return variant < kernel_names.size(); }
const char* kernel_name(std::uint32_t variant) { return kernel_names[variant % kernel_names.size()]; }

struct Scene {
  Tracer tracer;
  std::uint64_t bytes;
  std::size_t batch;
};

const char* variant_name(std::uint32_t variant) {
  static const auto names = [] {
    std::array<std::string, variant_count> result;
    for (std::uint32_t i = 0; i < variant_count; ++i)
      result[i] = std::string(is_stream(i) ? "stream-" : "single-") + kernel_name(i);
    return result;
  }();
  return names[variant].c_str();
}

void* build(std::uint32_t variant, int threads, const float* xyz, std::uint32_t vertex_count,
            const std::uint32_t* indices, std::uint32_t triangle_count) {
  const Kernel* kernel = find_kernel(kernel_name(variant));
  if (kernel == nullptr) return nullptr;
  Mesh mesh;
  mesh.positions.resize(vertex_count);
  for (std::uint32_t i = 0; i < vertex_count; ++i) mesh.positions[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  mesh.triangles.resize(triangle_count);
  for (std::uint32_t i = 0; i < triangle_count; ++i)
    mesh.triangles[i] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
  static_cast<void>(threads);
  std::vector<ShapeTree> trees;
  trees.push_back(build_shape_tree(mesh, {}));
  const MeshTree& tree = std::get<MeshTree>(trees[0].geometry);
  const std::uint64_t bytes = sizeof(TreeNode) * tree.tree.nodes.size() + sizeof(TriangleBlock) * tree.blocks.size();
  auto scene = std::make_unique<Scene>(
      Scene{Tracer(std::move(trees), {TracedInstance{}}, {}), bytes, is_stream(variant) ? std::size_t{4096} : 1});
  scene->tracer.use(*kernel);
  return scene.release();
}

void destroy(void* scene) { delete static_cast<Scene*>(scene); }

Ray ray_of(const RtbRay& ray) {
  return {
      .origin = {ray.ox, ray.oy, ray.oz}, .t_min = ray.tmin, .direction = {ray.dx, ray.dy, ray.dz}, .t_max = ray.tmax};
}

// Calls trace(rays, first) for one batch after the other.
template <class Trace>
void for_each_batch(const Scene& scene, const RtbRay* rays, std::size_t count, Trace&& trace) {
  std::array<Ray, 4096> batch;
  for (std::size_t first = 0; first < count; first += scene.batch) {
    const std::size_t size = std::min(scene.batch, count - first);
    for (std::size_t i = 0; i < size; ++i) batch[i] = ray_of(rays[first + i]);
    trace(std::span<const Ray>(batch).first(size), first);
  }
}

void intersect(void* given, const RtbRay* rays, RtbHit* results, std::size_t count) {
  const auto& scene = *static_cast<const Scene*>(given);
  std::array<Hit, 4096> hits;
  for_each_batch(scene, rays, count, [&](std::span<const Ray> batch, std::size_t first) {
    scene.tracer.intersect(batch, std::span(hits).first(batch.size()));
    for (std::size_t i = 0; i < batch.size(); ++i)
      results[first + i] = {hits[i].t, hits[i].u, hits[i].v, hits[i].is_hit() ? hits[i].primitive : RTB_MISS};
  });
}

void occluded(void* given, const RtbRay* rays, std::uint8_t* results, std::size_t count) {
  const auto& scene = *static_cast<const Scene*>(given);
  for_each_batch(scene, rays, count, [&](std::span<const Ray> batch, std::size_t first) {
    scene.tracer.occluded(batch, std::span(results + first, batch.size()));
  });
}

std::uint64_t memory(void* scene) { return static_cast<Scene*>(scene)->bytes; }

}  // namespace

extern "C" const RtbPlugin* rtb_plugin() {
  static const RtbPlugin plugin{RTB_ABI, "basicrt", variant_count, variant_name, build,
                                destroy, intersect, occluded,      memory,       nullptr};
  return &plugin;
}
