// SPDX-License-Identifier: GPL-3.0-or-later
// Walks the two levels of trees with small batches of rays. Boxes are tested in single precision and never lose a hit;
// the hits themselves are computed in double precision in the object's space.
#include "bvh/tracer.h"

#include <cmath>
#include <limits>
#include <tuple>

#include "base/assert.h"
#include "bvh/walk.h"
#include "geometry/precise_ray.h"
#include "geometry/sphere.h"
#include "math/next_float.h"

namespace basicrt {
namespace {

// Looks for the nearest hit.
struct NearestQuery {
  using Result = Hit;

  double t_max;  // nothing beyond is of interest
  double u, v;
  std::uint32_t instance, primitive;

  void start(double ray_t_max) {
    t_max = ray_t_max;
    instance = primitive = Hit::none;
  }
  // Of equal distances the lower numbers win, so that the answer doesn't depend on the order of the visits.
  void add(double hit_t, double hit_u, double hit_v, std::uint32_t hit_instance, std::uint32_t hit_primitive) {
    if (std::tie(hit_t, hit_instance, hit_primitive) >= std::tie(t_max, instance, primitive)) return;
    t_max = hit_t, u = hit_u, v = hit_v;
    instance = hit_instance, primitive = hit_primitive;
  }
  [[nodiscard]] Hit result() const {
    if (instance == Hit::none) return {};
    return {static_cast<float>(t_max), instance, primitive, static_cast<float>(u), static_cast<float>(v)};
  }
};

// Looks for any hit, after which nothing is near enough to be of interest.
struct AnyQuery {
  using Result = std::uint8_t;
  static constexpr double found = -std::numeric_limits<double>::infinity();

  double t_max;

  void start(double ray_t_max) { t_max = ray_t_max; }
  void add(double, double, double, std::uint32_t, std::uint32_t) { t_max = found; }
  [[nodiscard]] std::uint8_t result() const { return t_max == found; }
};

bool is_traceable(const Ray& ray) {
  const Float4 origin = Float4::of(ray.origin.x, ray.origin.y, ray.origin.z, 0);
  const Float4 direction = Float4::of(ray.direction.x, ray.direction.y, ray.direction.z, 0);
  const Float4 largest = Float4::all(std::numeric_limits<float>::max());
  const Mask4 is_finite_lane = (abs(origin) <= largest) & (abs(direction) <= largest);
  const Mask4 is_zero_lane = direction == Float4::all(0);
  return (is_finite_lane.bits() == 15) & (is_zero_lane.bits() != 15) & (ray.t_min <= ray.t_max);
}

bool is_translation(const TransformD& transform) {
  TransformD linear = transform;
  for (auto& row : linear.rows) row[3] = 0;
  return linear == TransformD{};
}

// The box of an instance in the world, with room for what its two transforms don't agree on.
Bounds3f world_bounds(const Bounds3f& local, const TracedInstance& instance) {
  const Bounds3<double> box =
      transform_bounds(instance.object_to_world, Bounds3<double>{Vec3d(local.lower), Vec3d(local.upper)});
  Bounds3f result;
  if (box.is_empty()) return result;
  const Vec3d reach = max(abs(box.lower), abs(box.upper));
  Vec3d margin;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        margin[i] += std::abs(instance.object_to_world.rows[i][j] * instance.world_to_object.rows[j][k]) * reach[k];
  for (std::size_t i = 0; i < 3; ++i) {
    const double padding = margin[i] * 16 * std::numeric_limits<double>::epsilon();
    result.lower[i] = next_float_down(static_cast<float>(box.lower[i] - padding));
    result.upper[i] = next_float_up(static_cast<float>(box.upper[i] + padding));
  }
  return result;
}

// Takes a group of rays to the triangles of a mesh.
template <class Query>
struct MeshVisitor {
  const MeshTree& tree;
  const PreciseRay* rays;
  std::uint32_t instance;
  Query* queries;

  [[nodiscard]] float t_max(RayIndex ray) const { return static_cast<float>(queries[ray].t_max); }
  void visit_leaf(std::uint32_t first, std::uint32_t count, std::span<const RayIndex> group) {
    for (const TrianglePair& pair : std::span(tree.pairs).subspan(first, count)) {
      const PreparedPair prepared(pair);
      for (const RayIndex ray : group) {
        const PairHits hits = intersect_pair(prepared, rays[ray], queries[ray].t_max);
        if (hits.bits != 0) add(queries[ray], hits, pair);
      }
    }
  }
  void add(Query& query, const PairHits& hits, const TrianglePair& pair) {
    alignas(16) double t[2], u[2], v[2];
    hits.t.store(t);
    hits.u.store(u);
    hits.v.store(v);
    for (int lane = 0; lane < 2; ++lane)
      if (hits.bits >> lane & 1) query.add(t[lane], u[lane], v[lane], instance, pair.primitive[lane]);
  }
};

// Rays and queries are addressed by the numbers in the group.
template <class Query>
void intersect_geometry(const MeshTree& tree, const PreciseRay* rays, std::span<const RayIndex> group,
                        std::uint32_t instance, Query* queries) {
  MeshVisitor<Query> visitor{tree, rays, instance, queries};
  WideBoxRay box_rays[batch_size];
  // The box of a tree that is a single leaf was tested among the instances.
  if (!tree.bvh.nodes.empty())
    for (const RayIndex ray : group)
      box_rays[ray].set(make_box_ray(rays[ray].origin, rays[ray].direction), static_cast<float>(rays[ray].t_min));
  GroupWalk(tree.bvh, box_rays, visitor).visit(tree.bvh.root, group);
}

template <class Query>
void intersect_geometry(const Sphere& sphere, const PreciseRay* rays, std::span<const RayIndex> group,
                        std::uint32_t instance, Query* queries) {
  for (const RayIndex index : group) {
    PreciseRay ray = rays[index];
    ray.t_max = queries[index].t_max;
    const auto t = intersect_sphere(ray, sphere);
    if (!t) continue;
    const Vec2d uv = sphere_uv(ray.origin + ray.direction * *t - Vec3d(sphere.center));
    queries[index].add(*t, uv.x, uv.y, instance, 0);
  }
}

}  // namespace

Tracer::Tracer() = default;
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

Tracer::Tracer(std::vector<ShapeTree> trees, std::vector<TracedInstance> instances, const BvhConfig& config)
    : trees_(std::move(trees)) {
  std::vector<Bounds3f> boxes;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    BASICRT_ASSERT(instances[i].shape < trees_.size());
    const Bounds3f box = world_bounds(trees_[instances[i].shape].bounds, instances[i]);
    if (box.is_empty()) continue;
    boxes.push_back(box);
    indices.push_back(i);
  }
  BvhConfig instance_config = config;
  instance_config.max_leaf_size = 1;
  const Bvh bvh = build_bvh(boxes, instance_config);
  instance_bvh_ = WideBvhBuilder(bvh).build([&](std::span<const std::uint32_t> leaf) {
    const auto first = static_cast<std::uint32_t>(placed_.size());
    for (const std::uint32_t box : leaf) {
      const TracedInstance& instance = instances[indices[box]];
      placed_.push_back({.world_to_object = instance.world_to_object,
                         .shape = instance.shape,
                         .index = indices[box],
                         .visibility = instance.visibility,
                         .is_translation = is_translation(instance.world_to_object)});
    }
    return WideReference{first, static_cast<std::uint32_t>(leaf.size())};
  });
}

// Takes a group of rays to the instances.
template <class Query>
struct Tracer::InstanceVisitor {
  const Tracer& tracer;
  const Ray* rays;
  Query* queries;
  PreciseRay local_rays[batch_size];  // in the space of the instance being visited, those that see it

  InstanceVisitor(const Tracer& the_tracer, const Ray* the_rays, Query* the_queries)
      : tracer(the_tracer), rays(the_rays), queries(the_queries) {}

  [[nodiscard]] float t_max(RayIndex ray) const { return static_cast<float>(queries[ray].t_max); }
  void visit_leaf(std::uint32_t first, std::uint32_t count, std::span<const RayIndex> group) {
    for (const PlacedInstance& instance : std::span(tracer.placed_).subspan(first, count)) visit(instance, group);
  }
  void visit(const PlacedInstance& instance, std::span<const RayIndex> group) {
    RayIndex seeing[batch_size];
    std::size_t count = 0;
    for (const RayIndex ray : group) {
      seeing[count] = ray;
      count += (rays[ray].kinds & instance.visibility) != 0;
    }
    const std::span<const RayIndex> local_group(seeing, count);
    if (instance.is_translation) {
      const Vec3d translation = instance.world_to_object.column(3);
      for (const RayIndex ray : local_group) local_rays[ray] = translate_ray(translation, rays[ray]);
    } else {
      for (const RayIndex ray : local_group) local_rays[ray] = transform_ray(instance.world_to_object, rays[ray]);
    }
    std::visit(
        [&](const auto& geometry) { intersect_geometry(geometry, local_rays, local_group, instance.index, queries); },
        tracer.trees_[instance.shape].geometry);
  }
};

template <class Query>
void Tracer::trace(std::span<const Ray> rays, std::span<typename Query::Result> results) const {
  BASICRT_ASSERT(rays.size() == results.size());
  for (std::size_t first = 0; first < rays.size(); first += batch_size) {
    const std::size_t count = std::min(batch_size, rays.size() - first);
    trace_batch<Query>(rays.subspan(first, count), results.subspan(first, count));
  }
}

template <class Query>
void Tracer::trace_batch(std::span<const Ray> rays, std::span<typename Query::Result> results) const {
  WideBoxRay box_rays[batch_size];
  Query queries[batch_size];
  RayIndex group[batch_size];
  std::size_t group_size = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    // Boxes that are never entered lie at infinity, which must be out of reach.
    queries[i].start(std::min(ray.t_max, std::numeric_limits<float>::max()));
    box_rays[i].set(make_box_ray(ray.origin, ray.direction), std::max(0.0f, ray.t_min));
    group[group_size] = static_cast<RayIndex>(i);
    group_size += is_traceable(ray);
  }
  if (group_size > 0 && !instance_bvh_.is_empty()) {
    InstanceVisitor<Query> visitor(*this, rays.data(), queries);
    GroupWalk(instance_bvh_, box_rays, visitor).visit(instance_bvh_.root, std::span<const RayIndex>(group, group_size));
  }
  for (std::size_t i = 0; i < rays.size(); ++i) results[i] = queries[i].result();
}

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits) const { trace<NearestQuery>(rays, hits); }

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const {
  trace<AnyQuery>(rays, results);
}

Bounds3f Tracer::bounds() const { return instance_bvh_.bounds; }

std::vector<ShapeTree> Tracer::take_trees() {
  std::vector<ShapeTree> trees = std::move(trees_);
  *this = Tracer();
  return trees;
}

}  // namespace basicrt
