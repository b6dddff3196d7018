// SPDX-License-Identifier: GPL-3.0-or-later
// Walks the two levels of trees, one ray after another. Boxes are tested in single precision and never lose a hit;
// the hits themselves are computed in double precision in the object's space.
#include "bvh/tracer.h"

#include <cmath>
#include <limits>

#include "base/assert.h"
#include "geometry/precise_ray.h"
#include "geometry/sphere.h"

namespace basicrt {
namespace {

// Looks for the nearest hit. Both queries say how far there is still something to look for.
struct NearestQuery {
  double t;
  double u = 0, v = 0;
  std::uint32_t instance = Hit::none, primitive = Hit::none;

  [[nodiscard]] double t_max() const { return t; }
  [[nodiscard]] float box_t_max() const { return static_cast<float>(t); }
  // Of equal distances the lower numbers win, so that the answer doesn't depend on the order of the visits.
  void add(double hit_t, double hit_u, double hit_v, std::uint32_t hit_instance, std::uint32_t hit_primitive) {
    const bool is_nearer =
        hit_t < t ||
        (hit_t == t && (hit_instance < instance || (hit_instance == instance && hit_primitive < primitive)));
    if (!is_nearer) return;
    t = hit_t, u = hit_u, v = hit_v;
    instance = hit_instance, primitive = hit_primitive;
  }
  [[nodiscard]] Hit hit() const {
    if (instance == Hit::none) return {};
    return {static_cast<float>(t), instance, primitive, static_cast<float>(u), static_cast<float>(v)};
  }
};

// Looks for any hit.
struct AnyQuery {
  double t;
  bool is_found = false;

  [[nodiscard]] double t_max() const { return t; }
  [[nodiscard]] float box_t_max() const {
    return is_found ? -std::numeric_limits<float>::infinity() : static_cast<float>(t);
  }
  void add(double, double, double, std::uint32_t, std::uint32_t) { is_found = true; }
};

// Zero times anything but a number is NaN.
bool is_traceable(const Ray& ray) {
  const Vec3f zero = ray.origin * 0.0f + ray.direction * 0.0f;
  return zero.x + zero.y + zero.z == 0 && ray.t_min <= ray.t_max && ray.direction != Vec3f(0);
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
    result.lower[i] = std::nextafter(static_cast<float>(box.lower[i] - padding), -infinity);
    result.upper[i] = std::nextafter(static_cast<float>(box.upper[i] + padding), infinity);
  }
  return result;
}

template <class Query>
float intersect_pairs(std::span<const TrianglePair> pairs, const PairRay& ray, std::uint32_t instance, Query& query) {
  for (const TrianglePair& pair : pairs) {
    const PairHits hits = intersect_pair(pair, ray, query.t_max());
    if (hits.bits == 0) continue;
    alignas(16) double t[2], u[2], v[2];
    hits.t.store(t);
    hits.u.store(u);
    hits.v.store(v);
    for (int lane = 0; lane < 2; ++lane)
      if (hits.bits >> lane & 1) query.add(t[lane], u[lane], v[lane], instance, pair.primitive[lane]);
  }
  return query.box_t_max();
}

template <class Query>
void intersect_tree(const MeshTree& tree, const PreciseRay& ray, const BoxRay& box_ray, std::uint32_t instance,
                    Query& query) {
  const PairRay pair_ray(ray);
  const auto visit_leaf = [&](std::uint32_t first, std::uint32_t count) {
    return intersect_pairs(std::span(tree.pairs).subspan(first, count), pair_ray, instance, query);
  };
  // The box of a tree that is a single leaf was tested with the instances.
  if (tree.bvh.nodes.empty()) {
    visit_leaf(tree.bvh.root.first, tree.bvh.root.count);
    return;
  }
  walk(tree.bvh, WideBoxRay(box_ray, static_cast<float>(ray.t_min)), query.box_t_max(), visit_leaf);
}

template <class Query>
void intersect_tree(const Sphere& sphere, PreciseRay ray, const BoxRay&, std::uint32_t instance, Query& query) {
  ray.t_max = query.t_max();
  if (const auto t = intersect_sphere(ray, sphere)) {
    const Vec2d uv = sphere_uv(ray.origin + ray.direction * *t - Vec3d(sphere.center));
    query.add(*t, uv.x, uv.y, instance, 0);
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

template <class Query>
void Tracer::trace_instance(const PlacedInstance& instance, const Ray& ray, Query& query) const {
  if ((instance.visibility & ray.kinds) == 0) return;
  const PreciseRay local = transform_ray(instance.world_to_object, ray);
  const BoxRay box_ray = make_box_ray(local.origin, local.direction);
  std::visit([&](const auto& geometry) { intersect_tree(geometry, local, box_ray, instance.index, query); },
             trees_[instance.shape].geometry);
}

template <class Query>
void Tracer::trace(const Ray& ray, Query& query) const {
  const BoxRay box_ray = make_box_ray(Vec3d(ray.origin), Vec3d(ray.direction));
  walk(instance_bvh_, WideBoxRay(box_ray, ray.t_min), query.box_t_max(), [&](std::uint32_t first, std::uint32_t count) {
    for (const PlacedInstance& instance : std::span(placed_).subspan(first, count))
      trace_instance(instance, ray, query);
    return query.box_t_max();
  });
}

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  BASICRT_ASSERT(rays.size() == hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = {};
    if (instance_bvh_.is_empty() || !is_traceable(rays[i])) continue;
    NearestQuery query{.t = std::min(rays[i].t_max, std::numeric_limits<float>::max())};
    trace(rays[i], query);
    hits[i] = query.hit();
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const {
  BASICRT_ASSERT(rays.size() == results.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    results[i] = 0;
    if (instance_bvh_.is_empty() || !is_traceable(rays[i])) continue;
    AnyQuery query{.t = std::min(rays[i].t_max, std::numeric_limits<float>::max())};
    trace(rays[i], query);
    results[i] = query.is_found;
  }
}

Bounds3f Tracer::bounds() const { return instance_bvh_.bounds; }

std::vector<ShapeTree> Tracer::take_trees() {
  std::vector<ShapeTree> trees = std::move(trees_);
  *this = Tracer();
  return trees;
}

}  // namespace basicrt
