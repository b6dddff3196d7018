// SPDX-License-Identifier: GPL-3.0-or-later
// Eight floats as twice four, and what is done with a node's children one by one.

// What packets have in each lane a ray of.
using Pack = Float4;

struct Float8 {
  Float4 halves[2];

  static Float8 load(const float* aligned) { return {{Float4::load(aligned), Float4::load(aligned + 4)}}; }
  static Float8 all(float x) { return {{Float4::all(x), Float4::all(x)}}; }
  friend Float8 operator-(Float8 a, Float8 b) { return {{a.halves[0] - b.halves[0], a.halves[1] - b.halves[1]}}; }
  friend Float8 operator*(Float8 a, Float8 b) { return {{a.halves[0] * b.halves[0], a.halves[1] * b.halves[1]}}; }
  friend Float8 min(Float8 a, Float8 b) { return {{min(a.halves[0], b.halves[0]), min(a.halves[1], b.halves[1])}}; }
  friend Float8 max(Float8 a, Float8 b) { return {{max(a.halves[0], b.halves[0]), max(a.halves[1], b.halves[1])}}; }
};

inline unsigned children_within(const Float8& entry, const Float8& exit) {
  return (entry.halves[0] <= exit.halves[0]).bits() | (entry.halves[1] <= exit.halves[1]).bits() << 4;
}

// The numbers of the children that are met, farthest first, of which only the lowest three bits count.
inline std::uint32_t list_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                   const Float8& exit, std::uint32_t (&numbers)[8]) {
  const unsigned hits = children_within(entry, exit);
  std::uint32_t count = 0;
  for (const std::uint32_t order : node.order) {
    numbers[count] = order >> octant_shift;
    count += hits >> (numbers[count] & 7) & 1;
  }
  return count;
}

// How many children were pushed, and where the nearest is in the node's order.
struct PushedChildren {
  std::uint32_t count, nearest;
};

inline PushedChildren push_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                    const Float8& exit, TreeReference* references, float* entries) {
  const unsigned hits = children_within(entry, exit);
  alignas(16) float distances[8];
  entry.halves[0].store(distances);
  entry.halves[1].store(distances + 4);
  PushedChildren pushed{0, 0};
  for (std::uint32_t place = 0; place < 8; ++place) {
    const std::uint32_t child = node.order[place] >> octant_shift & 7;
    const bool is_met = (hits >> child & 1) != 0;
    references[pushed.count] = node.children[child];
    entries[pushed.count] = distances[child];
    pushed.count += is_met;
    pushed.nearest = is_met ? place : pushed.nearest;
  }
  return pushed;
}

inline std::uint32_t push_any_children(const TreeNode& node, const Float8& entry, const Float8& exit,
                                       TreeReference* references) {
  const unsigned hits = children_within(entry, exit);
  std::uint32_t count = 0;
  for (unsigned child = 0; child < 8; ++child) {
    references[count] = node.children[child];
    count += hits >> child & 1;
  }
  return count;
}

inline std::uint32_t keep_within(TreeReference* references, float* entries, std::uint32_t count, float t_max) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    references[kept] = references[i];
    entries[kept] = entries[i];
    kept += entries[i] <= t_max;
  }
  return kept;
}
