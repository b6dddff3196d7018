// SPDX-License-Identifier: GPL-3.0-or-later
// A ray made ready for the boxes and triangles of one space: the world, or that of an instance.

// For boxes (see geometry/aabb.h, which says why this loses no hit).
struct BoxSpace {
  float entry_origin[3], exit_origin[3], inverse_direction[3];
  // Where in TreeNode::bounds are the planes that the ray enters through, in floats (those that it leaves through have bit 3 flipped), and
  // where in TreeNode::order is its order.
  struct Octant {
    std::uint8_t entry_planes[3], order_shift;
  } octant;
  float begin;  // of what is of interest; in an instance that of the near range
};

// For the triangles of an instance (see triangle.inl): axes are permuted so that the last is the direction's largest.
struct TriangleSpace {
  float origin[3], shear[3];
  struct Axes {
    std::uint8_t offsets[4];  // where in a corner of a block their coordinates are, in floats; the fourth is unused
  } axes;
  float near_end;  // from BoxSpace::begin to here rounding decides whether a hit counts
  std::uint32_t instance, skipped_primitive;
};

constexpr struct OctantTable {
  BoxSpace::Octant rows[8] = {};

  constexpr OctantTable() {
    for (unsigned octant = 0; octant < 8; ++octant) {
      for (unsigned axis = 0; axis < 3; ++axis)
        rows[octant].entry_planes[axis] = static_cast<std::uint8_t>(16 * axis + 8 * (octant >> axis & 1));
      rows[octant].order_shift = static_cast<std::uint8_t>(3 * octant);
    }
  }
} octant_table;

// Only the first three lanes count. Several spaces get the same: one that has just been written number by number takes its time to be copied.
template <class... Spaces>
void prepare_boxes(Float4 origin, Float4 direction, Spaces&... spaces) {
  const Float4 smallest = Float4::all(__FLT_MIN__), largest = Float4::all(__FLT_MAX__), zero = Float4::all(0);
  const Mask4 is_direction_usable = (smallest <= abs(direction)) | (direction == zero);
  const Mask4 is_usable = is_direction_usable & (abs(direction) <= largest) & (abs(origin) <= largest);
  const Float4 padding = copysign(abs(origin) * Float4::all(0x1p-23f) + smallest, direction);
  const Float4 entry_origin = select(is_usable, origin + padding, largest);
  const Float4 exit_origin = select(is_usable, origin - padding, Float4::all(-__FLT_MAX__));
  const Float4 inverse = select(is_usable, Float4::all(1) / direction, Float4::all(__builtin_inff()));
  const BoxSpace::Octant octant = octant_table.rows[direction.sign_bits() & is_usable.bits() & 7];
  (entry_origin.store3(spaces.entry_origin), ...);
  (exit_origin.store3(spaces.exit_origin), ...);
  (inverse.store3(spaces.inverse_direction), ...);
  ((spaces.octant = octant), ...);
}

// How large directions and origins may be, and how small directions, for single precision to hold what triangles need.
constexpr float largest_usable = 0x1p40f, smallest_usable = 0x1p-40f;

inline bool is_usable_for_triangles(Float4 origin, Float4 direction) {
  const Float4 largest = Float4::all(largest_usable);
  const Mask4 is_small = (abs(origin) <= largest) & (abs(direction) <= largest);
  const Mask4 is_large = Float4::all(smallest_usable) <= abs(direction);
  const unsigned small = is_small.bits() & 7, large = is_large.bits() & 7;
  return (small == 7) & (large != 0);
}

// Axes keep their handedness, so that all triangles of an instance are seen from the same side.
constexpr TriangleSpace::Axes axes_by_last[3] = {{{4, 8, 0, 0}}, {{8, 0, 4, 0}}, {{0, 4, 8, 0}}};

inline void prepare_triangles(TriangleSpace& space, const float* origin, const float* direction) {
  const float x = __builtin_fabsf(direction[0]), y = __builtin_fabsf(direction[1]), z = __builtin_fabsf(direction[2]);
  // In numbers: a branch would be guessed wrong.
  const unsigned is_last_z = (z > x) & (z > y), last = 2 * is_last_z + (1 - is_last_z) * (y > x);
  const TriangleSpace::Axes axes = axes_by_last[last];
  const float scale = 1 / direction[last];
  space.axes = axes;
  for (int i = 0; i < 3; ++i) {
    space.origin[i] = origin[axes.offsets[i] / 4];
    space.shear[i] = i < 2 ? direction[axes.offsets[i] / 4] * scale : scale;
  }
}

// A hit has no negative distance and none that a float can't hold.
inline bool is_traceable(const KernelRay& ray) {
  const Float4 origin = Float4::load(ray.origin), direction = Float4::load(ray.direction);
  const Float4 largest = Float4::all(__FLT_MAX__);
  const unsigned finite = ((abs(origin) <= largest) & (abs(direction) <= largest)).bits() & 7;
  const unsigned zero = (direction == Float4::all(0)).bits() & 7;
  return (finite == 7) & (zero != 7) & (ray.t_min <= ray.t_max) & (ray.t_max >= 0);
}

// Which of the instance's triangles the ray starts on.
inline std::uint32_t skipped_primitive(const KernelScene& scene, std::uint32_t index, const KernelRay& ray) {
  if (ray.from_instance == ~0u) return ~0u;
  if (scene.instances[index].owners == nullptr) return index == ray.from_instance ? ray.from_primitive : ~0u;
  const std::uint32_t first = scene.instances[ray.from_instance].first_merged;
  return first == no_reference ? ~0u : first + ray.from_primitive;
}

// The ray in the space of an instance, rounded. In registers: what is written number by number can't be read four at once for some time.
struct LocalRay {
  Float4 origin, direction;  // the fourth lanes don't count
};

inline LocalRay transform(const KernelScene& scene, const KernelInstance& instance, const KernelRay& ray) {
  if (instance.space == KernelInstance::Space::world) return {Float4::load(ray.origin), Float4::load(ray.direction)};
  const double (*m)[4] = instance.world_to_object;
  double at_ray_time[3][4];
  if (__builtin_expect(instance.space == KernelInstance::Space::moving, 0)) {
    scene.world_to_object_at(instance, ray.time, at_ray_time);
    m = at_ray_time;
  }
  const double ox = ray.origin[0], oy = ray.origin[1], oz = ray.origin[2];
  if (instance.space == KernelInstance::Space::translated)
    return {Float4::of(static_cast<float>(ox + m[0][3]), static_cast<float>(oy + m[1][3]),
                       static_cast<float>(oz + m[2][3])),
            Float4::load(ray.direction)};
  const double dx = ray.direction[0], dy = ray.direction[1], dz = ray.direction[2];
  const auto origin = [&](int i) { return static_cast<float>(m[i][0] * ox + m[i][1] * oy + m[i][2] * oz + m[i][3]); };
  const auto direction = [&](int i) { return static_cast<float>(m[i][0] * dx + m[i][1] * dy + m[i][2] * dz); };
  return {Float4::of(origin(0), origin(1), origin(2)), Float4::of(direction(0), direction(1), direction(2))};
}

// Distances are wrong by a few roundings of the coordinates, more where the ray grazes the triangle. Within this part of the coordinates from t_min
// they are solved in double precision.
constexpr float near_reach = 0x1p-18f;

// Prepares the spaces of an instance. False where its triangles need double precision.
inline bool enter_instance(BoxSpace& boxes, TriangleSpace& triangles, const KernelScene& scene, std::uint32_t index,
                           const KernelRay& ray) {
  const KernelInstance& instance = scene.instances[index];
  const LocalRay local = transform(scene, instance, ray);
  if (!is_usable_for_triangles(local.origin, local.direction)) return false;
  prepare_boxes(local.origin, local.direction, boxes);
  alignas(16) float origin[4], direction[4];
  local.origin.store(origin);
  local.direction.store(direction);
  prepare_triangles(triangles, origin, direction);
  const float distance = __builtin_fabsf(origin[0]) + __builtin_fabsf(origin[1]) + __builtin_fabsf(origin[2]);
  const float margin = (instance.reach + distance) * __builtin_fabsf(triangles.shear[2]) * near_reach;
  const float t_min = ray.t_min < 0 ? 0 : ray.t_min;
  boxes.begin = t_min - margin;
  triangles.near_end = t_min + margin;
  triangles.instance = index;
  triangles.skipped_primitive = skipped_primitive(scene, index, ray);
  return true;
}
