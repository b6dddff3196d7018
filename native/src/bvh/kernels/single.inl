// SPDX-License-Identifier: GPL-3.0-or-later
// Walks one ray through the trees, with ordinary branches: for calls of so few rays that the stream's turns would be mostly empty. Number for number
// as the stream, and in the same order.

template <class Query>
TreeReference visit_node_alone(Slot& slot, const TreeNode& node) {
  Float8 entry, exit;
  intersect_children(node, slot.boxes, slot.t_max, entry, exit);
  const unsigned met = children_within(entry, exit);
  if (met == 0) return slot.pop();
  if ((met & (met - 1)) == 0) return node.children[__builtin_ctz(met)];
  const TreeReference nearest = Query::push_but_nearest(slot, node, entry, exit);
  prefetch_item(slot.items, *(slot.top - 1));
  return nearest;
}

template <class Query>
void walk_alone(const Steps<Query>& steps, std::size_t index, Slot& slot) {
  TreeReference next = steps.start(slot, index);
  while (next != end_of_ray) {
    if (next < moving_triangles_mark) {
      next = visit_node_alone<Query>(slot, slot.node(next));
    } else if (next < triangles_mark) {
      next = steps.test_moving(slot, next);
    } else if (next < instance_mark) {
      const TriangleBlock& block = slot.block(next);
      const TriangleHits hits = intersect_block(steps.scene, slot, block);
      if (hits.is_hit.bits() != 0 && Query::take_hit(steps.scene, slot, block, hits)) {
        if constexpr (Query::ends_at_hit) break;
        forget_farther(slot);
      }
      next = slot.pop();
    } else {
      next = next == end_of_instance ? steps.leave_instance(slot) : steps.enter(slot, next & reference_index);
    }
  }
  steps.query.write(steps.scene, index, slot.hit());
}
