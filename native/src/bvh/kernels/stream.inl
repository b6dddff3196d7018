// SPDX-License-Identifier: GPL-3.0-or-later
// Walks many rays through the trees at once. A single ray waits for memory at every node and guesses wrong at every branch. Here each of `slot_count`
// rays takes one step in turn: what it needs next is fetched while the others take theirs, and instead of branching a ray joins the queue of what
// it meets next (interleaved like the lookups of Kocberber, Falsafi and Grot 2015, "Asynchronous Memory Access Chaining").

// More would hide no more latency, and what they touch together would not fit in the nearest cache of 32 KB.
constexpr std::uint32_t slot_count = 32;

struct StreamScratch {
  Slot slots[slot_count];
  Stack stacks[slot_count];
};

// Slots that take the same step next.
using Queue = Slot* [slot_count];

// By the two highest bits of what is to be visited: nodes, blocks, and all else, which have the lower of these bits.
struct QueueSizes {
  std::size_t nodes = 0, blocks = 0, others = 0;
};
struct Queues {
  Queue nodes, blocks, others;

  void add(Slot* slot, TreeReference reference, QueueSizes& sizes) {
    const std::uint32_t kind = reference >> 30;
    nodes[sizes.nodes] = slot;
    sizes.nodes += kind == 0;
    blocks[sizes.blocks] = slot;
    sizes.blocks += kind == 2;
    others[sizes.others] = slot;
    sizes.others += kind & 1;
  }
};

// Takes the rays of one call from start to end.
template <class Query>
class Stream {
 public:
  // Of the rays with these numbers.
  Stream(const Steps<Query>& steps, const std::uint32_t* numbers, std::size_t count, StreamScratch& scratch)
      : steps_(steps), numbers_(numbers), count_(count), scratch_(scratch) {}

  void run() {
    for (std::uint32_t i = 0; i < slot_count && next_ < count_; ++i) {
      scratch_.slots[i].stack = &scratch_.stacks[i];
      start_next(scratch_.slots[i]);
    }
    while (sizes_.nodes + sizes_.blocks + sizes_.others != 0) {
      visit_nodes();
      visit_blocks();
      visit_others();
    }
  }

 private:
  // Gives the slot the next ray, or leaves it idle.
  void start_next(Slot& slot) {
    if (next_ < count_) visit_next(slot, steps_.start(slot, numbers_[next_++]), sizes_);
  }

  void visit_next(Slot& slot, TreeReference reference, QueueSizes& sizes) {
    *slot.top = reference;
    prefetch_item(slot.items, reference);
    queues_.add(&slot, reference, sizes);
  }
  // `slots` may be a queue of which sizes_ says that it is empty: what is written there has been read before.
  void pop_all(Slot* const* slots, std::size_t count) {
    QueueSizes sizes = sizes_;  // in registers
    for (std::size_t i = 0; i < count; ++i) visit_next(*slots[i], slots[i]->pop(), sizes);
    sizes_ = sizes;
  }

  [[gnu::noinline]] void visit_nodes() {
    const std::size_t count = sizes_.nodes;
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = *queues_.nodes[i];
      const TreeNode& node = slot.node(slot.current());
      Float8 entry, exit;
      intersect_children(node, slot.boxes, slot.t_max, entry, exit);
      Query::push(slot, node, entry, exit);
    }
    sizes_.nodes = 0;
    pop_all(queues_.nodes, count);
  }

  [[gnu::noinline]] void visit_blocks() {
    const std::size_t count = sizes_.blocks;
    Queue hit, missed;
    std::size_t hit_count = 0, missed_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = *queues_.blocks[i];
      const TriangleBlock& block = slot.block(slot.current());
      const bool is_hit = Query::take_hit(steps_.scene, slot, block, intersect_block(steps_.scene, slot, block));
      hit[hit_count] = missed[missed_count] = &slot;
      hit_count += is_hit;
      missed_count += !is_hit;
    }
    sizes_.blocks = 0;
    if constexpr (Query::ends_at_hit) {
      pop_all(missed, missed_count);
      for (std::size_t i = 0; i < hit_count; ++i) finish(*hit[i]);
    } else {
      for (std::size_t i = 0; i < hit_count; ++i) forget_farther(*hit[i]);
      pop_all(queues_.blocks, count);
    }
  }

  // Instances are entered and left, rays end, triangles that move are tested.
  [[gnu::noinline]] void visit_others() {
    const std::size_t count = sizes_.others;
    sizes_.others = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = *queues_.others[i];
      const TreeReference current = slot.current();
      if (current == end_of_ray)
        finish(slot);
      else if (current == end_of_instance)
        visit_next(slot, steps_.leave_instance(slot), sizes_);
      else if (current >= instance_mark)
        visit_next(slot, steps_.enter(slot, current & reference_index), sizes_);
      else
        visit_next(slot, steps_.test_moving(slot, current), sizes_);
    }
  }

  void finish(Slot& slot) {
    steps_.query.write(steps_.scene, slot.index, slot.hit());
    start_next(slot);
  }

  const Steps<Query>& steps_;
  const std::uint32_t* numbers_;
  std::size_t count_, next_ = 0;
  StreamScratch& scratch_;
  QueueSizes sizes_;
  Queues queues_;
};
