// SPDX-License-Identifier: GPL-3.0-or-later
// Compiles and runs a material's operations.
#include "shading/program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "math/frame.h"

namespace basicrt {
namespace {

using Operations = std::span<const Operation>;

// Of a program whose operations are all constant.
const SurfacePoint& no_point() {
  static const SurfacePoint point;
  return point;
}
const ShadingContext& no_context() {
  static const ShadingContext context;
  return context;
}

template <class Described, class Visitor>
void for_each_input(Described& object, Visitor&& visit) {
  using Plain = std::remove_const_t<Described>;
  for_each_field<Plain>([&]<class Value>(const Field<Plain, Value>& field) {
    if constexpr (IsInput<Value>) visit(object.*field.member, field.range);
  });
}

template <class Kind>
constexpr bool reads_point = requires { Kind::reads_point; };

void run(Operations operations, std::span<Vec3f> values, const Evaluator& in);

// Room for the values of most programs, so that nothing is allocated.
constexpr std::size_t small_size = ProgramRun::small_size;

// How far apart a bump looks at the height. Not so near that rounded positions would show.
float bump_step(const BumpOperation& node, const Evaluator& in) {
  constexpr float share_of_ray = 5e-4f;  // where nothing is known of pixels
  const float footprint = in.context.footprint > 0 ? in.context.footprint : in.point.t * share_of_ray;
  return std::max({footprint * node.filter_width, max_component(abs(in.point.position)) * 0x1p-17f, 1e-7f});
}

// A triangle in world space: where it is, or where it was before it was displaced.
class Facet {
 public:
  Facet(const SurfacePoint& point, const Mesh& mesh, const Placement& placement, bool is_undisplaced) {
    for (int i = 0; i < 3; ++i) {
      const Vec3f corner = is_undisplaced ? mesh.rest_positions[mesh.triangles[point.primitive][i]]
                                          : mesh.position_at(point.primitive, i, point.time);
      corners_[i] = Vec3f(placement.object_to_world.point(Vec3d(corner)));
    }
  }

  [[nodiscard]] Vec3f at(Vec2f shares) const { return corners_[0] + along(shares); }
  [[nodiscard]] Vec3f along(Vec2f shares) const { return edge(1) * shares.x + edge(2) * shares.y; }
  // By how much barycentrics change along a step within the triangle's plane; zero on a triangle that is none.
  [[nodiscard]] Vec2f shares_of(Vec3f step) const {
    const Vec3f normal = cross(edge(1), edge(2));
    const float scale = 1 / length_squared(normal);
    const Vec2f shares{dot(cross(step, edge(2)), normal) * scale, dot(cross(edge(1), step), normal) * scale};
    return std::isfinite(shares.x) && std::isfinite(shares.y) ? shares : Vec2f{0, 0};
  }

 private:
  [[nodiscard]] Vec3f edge(std::size_t i) const { return corners_[i] - corners_[0]; }

  std::array<Vec3f, 3> corners_;
};

// None but on a mesh.
std::optional<Facet> facet_of(const Evaluator& in, bool is_undisplaced) {
  const Mesh* mesh = in.context.mesh;
  if (!mesh || !in.context.placement || (is_undisplaced && mesh->rest_positions.empty())) return std::nullopt;
  return Facet(in.point, *mesh, *in.context.placement, is_undisplaced);
}

// To a point beside another one on the surface.
struct Step {
  Vec3f change;  // of position
  Vec2f shares;  // change of barycentrics, on a mesh
};

// What is interpolated over the mesh and over uv changes with the barycentrics.
SurfacePoint moved(const SurfacePoint& point, const Step& step, const Mesh* mesh) {
  SurfacePoint result = point;
  result.position += step.change;
  if (!mesh) return result;
  result.barycentrics = result.barycentrics + step.shares;
  if (mesh->uvs.empty()) {
    result.uv = result.barycentrics;
    return result;
  }
  const Vec2f* uvs = &mesh->uvs[std::size_t{point.primitive} * 3];
  result.uv = result.uv + (uvs[1] - uvs[0]) * step.shares.x + (uvs[2] - uvs[0]) * step.shares.y;
  return result;
}

// Where a bump looks at the height: on the surface, or where it was before it was displaced.
struct BumpPlace {
  SurfacePoint point;
  Step x, y;
  Vec3f dpdx, dpdy;
};

BumpPlace bump_place(const BumpOperation& node, const Evaluator& in) {
  const Vec3f normal = in.point.geometric_normal * (in.point.is_backfacing ? -1.0f : 1.0f);
  const Frame frame = make_frame(normal, cross(Vec3f(1.0f), normal));
  const float size = bump_step(node, in);
  BumpPlace place{in.point, {frame.tangent * size, {0, 0}}, {frame.bitangent * size, {0, 0}}, {}, {}};
  place.dpdx = place.x.change;
  place.dpdy = place.y.change;
  if (const std::optional<Facet> facet = facet_of(in, false))
    for (Step* step : {&place.x, &place.y}) step->shares = facet->shares_of(step->change);
  const std::optional<Facet> before = node.is_undisplaced ? facet_of(in, true) : std::nullopt;
  if (!before) return place;
  place.point.position = before->at(in.point.barycentrics);
  place.point.shading_normal = undisplaced_normal(in);
  place.dpdx = before->along(place.x.shares);
  place.dpdy = before->along(place.y.shares);
  // Positions change in the directions that the surface has now: as Cycles has it, which keeps but a length of its own.
  const float mean = 0.5f * (length(place.dpdx) + length(place.dpdy));
  place.x.change = frame.tangent * mean;
  place.y.change = frame.bitangent * mean;
  return place;
}

Vec3f run_one(const Operation& operation, Operations before, const Evaluator& in);

Vec3f run_bump(const BumpOperation& node, Operations before, const Evaluator& in) {
  const BumpPlace place = bump_place(node, in);
  const Evaluator here = in.at(place.point);
  HeightChange height{.dpdx = place.dpdx, .dpdy = place.dpdy};
  height.here = height.at_dx = height.at_dy = in(node.height);
  if (!node.height.is_varying()) return bumped_normal(node, here, height);

  const std::size_t count = node.height.operation.is_valid() ? node.height.operation.index + 1 : 0;
  std::array<Vec3f, small_size> few;
  std::vector<Vec3f> many(count > small_size ? count : 0);
  const std::span<Vec3f> values = many.empty() ? std::span<Vec3f>(few) : std::span<Vec3f>(many);
  const auto height_at = [&](const Step& step) {
    const SurfacePoint point = moved(place.point, step, in.context.mesh);
    const Evaluator there(values, in.textures, in.context, point, in.wo);
    for (const std::uint32_t i : node.steps) values[i] = run_one(before[i], before.first(i), there);
    if (node.steps.empty()) run(before.first(count), values, there);
    return there(node.height);
  };
  if (node.is_undisplaced) height.here = height_at({});
  height.at_dx = height_at(place.x);
  height.at_dy = height_at(place.y);
  return bumped_normal(node, here, height);
}

Vec3f run_one(const Operation& operation, Operations before, const Evaluator& in) {
  return std::visit(
      [&]<class Kind>(const Kind& node) {
        if constexpr (std::same_as<Kind, BumpOperation>)
          return run_bump(node, before, in);
        else
          return eval(node, in);
      },
      operation);
}

void run(Operations operations, std::span<Vec3f> values, const Evaluator& in) {
  for (std::size_t i = 0; i < operations.size(); ++i) values[i] = run_one(operations[i], operations.first(i), in);
}

// Makes one material smaller.
class Compiler {
 public:
  Compiler(Material& material, const Table<Texture>& textures) : material_(material), textures_(textures) {}

  void compile() {
    fold_operations();
    for (ShaderNode& node : material_.nodes)
      std::visit(
          [&](auto& shader) {
            for_each_input(shader, [&](auto& input, const Range& range) { fold_input(input, &range); });
          },
          node);
    std::vector<bool> is_node_live(material_.nodes.size());
    mark_node(material_.surface, is_node_live);
    mark_node(material_.volume, is_node_live);
    drop_dead_operations(is_node_live);
    find_steps();
  }

 private:
  // Where an operation went: to a new index, or to a constant.
  struct Place {
    OperationIndex index;
    Vec3f constant;
  };

  // Constants in place of operations and textures that are constant.
  template <class Input>
  void fold_input(Input& input, const Range* range) const {
    const auto set = [&](auto value) {
      input = Input();
      if constexpr (std::same_as<Input, NumberInput>) {
        input.constant = range ? clamp_to_range(value, *range) : value;
      } else {
        for (std::size_t i = 0; range && i < 3; ++i) value[i] = clamp_to_range(value[i], *range);
        input.constant = value;
      }
    };
    if (input.operation.is_valid()) {
      const Place& place = places_[input.operation.index];
      if (place.index.is_valid())
        input.operation = place.index;
      else if constexpr (std::same_as<Input, NumberInput>)
        set(place.constant.x);
      else
        set(place.constant);
    } else if (input.texture.is_valid() && std::holds_alternative<ConstantTexture>(textures_[input.texture])) {
      const Evaluator in({}, textures_, no_context(), no_point(), {});
      const auto value = in(input);
      if constexpr (std::same_as<Input, NumberInput>) {
        set(value);
      } else {
        input = Input(value);  // which may be brighter than white
      }
    }
  }

  void fold_operations() {
    std::vector<Operation> kept;
    for (Operation& operation : material_.operations) {
      std::visit(
          [&](auto& node) { for_each_input(node, [&](auto& input, const Range&) { fold_input(input, nullptr); }); },
          operation);
      if (is_constant(operation)) {
        const Evaluator in({}, textures_, no_context(), no_point(), {});
        places_.push_back({{}, run_one(operation, {}, in)});
        continue;
      }
      const auto same = std::ranges::find(kept, operation);
      places_.push_back({{static_cast<std::uint32_t>(same - kept.begin())}, {}});
      if (same == kept.end()) kept.push_back(std::move(operation));
    }
    material_.operations = std::move(kept);
  }

  static bool is_constant(const Operation& operation) {
    return std::visit([]<class Kind>(const Kind& node) { return !reads_point<Kind> && !is_varying(node); }, operation);
  }

  // What a Mix with a constant factor of 0 or 1 leaves out is not reached.
  void mark_node(NodeIndex index, std::vector<bool>& is_live) {
    if (index == no_node || is_live[index]) return;
    is_live[index] = true;
    if (auto* mix = std::get_if<MixShader>(&material_.nodes[index])) {
      const bool is_fixed = !mix->factor.is_varying();
      if (is_fixed && mix->factor.constant >= 1) mix->first = no_node;
      if (is_fixed && mix->factor.constant <= 0) mix->second = no_node;
      mark_node(mix->first, is_live);
      mark_node(mix->second, is_live);
    } else if (const auto* sum = std::get_if<AddShader>(&material_.nodes[index])) {
      mark_node(sum->first, is_live);
      mark_node(sum->second, is_live);
    }
  }

  void drop_dead_operations(const std::vector<bool>& is_node_live) {
    std::vector<bool> is_live(material_.operations.size());
    const auto mark = [&](const auto& input, const Range&) {
      if (input.operation.is_valid()) is_live[input.operation.index] = true;
    };
    for (std::size_t i = 0; i < material_.nodes.size(); ++i)
      if (is_node_live[i]) std::visit([&](const auto& shader) { for_each_input(shader, mark); }, material_.nodes[i]);
    for (std::size_t i = is_live.size(); i-- > 0;)
      if (is_live[i]) std::visit([&](const auto& node) { for_each_input(node, mark); }, material_.operations[i]);

    std::vector<Operation> kept;
    std::vector<std::uint32_t> places(is_live.size(), OperationIndex::none);
    const auto move = [&](auto& input, const Range&) {
      if (input.operation.is_valid()) input.operation.index = places[input.operation.index];
    };
    for (std::size_t i = 0; i < is_live.size(); ++i) {
      if (!is_live[i]) continue;
      places[i] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(std::move(material_.operations[i]));
      std::visit([&](auto& node) { for_each_input(node, move); }, kept.back());
    }
    for (std::size_t i = 0; i < material_.nodes.size(); ++i)
      std::visit([&](auto& shader) { for_each_input(shader, move); }, material_.nodes[i]);
    material_.operations = std::move(kept);
  }

  void find_steps() {
    for (Operation& operation : material_.operations) {
      auto* bump = std::get_if<BumpOperation>(&operation);
      if (!bump || !bump->height.operation.is_valid()) continue;
      std::vector<bool> is_needed(bump->height.operation.index + 1);
      is_needed.back() = true;
      for (std::size_t i = is_needed.size(); i-- > 0;) {
        const auto mark = [&](const auto& input, const Range&) {
          if (input.operation.is_valid()) is_needed[input.operation.index] = true;
        };
        if (is_needed[i]) std::visit([&](const auto& node) { for_each_input(node, mark); }, material_.operations[i]);
      }
      bump->steps.clear();
      for (std::uint32_t i = 0; i < is_needed.size(); ++i)
        if (is_needed[i]) bump->steps.push_back(i);
    }
  }

  Material& material_;
  const Table<Texture>& textures_;
  std::vector<Place> places_;  // of each of the operations that there were
};

}  // namespace

Material compile(Material material, const Table<Texture>& textures) {
  Compiler(material, textures).compile();
  return material;
}

ProgramRun::ProgramRun(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                       const ShadingContext& context)
    : many_(material.operations.size() > small_size ? material.operations.size() : 0),
      evaluator_(many_.empty() ? std::span<const Vec3f>(few_) : std::span<const Vec3f>(many_), textures, context, point,
                 wo) {
  run(material.operations, many_.empty() ? std::span<Vec3f>(few_) : std::span<Vec3f>(many_), evaluator_);
}

float clamp_to_range(float value, const Range& range) {
  constexpr double most = std::numeric_limits<float>::max();
  constexpr double least_above = 1e-5;  // a bound that is excluded
  if (!std::isfinite(value)) value = 0;
  const double minimum = range.minimum + (range.is_minimum_excluded ? least_above : 0);
  return static_cast<float>(std::clamp(double{value}, std::max(minimum, -most), std::min(range.maximum, most)));
}

}  // namespace basicrt
