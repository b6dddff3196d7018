// SPDX-License-Identifier: GPL-3.0-or-later
// Builds and traces what the bytes say, every way there is, and compares.
#include "fuzz/trees.h"

#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "base/validate_fields.h"
#include "bvh/hit_fault.h"
#include "bvh/kernels/chosen_kernel.h"
#include "bvh/mesh_tree.h"
#include "bvh/test_scenes.h"
#include "bvh/tree_fault.h"
#include "fuzz/scene_of_bytes.h"

namespace basicrt::fuzz {
namespace {

struct NamedBuilder {
  BvhBuilder builder;
  const char* name;
};
constexpr std::array builders{NamedBuilder{BvhBuilder::median, "median"},
                              NamedBuilder{BvhBuilder::binned_sah, "binned SAH"},
                              NamedBuilder{BvhBuilder::split_sah, "split SAH"}};

std::string fault_of_tree(const MeshTree& tree, const Mesh& mesh, BvhBuilder builder) {
  return builder == BvhBuilder::split_sah ? find_cut_tree_fault(tree, mesh) : find_tree_fault(tree, mesh);
}

// Returns what is wrong with its tree, before it is moved or after.
std::string check_mesh(ByteReader& bytes, const Mesh& mesh) {
  const Mesh moved = make_moved(bytes, mesh);
  for (const auto& [builder, name] : builders) {
    MeshTree tree = build_mesh_tree(mesh, {.builder = builder, .threads = 1});
    if (std::string fault = fault_of_tree(tree, mesh, builder); !fault.empty()) return std::string(name) + ": " + fault;
    refit(tree, moved, 1);
    if (std::string fault = fault_of_tree(tree, moved, builder); !fault.empty())
      return std::string(name) + ", refitted: " + fault;
  }
  return {};
}

std::string text_of(Vec3f v) { return number_text(v.x) + " " + number_text(v.y) + " " + number_text(v.z); }

std::string text_of(const Hit& hit) {
  return "t " + number_text(hit.t) + " instance " + std::to_string(static_cast<int>(hit.instance)) + " primitive " +
         std::to_string(static_cast<int>(hit.primitive));
}

std::string text_of(const Ray& ray) {
  return "from " + text_of(ray.origin) + " towards " + text_of(ray.direction) + " within " + number_text(ray.t_min) +
         " to " + number_text(ray.t_max);
}

// Hits of the whole batch, which each ray alone and any-hit queries must confirm.
std::vector<Hit> trace(const Tracer& tracer, std::span<const Ray> rays, std::string& fault) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size(), 2);
  tracer.intersect(rays, hits);
  tracer.occluded(rays, occluded);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string name = "ray " + std::to_string(i) + ": ";
    Hit alone;
    tracer.intersect(rays.subspan(i, 1), {&alone, 1});
    if (!test::is_identical(alone, hits[i])) fault = name + text_of(hits[i]) + ", but alone " + text_of(alone);
    if (occluded[i] != hits[i].is_hit())
      fault = name + text_of(hits[i]) + ", but occluded " + std::to_string(occluded[i]);
  }
  return hits;
}

// Scenes reach 1e15 at the most. From much farther away not even double precision tells what a ray meets: kernels have to agree, no more.
bool can_be_judged(const Ray& ray) {
  const float reach = max_component(abs(ray.origin));
  return !(reach > 1e18f && std::isfinite(reach));
}

std::string check_rays(const FuzzScene& scene) {
  std::vector<Hit> expected;
  for (const Ray& ray : scene.rays) expected.push_back(test::brute_force(scene.shapes, scene.instances, ray));
  for (const auto& [builder, builder_name] : builders) {
    Tracer tracer = test::make_tracer(scene.shapes, scene.instances, {.builder = builder, .threads = 1});
    std::vector<Hit> first_hits;
    for (const char* kernel_name : {"scalar", "sse42", "avx2", "avx512"}) {
      const Kernel* kernel = find_kernel(kernel_name);
      if (kernel == nullptr) continue;
      tracer.use(*kernel);
      const std::string place = std::string(builder_name) + ", " + kernel_name + ", ";
      std::string fault;
      const std::vector<Hit> hits = trace(tracer, scene.rays, fault);
      if (!fault.empty()) return place + fault;
      if (first_hits.empty()) first_hits = hits;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        const std::string name = place + "ray " + std::to_string(i) + " " + text_of(scene.rays[i]) + ": ";
        if (!test::is_identical(hits[i], first_hits[i]))
          return name + text_of(hits[i]) + ", but with another kernel " + text_of(first_hits[i]);
        if (scene.is_closed && !hits[i].is_hit()) return name + "leaves a closed mesh";
        if (!can_be_judged(scene.rays[i])) continue;
        fault = test::find_hit_fault(hits[i], expected[i], scene.shapes, scene.instances, scene.rays[i]);
        if (!fault.empty()) return name + fault + ": " + text_of(hits[i]) + " instead of " + text_of(expected[i]);
      }
    }
  }
  return {};
}

}  // namespace

std::string find_trees_fault(std::span<const std::uint8_t> data) {
  ByteReader bytes(data);
  const FuzzScene scene = make_scene(bytes);
  for (const Shape& shape : scene.shapes)
    if (const auto* mesh = std::get_if<Mesh>(&shape))
      if (std::string fault = check_mesh(bytes, *mesh); !fault.empty()) return fault;
  return check_rays(scene);
}

}  // namespace basicrt::fuzz
