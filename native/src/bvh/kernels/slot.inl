// SPDX-License-Identifier: GPL-3.0-or-later
// A ray on its way through the trees, and the steps that it takes, alone (single.inl) or with others in turn (stream.inl).

// What is not an item: the stack is empty, or the walk of an instance is over. They share the mark of instances.
constexpr TreeReference end_of_ray = 0xFFFF'FFFFu, end_of_instance = 0xFFFF'FFFEu;

// Each level of both trees leaves at most seven siblings waiting. Eight are written at once.
constexpr std::uint32_t stack_capacity = 2 * (7 * max_tree_depth + 1) + 8;

// What a ray has still to visit, nearest last, and from which distance on.
struct alignas(64) Stack {
  TreeReference references[stack_capacity];
  float entries[stack_capacity];
  char spread_over_cache_sets[64];
};

struct alignas(64) Slot {
  // Most steps need the first cache line alone, triangles the second too: those of all slots, their stacks and what is fetched for them have to fit
  // in the nearest cache together.
  BoxSpace boxes;        // of the tree that the ray walks
  float t_max;           // of what is still of interest
  TreeReference* top;    // of the stack; what is being visited stays just above it
  const char* items[2];  // the tree's nodes and blocks: the blocks begin the second line
  TriangleSpace triangles;
  struct Found {
    std::uint32_t instance, primitive;
    float u, v;
  } found;  // so far, at t_max

  // Only some steps need these.
  const KernelRay* ray;
  std::size_t index;  // among the rays given
  Stack* stack;
  BoxSpace world;  // for when an instance is left

  void push(TreeReference reference, float entry) {
    *top = reference;
    entries()[0] = entry;
    ++top;
  }
  TreeReference pop() { return *--top; }
  TreeReference current() const { return *top; }
  const TreeNode& node(TreeReference reference) const { return reinterpret_cast<const TreeNode*>(items[0])[reference]; }
  const TriangleBlock& block(TreeReference reference) const {
    return reinterpret_cast<const TriangleBlock*>(items[1])[reference & reference_index];
  }
  // The distances that belong to references from the top on.
  float* entries() const { return reinterpret_cast<float*>(top + stack_capacity); }
  bool has_only(std::ptrdiff_t count) const { return top - stack->references == count; }
  KernelHit hit() const { return {t_max, found.instance, found.primitive, found.u, found.v}; }
};
static_assert(__builtin_offsetof(Slot, items) == 56 && __builtin_offsetof(Slot, ray) == 128 &&
              __builtin_offsetof(Stack, entries) == 4 * stack_capacity);

// Nodes take up four cache lines, blocks and what kernels need of an instance three. Inlined by force: g++ 12 drops calls of what does nothing but
// prefetch.
[[gnu::always_inline]] inline void prefetch_item(const char* const (&items)[2], TreeReference reference) {
  static constexpr std::size_t sizes[4] = {sizeof(TreeNode), sizeof(MovingTriangleBlock), sizeof(TriangleBlock),
                                           sizeof(KernelInstance)};
  const std::uint32_t is_no_node = reference >> 30 != 0;
  const std::uint32_t index = reference < end_of_instance ? reference & reference_index : 0;
  // A number, for there may be no items.
  const std::uintptr_t item = reinterpret_cast<std::uintptr_t>(items[is_no_node]) + index * sizes[reference >> 30];
  for (std::uintptr_t line = 0; line < 3; ++line) __builtin_prefetch(reinterpret_cast<const char*>(item + 64 * line));
  __builtin_prefetch(reinterpret_cast<const char*>(item + 192 - 64 * is_no_node));
}

// To whom the triangle belongs.
inline TriangleOwner owner_of(const KernelScene& scene, std::uint32_t instance, std::uint32_t primitive) {
  const TriangleOwner* owners = instance == ~0u ? nullptr : scene.instances[instance].owners;
  return owners == nullptr ? TriangleOwner{instance, primitive} : owners[primitive];
}

// Of equal distances the lower numbers win, so that the answer doesn't depend on the order of the visits.
[[gnu::noinline]] inline bool has_lower_numbers(const KernelScene& scene, const KernelHit& hit,
                                                const KernelHit& other) {
  const TriangleOwner a = owner_of(scene, hit.instance, hit.primitive);
  const TriangleOwner b = owner_of(scene, other.instance, other.primitive);
  return a.instance != b.instance ? a.instance < b.instance : a.primitive < b.primitive;
}

inline bool is_better(const KernelScene& scene, const KernelHit& hit, const KernelHit& than) {
  if (__builtin_expect(hit.t == than.t, 0)) return has_lower_numbers(scene, hit, than);
  return hit.t < than.t;
}

inline TriangleHits intersect_block(const KernelScene& scene, const Slot& slot, const TriangleBlock& block) {
  return intersect_block(block, slot.triangles, slot.boxes.begin, slot.t_max, scene, *slot.ray);
}

// True where one of the hits is the slot's new one.
inline bool take_nearest_hit(const KernelScene& scene, Slot& slot, const TriangleBlock& block,
                             const TriangleHits& hits) {
  const Float4 distances = select(hits.is_hit, hits.t, Float4::all(__builtin_inff()));
  const float nearest = distances.smallest();
  const auto lane = static_cast<unsigned>(__builtin_ctz((distances == Float4::all(nearest)).bits() | 8));
  alignas(16) float u[4], v[4];
  hits.u.store(u);
  hits.v.store(v);
  const Slot::Found found{slot.triangles.instance, block.primitives[lane], u[lane], v[lane]};
  bool is_new = nearest < slot.t_max;
  if (__builtin_expect(nearest == slot.t_max, 0))
    is_new = has_lower_numbers(scene, {nearest, found.instance, found.primitive, 0, 0}, slot.hit());
  Slot::Found discarded;
  Slot::Found* const targets[2] = {&discarded, &slot.found};  // a branch would be guessed wrong
  *targets[is_new] = found;
  slot.t_max = nearest < slot.t_max ? nearest : slot.t_max;
  return is_new;
}

// Drops what lies behind the hit.
inline void forget_farther(Slot& slot) {
  TreeReference* const references = slot.stack->references;
  const auto count = static_cast<std::uint32_t>(slot.top - references);
  slot.top = references + keep_within(references, slot.stack->entries, count, slot.t_max);
}

// The steps that are not nodes and blocks. Each returns what is to be visited next. `Query` says what is looked for.
template <class Query>
struct Steps {
  const KernelScene& scene;
  const char* rays;
  Query query;

  TreeReference start(Slot& slot, std::size_t index) const {
    const KernelRay& ray = reinterpret_cast<const KernelRay*>(rays)[index];
    slot.ray = &ray;
    slot.index = index;
    slot.t_max = ray.t_max > __FLT_MAX__ ? __FLT_MAX__ : ray.t_max;
    slot.found = {.instance = ~0u, .primitive = ~0u, .u = 0, .v = 0};
    slot.top = slot.stack->references;
    if (!is_traceable(ray) || scene.root == no_reference) return end_of_ray;
    slot.push(end_of_ray, -1);
    if (scene.root >= instance_mark) return enter(slot, scene.root & reference_index);
    prepare_boxes(Float4::load(ray.origin), Float4::load(ray.direction), slot.boxes, slot.world);
    slot.boxes.begin = slot.world.begin = ray.t_min < 0 ? 0 : ray.t_min;
    show_world(slot);
    return scene.root;
  }

  TreeReference leave_instance(Slot& slot) const {
    slot.boxes = slot.world;
    show_world(slot);
    return slot.pop();
  }

  TreeReference enter(Slot& slot, std::uint32_t index) const {
    const KernelInstance& instance = scene.instances[index];
    if (!(slot.ray->kinds & instance.visibility)) return slot.pop();
    if (instance.root == no_reference) return enter_special(slot, index);
    if (!enter_instance(slot.boxes, slot.triangles, scene, index, *slot.ray)) return visit_precisely(slot, index);
    return walk_instance(slot, instance.nodes, instance.blocks, instance.root);
  }

  // A block of triangles that move.
  [[gnu::noinline]] TreeReference test_moving(Slot& slot, TreeReference reference) const {
    const auto* blocks = reinterpret_cast<const MovingTriangleBlock*>(slot.items[1]);
    const KernelInstance& instance = scene.instances[slot.triangles.instance];
    const TriangleBlock block = block_at_time(blocks[reference & reference_index], instance, slot.ray->time);
    const TriangleHits hits = intersect_block(scene, slot, block);
    if (hits.is_hit.bits() != 0 && Query::take_hit(scene, slot, block, hits)) {
      if (Query::ends_at_hit) return end_of_ray;
      forget_farther(slot);
    }
    return slot.pop();
  }

 private:
  template <class Block>
  TreeReference walk_instance(Slot& slot, const TreeNode* nodes, const Block* blocks, TreeReference root) const {
    // Where nothing else waits in the world, the ray ends with the instance.
    if (!slot.has_only(1)) slot.push(end_of_instance, -1);
    slot.items[0] = reinterpret_cast<const char*>(nodes);
    slot.items[1] = reinterpret_cast<const char*>(blocks);
    return root;
  }

  // An instance that is none of a still mesh.
  [[gnu::noinline]] TreeReference enter_special(Slot& slot, std::uint32_t index) const {
    const KernelInstance& instance = scene.instances[index];
    if (instance.interval_count == 0 || !enter_instance(slot.boxes, slot.triangles, scene, index, *slot.ray))
      return visit_precisely(slot, index);
    const KernelInterval& interval = instance.intervals[key_interval(instance.interval_count, slot.ray->time).first];
    return walk_instance(slot, interval.nodes, interval.blocks, interval.root);
  }

  void show_world(Slot& slot) const {
    slot.items[0] = reinterpret_cast<const char*>(scene.nodes);
    slot.items[1] = reinterpret_cast<const char*>(scene.instances);
  }

  // An instance that the kernel can't walk.
  [[gnu::noinline]] TreeReference visit_precisely(Slot& slot, std::uint32_t instance) const {
    KernelHit hit = slot.hit();
    const bool is_hit = scene.intersect_precisely(scene.owner, instance, *slot.ray, hit);
    if (is_hit && is_better(scene, hit, slot.hit())) {
      slot.t_max = hit.t;
      slot.found = {hit.instance, hit.primitive, hit.u, hit.v};
      if (Query::ends_at_hit) return end_of_ray;
      forget_farther(slot);
    }
    return slot.pop();
  }
};

struct NearestQuery {
  static constexpr bool ends_at_hit = false;
  char* hits;

  // Pushes the children that the ray meets.
  static void push(Slot& slot, const TreeNode& node, const Float8& entry, const Float8& exit) {
    slot.top += push_children(node, slot.boxes.octant.order_shift, entry, exit, slot.top, slot.entries()).count;
  }
  // The same where it meets some, but returns the nearest. It is found in the node: sooner than on the stack, where it has just been written.
  static TreeReference push_but_nearest(Slot& slot, const TreeNode& node, const Float8& entry, const Float8& exit) {
    const std::uint32_t shift = slot.boxes.octant.order_shift;
    const PushedChildren pushed = push_children(node, shift, entry, exit, slot.top, slot.entries());
    slot.top += pushed.count - 1;
    return node.children[node.order[pushed.nearest] >> shift & 7];
  }

  static bool take_hit(const KernelScene& scene, Slot& slot, const TriangleBlock& block, const TriangleHits& hits) {
    return take_nearest_hit(scene, slot, block, hits);
  }
  // Number by number: they were written in other pieces a moment ago, and larger loads would wait for that.
  void write(const KernelScene& scene, std::size_t index, const KernelHit& found) const {
    const TriangleOwner owner = owner_of(scene, found.instance, found.primitive);
    const float t = found.instance == ~0u ? __builtin_inff() : found.t, u = found.u, v = found.v;
    char* const hit = hits + sizeof(KernelHit) * index;
    __builtin_memcpy(hit + offsetof(KernelHit, t), &t, 4);
    __builtin_memcpy(hit + offsetof(KernelHit, instance), &owner.instance, 4);
    __builtin_memcpy(hit + offsetof(KernelHit, primitive), &owner.primitive, 4);
    __builtin_memcpy(hit + offsetof(KernelHit, u), &u, 4);
    __builtin_memcpy(hit + offsetof(KernelHit, v), &v, 4);
  }
};

struct AnyQuery {
  static constexpr bool ends_at_hit = true;
  std::uint8_t* results;

  // In no order and without distances: what is met stays of interest till the end.
  static void push(Slot& slot, const TreeNode& node, const Float8& entry, const Float8& exit) {
    slot.top += push_any_children(node, entry, exit, slot.top);
  }
  static TreeReference push_but_nearest(Slot& slot, const TreeNode& node, const Float8& entry, const Float8& exit) {
    push(slot, node, entry, exit);
    return slot.pop();
  }

  static bool take_hit(const KernelScene&, Slot& slot, const TriangleBlock&, const TriangleHits& hits) {
    const bool is_hit = hits.is_hit.bits() != 0;
    slot.found.instance = is_hit ? slot.triangles.instance : slot.found.instance;
    return is_hit;
  }
  void write(const KernelScene&, std::size_t index, const KernelHit& found) const {
    results[index] = found.instance != ~0u;
  }
};
