// SPDX-License-Identifier: GPL-3.0-or-later
// Walks rays that go much the same way together, one in each lane: every box and triangle is read once for all of them (Wald, Slusallek, Benthin
// and Wagner 2001, "Interactive Rendering with Coherent Ray Tracing"). Number for number as the stream, so that a ray gets the same hit alone and
// in a packet. A packet that turns out to go apart is given up, and its rays go to the stream.

constexpr unsigned packet_size = sizeof(Pack) / sizeof(float);
constexpr unsigned all_lanes = packet_size == 32 ? ~0u : (1u << packet_size) - 1;

// Lanes of numbers in memory.
struct alignas(64) PackFloats {
  float lanes[packet_size];

  Pack pack() const { return Pack::load(lanes); }
};
struct PackVectors {
  PackFloats axes[3];
};

inline Pack pack_of_bits(std::uint32_t bits) { return Pack::all(__builtin_bit_cast(float, bits)); }

struct alignas(64) PacketSpace {
  Pack entry_origin[3], exit_origin[3], inverse_direction[3];
  Pack begin;  // of what is of interest; among triangles the beginning of the near range
  // What bounds these numbers of all rays, for boxes that none of them meets.
  struct Bounds {
    float entry_origin[3], exit_origin[3], least_inverse[3], most_inverse[3];
    float begin;
  } bounds;
  BoxSpace::Octant octant;
  // For triangles:
  TriangleSpace::Axes axes;
  Pack origin[3], shear[3];
  Pack near_end;
  Pack skipped_primitive;  // as bits
  const char* items[2];    // the tree's nodes and blocks
  std::uint32_t instance;
};

struct alignas(64) Packet {
  const KernelRay* rays;              // packet_size of them
  Pack t, u, v, primitive, instance;  // the last two as bits
};

struct PacketItem {
  PackFloats entries;
  TreeReference reference;
};

struct PacketScratch {
  PackVectors origin, direction, local_origin, local_direction;
  KernelRay rays[packet_size];
  PacketItem stack[stack_capacity];
};

inline bool have_same_sign(Pack values) {
  const unsigned signs = values.sign_bits();
  return (signs == 0) | (signs == all_lanes);
}

inline void set_bounds(PacketSpace& space) {
  auto& bounds = space.bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const Pack entry = space.entry_origin[axis], exit = space.exit_origin[axis],
               inverse = space.inverse_direction[axis];
    bounds.least_inverse[axis] = inverse.smallest();
    bounds.most_inverse[axis] = inverse.largest();
    const bool goes_down = bounds.most_inverse[axis] < 0;
    bounds.entry_origin[axis] = goes_down ? entry.smallest() : entry.largest();
    bounds.exit_origin[axis] = goes_down ? exit.largest() : exit.smallest();
  }
  bounds.begin = space.begin.smallest();
}

// A child is met by no ray where entry > exit, for rounding keeps the order of numbers.
inline void intersect_children(const TreeNode& node, const PacketSpace& space, float t_max, Float8& entry,
                               Float8& exit) {
  const float* planes = &node.bounds[0][0][0];
  const auto& bounds = space.bounds;
  entry = Float8::all(bounds.begin);
  exit = Float8::all(t_max);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t entry_plane = space.octant.entry_planes[axis], exit_plane = entry_plane ^ 8;
    const Float8 least = Float8::all(bounds.least_inverse[axis]), most = Float8::all(bounds.most_inverse[axis]);
    const Float8 to_entry = Float8::load(planes + entry_plane) - Float8::all(bounds.entry_origin[axis]);
    const Float8 to_exit = Float8::load(planes + exit_plane) - Float8::all(bounds.exit_origin[axis]);
    entry = max(min(to_entry * least, to_entry * most), entry);
    exit = min(max(to_exit * least, to_exit * most), exit);
  }
  entry = entry * Float8::all(slab_scale);
}

// As prepare_boxes() does for one ray. False where the rays' octants differ.
inline bool prepare_packet_boxes(PacketSpace& space, const PackVectors& origins, const PackVectors& directions) {
  const Pack smallest = Pack::all(__FLT_MIN__), largest = Pack::all(largest_usable);
  unsigned octant = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const Pack origin = origins.axes[axis].pack(), direction = directions.axes[axis].pack();
    // Rays for which floats don't do, and those along an axis, are left to the stream.
    const auto is_usable = (smallest <= abs(direction)) & (abs(direction) <= largest) & (abs(origin) <= largest);
    if (is_usable.bits() != all_lanes || !have_same_sign(direction)) return false;
    const Pack padding = copysign(abs(origin) * Pack::all(0x1p-23f) + smallest, direction);
    space.entry_origin[axis] = origin + padding;
    space.exit_origin[axis] = origin - padding;
    space.inverse_direction[axis] = Pack::all(1) / direction;
    octant |= (direction.sign_bits() & 1) << axis;
  }
  space.octant = octant_table.rows[octant];
  return true;
}

// As prepare_triangles() does for one ray. False where the rays' largest axes differ or triangles need double precision.
inline bool prepare_packet_triangles(PacketSpace& space, const PackVectors& origins, const PackVectors& directions) {
  const Pack largest = Pack::all(largest_usable);
  const Pack x = abs(directions.axes[0].pack()), y = abs(directions.axes[1].pack()), z = abs(directions.axes[2].pack());
  const Pack distance = max(max(abs(origins.axes[0].pack()), abs(origins.axes[1].pack())), abs(origins.axes[2].pack()));
  const Pack size = max(max(x, y), z);
  const auto is_usable = (distance <= largest) & (size <= largest) & (Pack::all(smallest_usable) <= size);
  const unsigned is_last_z = ((x < z) & (y < z)).bits(), is_y_larger = (x < y).bits();
  if (is_usable.bits() != all_lanes) return false;
  unsigned last = 0;
  if (is_last_z == all_lanes)
    last = 2;
  else if (is_last_z != 0 || (is_y_larger != 0 && is_y_larger != all_lanes))
    return false;
  else
    last = is_y_larger & 1;
  space.axes = axes_by_last[last];
  const Pack scale = Pack::all(1) / directions.axes[last].pack();
  for (int i = 0; i < 3; ++i) {
    const unsigned axis = space.axes.offsets[i] / 4;
    space.origin[i] = origins.axes[axis].pack();
    space.shear[i] = i < 2 ? directions.axes[axis].pack() * scale : scale;
  }
  return true;
}

// What triangle.inl does for one ray and four triangles, for many rays and one.
class PacketWalk {
 public:
  PacketWalk(const KernelScene& scene, PacketScratch& scratch, const char* rays, bool ends_at_hit)
      : scene_(scene), scratch_(scratch), ends_at_hit_(ends_at_hit) {
    __builtin_memcpy(scratch.rays, rays, sizeof scratch.rays);
    packet_.rays = scratch.rays;
  }

  // False where the packet was given up.
  bool run() {
    if (!start()) return false;
    if (scene_.root >= instance_mark) return visit_instance(scene_.root & reference_index, all_lanes, scratch_.stack);
    if (!prepare_packet_boxes(world_, scratch_.origin, scratch_.direction)) return false;
    world_.items[0] = reinterpret_cast<const char*>(scene_.nodes);
    world_.items[1] = reinterpret_cast<const char*>(scene_.instances);
    return walk(world_, scene_.root, scratch_.stack);
  }

  // Rays that met something so near that rounding may have hidden a rival: which one, the order of visits decides. That of the stream is to count.
  unsigned doubtful_rays() const { return doubtful_; }

  // After store().
  KernelHit hit(unsigned lane) const {
    return {t_.lanes[lane], instances_.lanes[lane], primitives_.lanes[lane], u_.lanes[lane], v_.lanes[lane]};
  }
  void store() {
    packet_.t.store(t_.lanes);
    packet_.u.store(u_.lanes);
    packet_.v.store(v_.lanes);
    packet_.primitive.store(reinterpret_cast<float*>(primitives_.lanes));
    packet_.instance.store(reinterpret_cast<float*>(instances_.lanes));
  }

 private:
  struct alignas(64) PackNumbers {
    std::uint32_t lanes[packet_size];
  };

  bool start() {
    alignas(64) float t_min[packet_size], t_max[packet_size];
    kinds_ = packet_.rays[0].kinds;
    for (unsigned lane = 0; lane < packet_size; ++lane) {
      const KernelRay& ray = packet_.rays[lane];
      for (int axis = 0; axis < 3; ++axis) {
        scratch_.origin.axes[axis].lanes[lane] = ray.origin[axis];
        scratch_.direction.axes[axis].lanes[lane] = ray.direction[axis];
      }
      t_min[lane] = ray.t_min;
      t_max[lane] = ray.t_max;
      if (ray.kinds != kinds_) return false;
    }
    const Pack begin = Pack::load(t_min), end = Pack::load(t_max), zero = Pack::all(0);
    if (((begin <= end) & (zero <= end)).bits() != all_lanes) return false;
    t_min_ = max(begin, zero);
    world_.begin = t_min_;
    packet_.t = min(end, Pack::all(__FLT_MAX__));
    t_max_ = packet_.t.largest();
    packet_.u = packet_.v = zero;
    packet_.primitive = packet_.instance = pack_of_bits(~0u);
    return true;
  }

  // Everything below `root`. The stack from `top` on is free.
  bool walk(PacketSpace& space, TreeReference root, PacketItem* top) {
    set_bounds(space);
    const auto* nodes = reinterpret_cast<const TreeNode*>(space.items[0]);
    const auto* blocks = reinterpret_cast<const TriangleBlock*>(space.items[1]);
    PacketItem* const bottom = top;
    t_min_.store(top->entries.lanes);
    (top++)->reference = root;
    while (top != bottom) {
      const PacketItem& item = *--top;
      const TreeReference reference = item.reference;
      const unsigned active = (item.entries.pack() <= packet_.t).bits();
      if (active == 0) continue;
      if (is_going_apart(active)) return false;
      if (reference < triangles_mark) {
        top = visit_node(space, nodes[reference], top);
      } else if (reference < instance_mark) {
        visit_block(space, blocks[reference & reference_index], active);
      } else if (!visit_instance(reference & reference_index, active, top)) {
        return false;
      }
    }
    return true;
  }

  // Whether so few rays have met what was visited that each is better off alone.
  bool is_going_apart(unsigned active) {
    ++visit_count_;
    active_count_ += static_cast<unsigned>(__builtin_popcount(active));
    return visit_count_ > 16 && 4 * active_count_ < packet_size * visit_count_;
  }

  PacketItem* visit_node(const PacketSpace& space, const TreeNode& node, PacketItem* top) const {
    const float* planes = &node.bounds[0][0][0];
    Float8 first_entry, last_exit;
    intersect_children(node, space, t_max_, first_entry, last_exit);
    std::uint32_t numbers[8];
    const std::uint32_t count = list_children(node, space.octant.order_shift, first_entry, last_exit, numbers);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t child = numbers[i] & 7;
      Pack entry = space.begin, exit = packet_.t;
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t entry_plane = space.octant.entry_planes[axis], exit_plane = entry_plane ^ 8;
        const Pack inverse = space.inverse_direction[axis];
        entry = max((Pack::all(planes[entry_plane + child]) - space.entry_origin[axis]) * inverse, entry);
        exit = min((Pack::all(planes[exit_plane + child]) - space.exit_origin[axis]) * inverse, exit);
      }
      entry = entry * Pack::all(slab_scale);
      const auto is_met = entry <= exit;
      if (is_met.bits() == 0) continue;
      // A ray that doesn't meet the box never gets near enough.
      select(is_met, entry, Pack::all(__builtin_inff())).store(top->entries.lanes);
      prefetch_item(space.items, node.children[child]);
      (top++)->reference = node.children[child];
    }
    return top;
  }

  void visit_block(const PacketSpace& space, const TriangleBlock& block, unsigned active) {
    for (unsigned lane = 0; lane < 4; ++lane) {
      if (lane > 0 && block.primitives[lane] == block.primitives[lane - 1]) break;  // copies of the last
      visit_triangle(space, block, lane, active);
    }
  }

  [[gnu::always_inline]] void visit_triangle(const PacketSpace& space, const TriangleBlock& block, unsigned lane,
                                             unsigned active) {
    Pack x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
      const float* corner = &block.corners[i][0][lane];
      z[i] = Pack::all(corner[space.axes.offsets[2]]) - space.origin[2];
      x[i] = (Pack::all(corner[space.axes.offsets[0]]) - space.origin[0]) - space.shear[0] * z[i];
      y[i] = (Pack::all(corner[space.axes.offsets[1]]) - space.origin[1]) - space.shear[1] * z[i];
    }
    const Pack w0 = x[2] * y[1] - y[2] * x[1], w1 = x[0] * y[2] - y[0] * x[2], w2 = x[1] * y[0] - y[1] * x[0];
    const Pack zero = Pack::all(0);
    const auto may_be_inside = (zero <= min(min(w0, w1), w2)) | (max(max(w0, w1), w2) <= zero);
    const Pack least = min(min(abs(w0), abs(w1)), abs(w2));
    const unsigned unclear = (least <= Pack::all(smallest_weight)).bits() & active;
    if (((may_be_inside.bits() & active) | unclear) == 0) return;

    const Pack inverse = Pack::all(1) / (w0 + w1 + w2);
    const Pack t = (w0 * z[0] + w1 * z[1] + w2 * z[2]) * space.shear[2] * inverse;
    const auto is_hit = may_be_inside & (t <= packet_.t) & (space.begin <= t);
    const unsigned skipped = (pack_of_bits(block.primitives[lane]) == space.skipped_primitive).bits();
    unsigned hits = is_hit.bits() & active & ~skipped;
    const unsigned near = hits & (t <= space.near_end).bits();
    const unsigned ties = hits & (t == packet_.t).bits();
    const unsigned slow = near | ties | (unclear & ~skipped);
    hits &= ~slow;
    if (hits != 0) take(Pack::mask(hits), t, w1 * inverse, w2 * inverse, block.primitives[lane], space.instance);
    if (__builtin_expect(slow != 0, 0))
      for (unsigned ray = 0; ray < packet_size; ++ray)
        if (slow >> ray & 1) doubtful_ |= static_cast<unsigned>(test_alone(space, block, lane, ray)) << ray;
  }

  template <class Mask>
  void take(Mask mask, Pack t, Pack u, Pack v, std::uint32_t primitive, std::uint32_t instance) {
    packet_.t = select(mask, ends_at_hit_ ? Pack::all(-__builtin_inff()) : t, packet_.t);
    packet_.u = select(mask, u, packet_.u);
    packet_.v = select(mask, v, packet_.v);
    packet_.primitive = select(mask, pack_of_bits(primitive), packet_.primitive);
    packet_.instance = select(mask, pack_of_bits(instance), packet_.instance);
    t_max_ = packet_.t.largest();
  }

  // One ray and one triangle, as the stream tests them. True where that is the ray's new hit.
  [[gnu::noinline]] bool test_alone(const PacketSpace& packet_space, const TriangleBlock& block, unsigned lane,
                                    unsigned ray) {
    store();
    BoxSpace boxes;
    TriangleSpace triangles;
    if (!enter_instance(boxes, triangles, scene_, packet_space.instance, packet_.rays[ray])) return false;
    const TriangleHits hits = intersect_block(block, triangles, boxes.begin, t_.lanes[ray], scene_, packet_.rays[ray]);
    if (!(hits.is_hit.bits() >> lane & 1)) return false;
    alignas(16) float t[4], u[4], v[4];
    hits.t.store(t);
    hits.u.store(u);
    hits.v.store(v);
    const KernelHit found{t[lane], packet_space.instance, block.primitives[lane], u[lane], v[lane]};
    if (!is_better(scene_, found, hit(ray))) return false;
    take(Pack::mask(1u << ray), Pack::all(found.t), Pack::all(found.u), Pack::all(found.v), found.primitive,
         found.instance);
    return true;
  }

  // Walks the instance's tree, with the stack from `top` on. False where a packet can't.
  bool visit_instance(std::uint32_t index, unsigned active, PacketItem* top) {
    const KernelInstance& instance = scene_.instances[index];
    if (!(kinds_ & instance.visibility)) return true;
    if (instance.interval_count != 0) return false;  // deforms: left to the stream
    if (instance.root == no_reference) {
      for (unsigned ray = 0; ray < packet_size; ++ray)
        if (active >> ray & 1) intersect_precisely(index, ray);
      return true;
    }
    // Entering costs as much as many nodes, and the same for few rays as for all.
    if (4 * static_cast<unsigned>(__builtin_popcount(active)) < packet_size) return false;
    const PackVectors *origins = &scratch_.origin, *directions = &scratch_.direction;
    if (instance.space != KernelInstance::Space::world) {
      transform_all(instance);
      origins = &scratch_.local_origin;
      directions = &scratch_.local_direction;
    }
    PacketSpace& space = local_;
    if (!prepare_packet_boxes(space, *origins, *directions)) return false;
    if (!prepare_packet_triangles(space, *origins, *directions)) return false;
    const Pack distance = abs(origins->axes[0].pack()) + abs(origins->axes[1].pack()) + abs(origins->axes[2].pack());
    const Pack margin = (Pack::all(instance.reach) + distance) * abs(space.shear[2]) * Pack::all(near_reach);
    space.begin = t_min_ - margin;
    space.near_end = t_min_ + margin;
    PackNumbers skipped;
    for (unsigned lane = 0; lane < packet_size; ++lane)
      skipped.lanes[lane] = skipped_primitive(scene_, index, packet_.rays[lane]);
    space.skipped_primitive = Pack::load(reinterpret_cast<const float*>(skipped.lanes));
    space.items[0] = reinterpret_cast<const char*>(instance.nodes);
    space.items[1] = reinterpret_cast<const char*>(instance.blocks);
    space.instance = index;
    return walk(space, instance.root, top);
  }

  // One ray and an instance that kernels don't walk.
  void intersect_precisely(std::uint32_t instance, unsigned ray) {
    store();
    const KernelHit best = hit(ray);
    KernelHit found = best;
    if (scene_.intersect_precisely(scene_.owner, instance, packet_.rays[ray], found) && is_better(scene_, found, best))
      take(Pack::mask(1u << ray), Pack::all(found.t), Pack::all(found.u), Pack::all(found.v), found.primitive,
           instance);
  }

  // As transform() for each ray.
  void transform_all(const KernelInstance& instance) {
    auto& origins = scratch_.local_origin.axes;
    auto& directions = scratch_.local_direction.axes;
    if (__builtin_expect(instance.space == KernelInstance::Space::moving, 0)) {
      for (unsigned lane = 0; lane < packet_size; ++lane) {
        const LocalRay local = transform(scene_, instance, packet_.rays[lane]);
        alignas(16) float origin[4], direction[4];
        local.origin.store(origin);
        local.direction.store(direction);
        for (int axis = 0; axis < 3; ++axis) {
          origins[axis].lanes[lane] = origin[axis];
          directions[axis].lanes[lane] = direction[axis];
        }
      }
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double* const m = instance.world_to_object[axis];
      transform_lanes(m, m[3], scratch_.origin, origins[axis]);
      transform_lanes(m, 0, scratch_.direction, directions[axis]);
    }
  }
  // A loop that compilers turn into vectors.
  static void transform_lanes(const double* m, double offset, const PackVectors& from, PackFloats& to) {
    const double x = m[0], y = m[1], z = m[2];
    for (unsigned lane = 0; lane < packet_size; ++lane)
      to.lanes[lane] = static_cast<float>(x * from.axes[0].lanes[lane] + y * from.axes[1].lanes[lane] +
                                          z * from.axes[2].lanes[lane] + offset);
  }

  const KernelScene& scene_;
  PacketScratch& scratch_;
  bool ends_at_hit_;
  std::uint32_t kinds_ = 0;
  unsigned visit_count_ = 0, active_count_ = 0, doubtful_ = 0;
  Packet packet_;
  Pack t_min_;
  float t_max_;  // of all rays
  PacketSpace world_, local_;
  PackFloats t_, u_, v_;
  PackNumbers primitives_, instances_;
};
