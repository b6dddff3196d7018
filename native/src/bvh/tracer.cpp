// SPDX-License-Identifier: GPL-3.0-or-later
// Hands batches of rays to the kernel, and does for it what needs double precision.
#include "bvh/tracer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>

#include "base/assert.h"
#include "base/overloaded.h"
#include "bvh/kernels/chosen_kernel.h"
#include "bvh/kernels/scratch.h"
#include "bvh/precise_walk.h"
#include "bvh/tree_access.h"
#include "geometry/motion.h"
#include "geometry/precise_ray.h"
#include "geometry/triangle.h"
#include "math/next_float.h"

namespace basicrt {
namespace {

static_assert(sizeof(Ray) == sizeof(KernelRay) && offsetof(Ray, direction) == offsetof(KernelRay, direction) &&
              offsetof(Ray, kinds) == offsetof(KernelRay, kinds) &&
              offsetof(Ray, from_instance) == offsetof(KernelRay, from_instance) && std::is_trivially_copyable_v<Ray>);
static_assert(sizeof(Hit) == sizeof(KernelHit) && offsetof(Hit, instance) == offsetof(KernelHit, instance) &&
              offsetof(Hit, u) == offsetof(KernelHit, u) && std::is_trivially_copyable_v<Hit>);

KernelInstance::Space space_of(const TransformD& world_to_object) {
  TransformD linear = world_to_object;
  for (auto& row : linear.rows) row[3] = 0;
  if (linear != TransformD{}) return KernelInstance::Space::transformed;
  return world_to_object == TransformD{} ? KernelInstance::Space::world : KernelInstance::Space::translated;
}

float reach_of(const Bounds3f& box) { return max_component(max(abs(box.lower), abs(box.upper))); }

// Beyond, products of coordinates may overflow or underflow single precision.
bool is_usable_for_kernels(const Bounds3f& box) { return reach_of(box) >= 0x1p-40f && reach_of(box) <= 0x1p40f; }

// Empty where the tree isn't of a mesh that deforms, or not one for kernels.
std::vector<KernelInterval> kernel_intervals(const ShapeTree& tree) {
  const auto* mesh = std::get_if<MovingMeshTree>(&tree.geometry);
  std::vector<KernelInterval> result;
  if (mesh == nullptr || !is_usable_for_kernels(mesh->bounds)) return result;
  for (const MovingMeshTree::Interval& interval : mesh->intervals)
    result.push_back({interval.tree.nodes.data(), interval.blocks.data(), interval.tree.root});
  return result;
}

// `mesh` is null where the instance is of another shape than a still mesh.
KernelInstance kernel_instance(const MeshTree* mesh, const TracedInstance& instance) {
  KernelInstance result{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      result.world_to_object[row][column] = instance.world_to_object.rows[row][column];
  result.root = result.first_merged = no_reference;
  result.visibility = instance.visibility;
  result.space = instance.motion.empty() ? space_of(instance.world_to_object) : KernelInstance::Space::moving;
  result.motion = instance.motion.empty() ? nullptr : &instance.motion;
  if (mesh == nullptr || !is_usable_for_kernels(mesh->tree.bounds)) return result;
  result.reach = reach_of(mesh->tree.bounds);
  result.nodes = mesh->tree.nodes.data();
  result.blocks = mesh->blocks.data();
  result.root = mesh->tree.root;
  return result;
}

// Entering an instance costs as much as several nodes: meshes of fewer triangles, used once and seen by the same rays, share a tree instead.
constexpr std::size_t smallest_own_tree = 256;

// The mesh's triangles in world space, by their numbers.
std::vector<std::array<Vec3f, 3>> world_triangles(const MeshTree& mesh, const TransformD& object_to_world) {
  std::vector<std::array<Vec3f, 3>> triangles;
  for (const TriangleBlock& block : mesh.blocks)
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::uint32_t primitive = block.primitives[lane];
      if (triangles.size() <= primitive) triangles.resize(primitive + 1);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& corner = block.corners[i];
        const Vec3d position{corner[0][lane], corner[1][lane], corner[2][lane]};
        triangles[primitive][i] = Vec3f(object_to_world.point(position));
      }
    }
  return triangles;
}

// The box of an instance in the world, with room for what its two transforms don't agree on.
Bounds3f world_bounds(const Bounds3f& local, const TransformD& object_to_world, const TransformD& world_to_object) {
  const Bounds3<double> box =
      transform_bounds(object_to_world, Bounds3<double>{Vec3d(local.lower), Vec3d(local.upper)});
  Bounds3f result;
  if (box.is_empty()) return result;
  const Vec3d reach = max(abs(box.lower), abs(box.upper));
  Vec3d margin;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        margin[i] += std::abs(object_to_world.rows[i][j] * world_to_object.rows[j][k]) * reach[k];
  for (std::size_t i = 0; i < 3; ++i) {
    const double padding = margin[i] * 16 * std::numeric_limits<double>::epsilon();
    result.lower[i] = next_float_down(static_cast<float>(box.lower[i] - padding));
    result.upper[i] = next_float_up(static_cast<float>(box.upper[i] + padding));
  }
  return result;
}

// At all times: what moves along a line stays within the boxes of the line's ends.
Bounds3f world_bounds(const Bounds3f& local, const TracedInstance& instance) {
  if (instance.motion.empty()) return world_bounds(local, instance.object_to_world, instance.world_to_object);
  Bounds3f result;
  for (const TransformD& key : instance.motion) result.extend(world_bounds(local, key, inverse(key)));
  return result;
}

TransformD world_to_object_at(const KernelInstance& instance, float time) {
  return inverse(transform_at(*static_cast<const std::vector<TransformD>*>(instance.motion), time));
}

TransformD world_to_object(const KernelInstance& instance, float time) {
  if (instance.motion != nullptr) return world_to_object_at(instance, time);
  TransformD result;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) result.rows[row][column] = instance.world_to_object[row][column];
  return result;
}

double plane_distance(const KernelInstance& instance, const KernelRay& ray, const float (&corners)[3][3]) {
  const auto corner = [&](int i) { return Vec3f{corners[i][0], corners[i][1], corners[i][2]}; };
  const PreciseRay local = transform_ray(world_to_object(instance, ray.time), std::bit_cast<Ray>(ray));
  // No negative zero: which of two zeros is the smaller would be left to the instruction set.
  return intersect_triangle_plane(local, corner(0), corner(1), corner(2)).t + 0.0;
}

}  // namespace

// Asks for a kernel so that a bad BASICRT_ISA is told of here: nothing may throw while rays are traced.
Tracer::Tracer() { (void)chosen_kernel(); }
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

Tracer::Tracer(std::vector<ShapeTree> trees, std::vector<TracedInstance> instances, const BvhConfig& config)
    : trees_(std::move(trees)), instances_(std::move(instances)) {
  (void)chosen_kernel();
  for (const ShapeTree& tree : trees_) kernel_intervals_.push_back(kernel_intervals(tree));
  boxes_.reserve(instances_.size());
  kernel_instances_.reserve(instances_.size() + 1);
  for (const TracedInstance& instance : instances_) {
    BASICRT_ASSERT(instance.shape < trees_.size());
    const ShapeTree& tree = trees_[instance.shape];
    boxes_.push_back(box_of(instance));
    KernelInstance& added =
        kernel_instances_.emplace_back(kernel_instance(std::get_if<MeshTree>(&tree.geometry), instance));
    const std::vector<KernelInterval>& intervals = kernel_intervals_[instance.shape];
    if (intervals.empty()) continue;
    added.reach = reach_of(tree.bounds);
    added.intervals = intervals.data();
    added.interval_count = static_cast<std::uint32_t>(intervals.size());
  }
  merge_small_meshes(boxes_, config);
  build_tree_of_instances(config);
}

Bounds3f Tracer::box_of(const TracedInstance& instance) const {
  return world_bounds(trees_[instance.shape].bounds, instance);
}

void Tracer::build_tree_of_instances(const BvhConfig& config) {
  std::vector<Bounds3f> boxes = boxes_;
  bounds_ = {};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    bounds_.extend(boxes[i]);
    if (kernel_instances_[i].first_merged != no_reference) boxes[i] = Bounds3f{};
  }
  boxes.push_back(merged_.tree.bounds);
  instance_tree_ = build_instance_tree(boxes, config);
}

bool Tracer::move_instances(std::span<const Move> moves, const BvhConfig& config) {
  const auto is_simple = [&](const Move& move) {
    const TracedInstance& before = instances_[move.index];
    const KernelInstance& kernel = kernel_instances_[move.index];
    return before.shape == move.instance.shape && before.visibility == move.instance.visibility &&
           before.motion.empty() && move.instance.motion.empty() && kernel_intervals_[before.shape].empty() &&
           kernel.first_merged == no_reference &&
           is_usable_for_kernels(boxes_[move.index]) == is_usable_for_kernels(box_of(move.instance));
  };
  if (!std::ranges::all_of(moves, is_simple)) return false;
  for (const Move& move : moves) {
    instances_[move.index] = move.instance;
    boxes_[move.index] = box_of(move.instance);
    const auto* mesh = std::get_if<MeshTree>(&trees_[move.instance.shape].geometry);
    kernel_instances_[move.index] = kernel_instance(mesh, instances_[move.index]);
  }
  build_tree_of_instances(config);
  return true;
}

void Tracer::merge_small_meshes(std::span<const Bounds3f> boxes, const BvhConfig& config) {
  std::vector<std::uint32_t> use_counts(trees_.size());
  for (const TracedInstance& instance : instances_) ++use_counts[instance.shape];
  const auto may_be_merged = [&](std::uint32_t i) {
    const TracedInstance& instance = instances_[i];
    const auto* mesh = std::get_if<MeshTree>(&trees_[instance.shape].geometry);
    const bool is_small = mesh != nullptr && 4 * mesh->blocks.size() < smallest_own_tree;
    return config.merges_small_meshes && is_small && use_counts[instance.shape] == 1 && instance.motion.empty() &&
           kernel_instances_[i].root != no_reference && is_usable_for_kernels(boxes[i]);
  };
  std::map<std::uint32_t, std::size_t> seen_alike;  // by visibility
  for (std::uint32_t i = 0; i < instances_.size(); ++i)
    if (may_be_merged(i)) ++seen_alike[instances_[i].visibility];
  const auto by_count = [](const auto& a, const auto& b) { return a.second < b.second; };
  const std::uint32_t visibility = seen_alike.empty() ? 0 : std::ranges::max_element(seen_alike, by_count)->first;

  Mesh merged;
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    const TracedInstance& instance = instances_[i];
    if (!may_be_merged(i) || instance.visibility != visibility) continue;
    const auto* mesh = std::get_if<MeshTree>(&trees_[instance.shape].geometry);
    kernel_instances_[i].first_merged = static_cast<std::uint32_t>(merged.triangles.size());
    for (const auto& corners : world_triangles(*mesh, instance.object_to_world)) {
      const auto first = static_cast<std::uint32_t>(merged.positions.size());
      const auto primitive = static_cast<std::uint32_t>(merged.triangles.size()) - kernel_instances_[i].first_merged;
      merged.positions.insert(merged.positions.end(), corners.begin(), corners.end());
      merged.triangles.push_back({first, first + 1, first + 2});
      merged_owners_.push_back({i, primitive});
    }
  }
  BvhConfig small_blocks = config;
  small_blocks.leaf_size = 2;
  merged_ = build_mesh_tree(merged, small_blocks);
  KernelInstance all = kernel_instance(&merged_, TracedInstance{.visibility = visibility});
  all.owners = merged_owners_.data();
  kernel_instances_.push_back(all);
}

// `instance` may be that of the merged meshes, behind all others.
bool Tracer::intersect_precisely(std::uint32_t instance, const Ray& ray, Hit& hit) const {
  PreciseRay local = transform_ray(world_to_object(kernel_instances_[instance], ray.time), ray);
  local.t_max = std::min(local.t_max, static_cast<double>(hit.t));
  const bool is_merged = instance == instances_.size();
  std::uint32_t skipped = Hit::none;
  if (ray.from_instance == instance)
    skipped = ray.from_primitive;
  else if (const std::uint32_t from = ray.from_instance;
           is_merged && from != Hit::none && kernel_instances_[from].first_merged != no_reference)
    skipped = kernel_instances_[from].first_merged + ray.from_primitive;
  const auto in_mesh = [&](const auto& mesh) { return intersect_mesh_precisely(mesh, local, skipped); };
  // Rays may well meet the same point again, and never the curve that they leave.
  const Overloaded in_shape{[&](const Sphere& sphere) { return intersect_sphere_precisely(sphere, local); },
                            [&](const PointTree& points) { return basicrt::intersect_precisely(points, local); },
                            [&](const CurveTree& curves) { return basicrt::intersect_precisely(curves, local); },
                            in_mesh};
  const std::optional<Hit> found =
      is_merged ? in_mesh(merged_) : std::visit(in_shape, trees_[instances_[instance].shape].geometry);
  if (!found) return false;
  hit = *found;
  hit.instance = instance;
  return true;
}

KernelScene Tracer::kernel_scene() const {
  return {.nodes = instance_tree_.nodes.data(),
          .root = instance_tree_.root,
          .instances = kernel_instances_.data(),
          .owner = this,
          .intersect_precisely =
              [](const void* owner, std::uint32_t instance, const KernelRay& ray, KernelHit& hit) {
                auto nearest = std::bit_cast<Hit>(hit);
                const bool is_hit =
                    static_cast<const Tracer*>(owner)->intersect_precisely(instance, std::bit_cast<Ray>(ray), nearest);
                hit = std::bit_cast<KernelHit>(nearest);
                return is_hit;
              },
          .plane_distance = plane_distance,
          .world_to_object_at =
              [](const KernelInstance& instance, float time, double (&result)[3][4]) {
                const TransformD transform = world_to_object_at(instance, time);
                for (std::size_t row = 0; row < 3; ++row)
                  for (std::size_t column = 0; column < 4; ++column) result[row][column] = transform.rows[row][column];
              }};
}

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  BASICRT_ASSERT(rays.size() == hits.size());
  const Kernel& kernel = kernel_ ? *kernel_ : chosen_kernel();
  kernel.intersect(kernel_scene(), rays.data(), hits.data(), rays.size(), kernel_scratch(kernel.scratch_size));
}

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const {
  BASICRT_ASSERT(rays.size() == results.size());
  const Kernel& kernel = kernel_ ? *kernel_ : chosen_kernel();
  kernel.occluded(kernel_scene(), rays.data(), results.data(), rays.size(), kernel_scratch(kernel.scratch_size));
}

std::size_t Tracer::memory() const {
  std::size_t bytes = instance_tree_.memory() + merged_.memory();
  for (const ShapeTree& tree : trees_)
    bytes += std::visit(
        Overloaded{[](const Sphere&) -> std::size_t { return 0; }, [](const auto& mesh) { return mesh.memory(); }},
        tree.geometry);
  return bytes;
}

std::vector<ShapeTree> Tracer::take_trees() {
  std::vector<ShapeTree> trees = std::move(trees_);
  *this = Tracer();
  return trees;
}

}  // namespace basicrt
