// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the tree from the top, each node by cutting its lights up to seven times, and walks it.
#include "light/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace basicrt {
namespace {

constexpr int bin_count = 12;
// Deeper nodes are cut by number, so that walks have an end.
constexpr int deepest_cut_by_cost = 12;

Float4 four(const std::array<float, LightTree::width>& lanes, int first) { return Float4::load(lanes.data() + first); }

// Cosine of a - b, or 1 where a <= b: of the angle that is left of a.
Float4 cos_of_rest(Float4 cos_a, Float4 sin_a, Float4 cos_b, Float4 sin_b) {
  return select(cos_b <= cos_a, Float4::all(1), cos_a * cos_b + sin_a * sin_b);
}
// A guess at the mean over a group of lights, of the value at its middle and the greatest that there may be.
Float4 between(Float4 middle, Float4 greatest) { return middle + (greatest - middle) * Float4::all(0.25f); }
Float4 sin_of(Float4 cosine) { return sqrt(max(Float4::all(1) - cosine * cosine, Float4::all(0))); }

// What a group of lights costs: how strong it is, how far spread and how variously turned. The last is estimated by the
// mean of the axes, from 1 (all alike) to 4 (a whole sphere against half of one, weighted by the cosine).
struct Group {
  Bounds3f box;
  double intensity = 0;
  Vec3d axes{0.0};
  std::size_t count = 0;

  void add(const LightBounds& light) {
    box.extend(light.box);
    intensity += light.intensity;
    // A two-sided light's axis has no sign: it is turned up.
    const bool is_turned = light.is_two_sided && (light.axis.z < 0 || (light.axis.z == 0 && light.axis.x < 0));
    axes += Vec3d(light.axis) * ((is_turned ? -0.5 : 0.5) * (1 + double(light.cos_normals)));
    ++count;
  }
  void add(const Group& group) {
    box.extend(group.box);
    intensity += group.intensity;
    axes += group.axes;
    count += group.count;
  }
  [[nodiscard]] double cost() const {
    if (count == 0) return 0;
    return intensity * length_squared(Vec3d(box.extent())) * (4 - 3 * length(axes) / double(count));
  }
};

// Puts the items in two groups and says how many are in the first.
template <class Item>
std::size_t cut(std::span<Item> items, bool by_cost) {
  const std::size_t middle = items.size() / 2;
  if (items.size() == 2 || !by_cost) return middle;
  Bounds3f centers;
  for (const Item& item : items) centers.extend(item.bounds.box.center());

  const auto bin_of = [&](const Item& item, int axis) {
    const float lower = centers.lower[axis], extent = centers.upper[axis] - lower;
    const float place = (item.bounds.box.center()[axis] - lower) / extent * bin_count;
    return std::min(static_cast<int>(place), bin_count - 1);
  };
  double least_cost = std::numeric_limits<double>::infinity();
  int best_axis = -1, best_bin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(centers.upper[axis] - centers.lower[axis] > 0)) continue;
    std::array<Group, bin_count> bins;
    for (const Item& item : items) bins[bin_of(item, axis)].add(item.bounds);
    std::array<double, bin_count> cost_from{};
    Group after;
    for (int i = bin_count - 1; i > 0; --i) {
      after.add(bins[i]);
      cost_from[i] = after.cost();
    }
    Group before;
    for (int i = 0; i + 1 < bin_count; ++i) {
      before.add(bins[i]);
      if (before.count == 0 || before.count == items.size()) continue;
      const double cost = before.cost() + cost_from[i + 1];
      if (cost < least_cost) least_cost = cost, best_axis = axis, best_bin = i;
    }
  }
  if (best_axis < 0) return middle;  // all at one place
  const auto second =
      std::partition(items.begin(), items.end(), [&](const Item& item) { return bin_of(item, best_axis) <= best_bin; });
  return static_cast<std::size_t>(second - items.begin());
}

}  // namespace

LightTree::LightTree(std::vector<LightBounds> lights) : places_(lights.size()) {
  std::vector<Item> items;
  items.reserve(lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) items.push_back({lights[i], i});
  std::vector<LightBounds>().swap(lights);
  if (!items.empty()) build_node(items, 0, 0);
}

std::uint32_t LightTree::build_node(std::span<Item> items, std::uint32_t place, int depth) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_[index].place = place;

  // Cut the part that costs most until there are eight parts or no more to cut.
  const bool by_cost = depth <= deepest_cut_by_cost;
  struct Part {
    std::span<Item> items;
    double cost;
  };
  const auto make_part = [&](std::span<Item> part) -> Part {
    if (part.size() == 1) return {part, -1};
    if (!by_cost) return {part, double(part.size())};
    Group group;
    for (const Item& item : part) group.add(item.bounds);
    return {part, group.cost()};
  };
  std::vector<Part> parts = {make_part(items)};
  while (parts.size() < width) {
    const auto worst =
        std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.cost < b.cost; });
    if (worst->items.size() == 1) break;
    const std::span<Item> whole = worst->items;
    const std::size_t middle = cut(whole, by_cost);
    *worst = make_part(whole.first(middle));
    parts.insert(worst + 1, make_part(whole.subspan(middle)));
  }

  nodes_[index].count = static_cast<std::uint8_t>(parts.size());
  std::vector<LightBounds> bounds;
  for (int lane = 0; lane < int(parts.size()); ++lane) {
    const std::span<Item> part = parts[lane].items;
    bounds.clear();
    for (const Item& item : part) bounds.push_back(item.bounds);
    set_child(index, lane, merge(bounds));
    const std::uint32_t child_place = index * width + lane;
    std::uint32_t child = part.front().light;
    if (part.size() == 1) {
      nodes_[index].leaves |= static_cast<std::uint8_t>(1u << lane);
      places_[child] = child_place;
    } else {
      child = build_node(part, child_place, depth + 1);
    }
    nodes_[index].child[lane] = child;
  }
  return index;
}

void LightTree::set_child(std::uint32_t index, int lane, const LightBounds& bounds) {
  Node& node = nodes_[index];
  const Vec3f center = bounds.box.center(), half = bounds.box.extent() * 0.5f;
  node.center_x[lane] = center.x, node.center_y[lane] = center.y, node.center_z[lane] = center.z;
  // A bit more for the rounding of the centre.
  const float slack = 3e-7f * max_component(abs(center));
  node.radius[lane] = length(half) * (1 + 1e-5f) + slack;
  node.half_x[lane] = half.x + slack, node.half_y[lane] = half.y + slack, node.half_z[lane] = half.z + slack;
  node.lowest[lane] = bounds.is_two_sided ? -std::numeric_limits<float>::infinity() : bounds.lowest;
  node.axis_x[lane] = bounds.axis.x, node.axis_y[lane] = bounds.axis.y, node.axis_z[lane] = bounds.axis.z;
  node.cos_normals[lane] = bounds.cos_normals;
  node.sin_normals[lane] = std::sqrt(std::max(0.0f, 1 - bounds.cos_normals * bounds.cos_normals));
  node.cos_emission[lane] = bounds.cos_emission;
  node.is_two_sided[lane] = bounds.is_two_sided ? 1 : 0;
  node.intensity[lane] = bounds.intensity;
  if (bounds.is_solid) node.solid |= static_cast<std::uint8_t>(1u << lane);
}

// Intensity over squared distance, times the greatest cosines that the ball and the cone allow at both ends.
LightTree::Weights LightTree::weigh(const Node& node, const LitPoint& point) {
  const Float4 zero = Float4::all(0), one = Float4::all(1);
  const Float4 px = Float4::all(point.position.x), py = Float4::all(point.position.y),
               pz = Float4::all(point.position.z);
  const Float4 nx = Float4::all(point.normal.x), ny = Float4::all(point.normal.y), nz = Float4::all(point.normal.z);
  const bool has_normal = point.has_normal();
  const Float4 magnitude = Float4::all(max_component(abs(point.position)));
  const Float4 slack = Float4::all(-cosine_slack), least = Float4::all(least_cosine);

  Weights weights{};
  for (int i = 0; i < node.count; i += 4) {
    const Float4 x = four(node.center_x, i) - px, y = four(node.center_y, i) - py, z = four(node.center_z, i) - pz;
    const Float4 radius = four(node.radius, i), radius_squared = radius * radius;
    const Float4 distance_squared = x * x + y * y + z * z;
    const Float4 inverse = one / sqrt(max(distance_squared, Float4::all(1e-37f)));
    // The cone in which the ball is seen; from within, everything.
    const Mask4 is_inside = distance_squared <= radius_squared;
    const Float4 sin_seen = select(is_inside, zero, radius * inverse);
    const Float4 cos_seen = select(is_inside, Float4::all(-1), sin_of(sin_seen));

    // At the light: the angle to the axis, less the normals' cone, less the ball.
    Float4 cosine = (four(node.axis_x, i) * x + four(node.axis_y, i) * y + four(node.axis_z, i) * z) * inverse;
    cosine = select(zero < four(node.is_two_sided, i), abs(cosine), zero - cosine);
    const Float4 from_normals =
        cos_of_rest(cosine, sin_of(cosine), four(node.cos_normals, i), four(node.sin_normals, i));
    const Float4 emitted = cos_of_rest(from_normals, sin_of(from_normals), cos_seen, sin_seen);
    Float4 weight = select(emitted < four(node.cos_emission, i) + slack, zero,
                           max(between(max(from_normals, zero), emitted), least));
    // Behind a flat light nothing arrives, however near.
    const Float4 height = four(node.axis_x, i) * px + four(node.axis_y, i) * py + four(node.axis_z, i) * pz;
    weight = select(height < four(node.lowest, i) - magnitude * Float4::all(1e-6f), zero, weight);

    if (has_normal) {
      const Float4 incident = (nx * x + ny * y + nz * z) * inverse;
      const Float4 greatest = cos_of_rest(incident, sin_of(incident), cos_seen, sin_seen);
      const Float4 above = nx * x + ny * y + nz * z + abs(nx) * four(node.half_x, i) + abs(ny) * four(node.half_y, i) +
                           abs(nz) * four(node.half_z, i);
      const Mask4 is_below = (above * inverse < slack) | (greatest < slack);
      weight = weight * select(is_below, zero, max(between(max(incident, zero), greatest), least));
    }
    // Near a group, lights are spread all around: no nearer than half its radius on average.
    const Float4 divisor = max(max(distance_squared, radius_squared * Float4::all(0.25f)), Float4::all(1e-30f));
    weight = min(weight * four(node.intensity, i) / divisor, Float4::all(1e36f));
    weight.store(weights.of_child.data() + i);
  }
  for (const float weight : weights.of_child) weights.total += weight;
  if (weights.total > 0) return weights;

  weights.is_guess = true;
  float greatest = 0;
  for (const float intensity : node.intensity) greatest = std::max(greatest, intensity);
  for (int i = 0; i < node.count; ++i) weights.total += weights.of_child[i] = node.intensity[i] / greatest;
  return weights;
}

LightTree::Choice LightTree::choose(const LitPoint& point, float u, const Weights& at_root) const {
  const Node* node = &nodes_.front();
  Weights weights = at_root;
  float probability = 1;
  while (true) {
    // The last child with any weight takes what rounding leaves over.
    float rest = u * weights.total;
    int picked = -1;
    for (int i = 0; i < node->count; ++i) {
      const float weight = weights.of_child[i];
      if (!(weight > 0)) continue;
      if (picked >= 0) rest -= weights.of_child[picked];
      picked = i;
      if (rest < weight) break;
    }
    const float weight = weights.of_child[picked];
    probability *= weight / weights.total;
    u = std::clamp(rest / weight, 0.0f, one_minus_epsilon);
    const std::uint32_t child = node->child[picked];
    if ((node->leaves >> picked & 1) != 0) return {child, probability};
    node = &nodes_[child];
    weights = weigh(*node, point);
  }
}

float LightTree::probability(std::uint32_t light, const LitPoint& point) const {
  float probability = 1;
  std::uint32_t place = places_[light];
  while (true) {
    const Node& node = nodes_[place / width];
    const Weights weights = weigh(node, point);
    probability *= weights.of_child[place % width] / weights.total;
    if (place < width) return probability;
    place = node.place;
  }
}

// Of the children with solid lights, those whose ball the ray meets.
unsigned LightTree::solid_children_near(const Node& node, const Ray& ray) {
  const Float4 dx = Float4::all(ray.direction.x), dy = Float4::all(ray.direction.y), dz = Float4::all(ray.direction.z);
  const float squared = length_squared(ray.direction);
  const Float4 t_min = Float4::all(ray.t_min * squared), t_max = Float4::all(ray.t_max * squared);
  const Float4 length_of_direction = Float4::all(std::sqrt(squared));
  unsigned near = 0;
  for (int i = 0; i < node.count; i += 4) {
    const Float4 x = four(node.center_x, i) - Float4::all(ray.origin.x),
                 y = four(node.center_y, i) - Float4::all(ray.origin.y),
                 z = four(node.center_z, i) - Float4::all(ray.origin.z);
    // A bit more for the rounding of what follows.
    const Float4 radius =
        (four(node.radius, i) * Float4::all(1.0001f) + (abs(x) + abs(y) + abs(z)) * Float4::all(1e-6f)) *
        length_of_direction;
    const Float4 along = x * dx + y * dy + z * dz;
    const Float4 cx = y * dz - z * dy, cy = z * dx - x * dz, cz = x * dy - y * dx;
    const Mask4 is_near =
        (cx * cx + cy * cy + cz * cz <= radius * radius) & (t_min <= along + radius) & (along - radius <= t_max);
    near |= static_cast<unsigned>(is_near.bits()) << i;
  }
  return near & node.solid;
}

}  // namespace basicrt
