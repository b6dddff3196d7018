// SPDX-License-Identifier: GPL-3.0-or-later
// Walks many rays through the trees at once. A single ray waits for memory at every node and guesses wrong at every branch. Here each of `slot_count`
// rays takes one step in turn: what it needs next is fetched while the others take theirs, and instead of branching a ray joins the queue of what
// it meets next (interleaved like the lookups of Kocberber, Falsafi and Grot 2015, "Asynchronous Memory Access Chaining").

constexpr std::uint32_t slot_count = 64;

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

// A ray on its way.
struct alignas(64) Slot {
  // All steps need these: two cache lines, for those of all slots together have to stay in the nearest cache.
  Space space;             // of the tree that the ray walks
  TreeReference* top;      // of the stack; what is being visited stays just above it
  const char* items[2];    // the tree's nodes and blocks
  NearRange near;          // hits in it are solved in double precision
  std::uint32_t instance;  // being visited
  KernelHit hit;           // its t is the end of what is still of interest

  // Only some steps need these.
  KernelRay ray;
  std::size_t index;  // among the rays given
  Space world;        // for when an instance is left
  Stack* stack;

  void push(TreeReference reference, float entry) {
    *top = reference;
    entries()[0] = entry;
    ++top;
  }
  TreeReference current() const { return *top; }
  // The distances that belong to references from the top on.
  float* entries() const { return reinterpret_cast<float*>(top + stack_capacity); }
  bool has_only(std::ptrdiff_t count) const { return top - stack->references == count; }
};
static_assert(__builtin_offsetof(Slot, ray) == 128 && __builtin_offsetof(Stack, entries) == 4 * stack_capacity);

struct StreamScratch {
  Slot slots[slot_count];
  Stack stacks[slot_count];
};

// Slots that take the same step next.
struct Queue {
  Slot* slots[slot_count];
  std::size_t size = 0;

  void add_if(bool condition, Slot* slot) {
    slots[size] = slot;
    size += condition;
  }
  Slot* const* end() const { return slots + size; }

  Slot* const* begin() const { return slots; }
};

// Queues by the two highest bits of what is to be visited: nodes, nothing, blocks, and all else.
class Queues {
 public:
  Queues() {
    for (int kind = 0; kind < 4; ++kind) ends_[kind] = starts_[kind] = memory_[kind];
  }
  void add(Slot* slot, TreeReference reference) { *ends_[reference >> 30]++ = slot; }
  bool are_empty() const { return (ends_[0] == starts_[0]) & (ends_[2] == starts_[2]) & (ends_[3] == starts_[3]); }

  struct Taken {
    Slot **first, **last;

    Slot** begin() const { return first; }
    Slot** end() const { return last; }
  };
  // All slots of a queue, which is empty after it. They are good until the next is taken.
  Taken take(int kind) {
    const Taken taken{starts_[kind], ends_[kind]};
    starts_[kind] = ends_[kind] = spare_;
    spare_ = taken.first;
    return taken;
  }

 private:
  Slot* memory_[5][slot_count];
  Slot** starts_[4];
  Slot** ends_[4];
  Slot** spare_ = memory_[4];
};

inline void prefetch_item(const Slot& slot, TreeReference reference) {
  static constexpr std::size_t sizes[4] = {sizeof(TreeNode), sizeof(TreeNode), sizeof(TriangleBlock), 0};
  const char* item = slot.items[reference >> 31] + (reference & reference_index) * sizes[reference >> 30];
  for (int line = 0; line < 4; ++line) __builtin_prefetch(item + 64 * line);
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

// Tests the block that is being visited. True where it holds the slot's new hit.
inline bool take_nearest_hit(const KernelScene& scene, Slot& slot, const TriangleBlock& block) {
  const TriangleHits hits = intersect_block(block, slot.space, scene, slot.instance, slot.ray, slot.near, slot.hit.t);
  const Float4 distances = select(hits.is_hit, hits.t, Float4::all(__builtin_inff()));
  const float nearest = distances.smallest();
  const auto lane = static_cast<unsigned>(__builtin_ctz((distances == Float4::all(nearest)).bits() | 8));
  alignas(16) float u[4], v[4];
  hits.u.store(u);
  hits.v.store(v);
  const KernelHit hit{nearest, slot.instance, block.primitives[lane], u[lane], v[lane]};
  const bool is_new = is_better(scene, hit, slot.hit);
  KernelHit discarded;
  KernelHit* const targets[2] = {&discarded, &slot.hit};  // a branch would be guessed wrong
  *targets[is_new] = hit;
  return is_new;
}

// Takes the rays of one call from start to end. `Query` says what is looked for.
template <class Query>
class Stream {
 public:
  // Of the rays with these numbers.
  Stream(const KernelScene& scene, const char* rays, const std::uint32_t* numbers, std::size_t count, Query query,
         StreamScratch& scratch)
      : scene_(scene), rays_(rays), numbers_(numbers), count_(count), query_(query), scratch_(scratch) {}

  void run() {
    for (std::uint32_t i = 0; i < slot_count; ++i) {
      scratch_.slots[i].stack = &scratch_.stacks[i];
      start_next(scratch_.slots[i]);
    }
    while (!queues_.are_empty()) {
      visit_nodes();
      visit_blocks();
      visit_others();
    }
  }

 private:
  // Gives the slot the next ray that can hit anything, or leaves it idle.
  void start_next(Slot& slot) {
    while (next_ < count_) {
      slot.index = numbers_[next_++];
      __builtin_memcpy(&slot.ray, rays_ + sizeof(KernelRay) * slot.index, sizeof(KernelRay));
      slot.hit = {.t = slot.ray.t_max > __FLT_MAX__ ? __FLT_MAX__ : slot.ray.t_max,
                  .instance = ~0u,
                  .primitive = ~0u,
                  .u = 0,
                  .v = 0};
      if (!is_traceable(slot.ray) || scene_.root == no_reference) {
        query_.finish(scene_, slot);
        continue;
      }
      slot.top = slot.stack->references;
      slot.push(end_of_ray, -1);
      if (scene_.root >= instance_mark) return visit_instance(slot, scene_.root & reference_index);
      prepare_boxes(slot.world, Float4::load(slot.ray.origin), Float4::load(slot.ray.direction));
      enter_world(slot);
      return visit_next(slot, scene_.root);
    }
  }

  void enter_world(Slot& slot) {
    slot.space = slot.world;
    slot.near.begin = slot.ray.t_min < 0 ? 0 : slot.ray.t_min;
    slot.items[0] = reinterpret_cast<const char*>(scene_.nodes);
    slot.items[1] = reinterpret_cast<const char*>(scene_.instances);
  }

  void visit_next(Slot& slot, TreeReference reference) {
    *slot.top = reference;
    prefetch_item(slot, reference);
    queues_.add(&slot, reference);
  }
  void pop(Slot& slot) { visit_next(slot, *--slot.top); }

  [[gnu::noinline]] void visit_nodes() {
    const auto visited = queues_.take(0);
    for (Slot* slot : visited) {
      const TreeNode& node = reinterpret_cast<const TreeNode*>(slot->items[0])[slot->current()];
      Float8 entry, exit;
      intersect_children(node, slot->space, slot->near.begin, slot->hit.t, entry, exit);
      slot->top += push_children(node, slot->space.octant.order_shift, entry, exit, slot->top, slot->entries());
    }
    for (Slot* slot : visited) pop(*slot);
  }

  [[gnu::noinline]] void visit_blocks() {
    const auto visited = queues_.take(2);
    Queue hit, missed;
    for (Slot* slot : visited) {
      const auto* blocks = reinterpret_cast<const TriangleBlock*>(slot->items[1]);
      const bool is_hit = query_.take_hit(scene_, *slot, blocks[slot->current() & reference_index]);
      hit.add_if(is_hit, slot);
      if constexpr (Query::ends_at_hit) missed.add_if(!is_hit, slot);
    }
    if constexpr (Query::ends_at_hit) {
      for (Slot* slot : missed) pop(*slot);
      for (Slot* slot : hit) finish(*slot);
    } else {
      for (Slot* slot : hit) forget_farther(*slot);
      for (Slot* slot : visited) pop(*slot);
    }
  }

  static void forget_farther(Slot& slot) {
    TreeReference* const references = slot.stack->references;
    const auto count = static_cast<std::uint32_t>(slot.top - references);
    slot.top = references + keep_within(references, slot.stack->entries, count, slot.hit.t);
  }

  // Instances are entered and left, rays end.
  [[gnu::noinline]] void visit_others() {
    const auto visited = queues_.take(3);
    for (Slot* slot : visited) {
      const TreeReference current = slot->current();
      if (current == end_of_ray) {
        finish(*slot);
      } else if (current == end_of_instance) {
        enter_world(*slot);
        pop(*slot);
      } else {
        visit_instance(*slot, current & reference_index);
      }
    }
  }

  void visit_instance(Slot& slot, std::uint32_t index) {
    const KernelInstance& instance = scene_.instances[index];
    if (!(slot.ray.kinds & instance.visibility)) return pop(slot);
    if (instance.root == no_reference || !enter_instance(slot.space, slot.near, scene_, index, slot.ray))
      return visit_precisely(slot, index);
    // Where nothing else waits in the world, the ray ends with the instance.
    if (!slot.has_only(1)) slot.push(end_of_instance, -1);
    slot.instance = index;
    slot.items[0] = reinterpret_cast<const char*>(instance.nodes);
    slot.items[1] = reinterpret_cast<const char*>(instance.blocks);
    visit_next(slot, instance.root);
  }

  // An instance that the kernel can't walk.
  [[gnu::noinline]] void visit_precisely(Slot& slot, std::uint32_t instance) {
    KernelHit hit = slot.hit;
    const bool is_hit = scene_.intersect_precisely(scene_.owner, instance, slot.ray, hit);
    if (is_hit && is_better(scene_, hit, slot.hit)) {
      slot.hit = hit;
      if (Query::ends_at_hit) return finish(slot);
      forget_farther(slot);
    }
    pop(slot);
  }

  void finish(Slot& slot) {
    query_.finish(scene_, slot);
    start_next(slot);
  }

  const KernelScene& scene_;
  const char* rays_;
  const std::uint32_t* numbers_;
  std::size_t count_, next_ = 0;
  Query query_;
  StreamScratch& scratch_;
  Queues queues_;
};

struct NearestQuery {
  static constexpr bool ends_at_hit = false;
  char* hits;

  static bool take_hit(const KernelScene& scene, Slot& slot, const TriangleBlock& block) {
    return take_nearest_hit(scene, slot, block);
  }
  void finish(const KernelScene& scene, const Slot& slot) const { write(scene, slot.index, slot.hit); }
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

  static bool take_hit(const KernelScene& scene, Slot& slot, const TriangleBlock& block) {
    const TriangleHits hits = intersect_block(block, slot.space, scene, slot.instance, slot.ray, slot.near, slot.hit.t);
    const bool is_hit = hits.is_hit.bits() != 0;
    slot.hit.instance = is_hit ? slot.instance : slot.hit.instance;
    return is_hit;
  }
  void finish(const KernelScene& scene, const Slot& slot) const { write(scene, slot.index, slot.hit); }
  void write(const KernelScene&, std::size_t index, const KernelHit& found) const {
    results[index] = found.instance != ~0u;
  }
};
