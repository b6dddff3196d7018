// SPDX-License-Identifier: GPL-3.0-or-later
// Compiles and runs a material's operations.
#include "shading/program.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

// The point moved along the surface: what is interpolated over the mesh and over uv changes with the position.
SurfacePoint moved(const SurfacePoint& point, Vec3f step, const ShadingContext& context) {
  SurfacePoint result = point;
  result.position += step;
  if (!context.mesh || !context.placement) return result;
  const Mesh& mesh = *context.mesh;
  const auto corner = [&](int i) {
    return Vec3f(context.placement->object_to_world.point(Vec3d(mesh.position_at(point.primitive, i, point.time))));
  };
  const Vec3f edge1 = corner(1) - corner(0), edge2 = corner(2) - corner(0), normal = cross(edge1, edge2);
  const float scale = 1 / length_squared(normal);
  const float b1 = dot(cross(step, edge2), normal) * scale, b2 = dot(cross(edge1, step), normal) * scale;
  if (!std::isfinite(b1) || !std::isfinite(b2)) return result;
  result.barycentrics = result.barycentrics + Vec2f{b1, b2};
  if (mesh.uvs.empty()) {
    result.uv = result.barycentrics;
    return result;
  }
  const Vec2f* uvs = &mesh.uvs[std::size_t{point.primitive} * 3];
  result.uv = result.uv + (uvs[1] - uvs[0]) * b1 + (uvs[2] - uvs[0]) * b2;
  return result;
}

Vec3f run_one(const Operation& operation, Operations before, const Evaluator& in);

Vec3f run_bump(const BumpOperation& node, Operations before, const Evaluator& in) {
  HeightChange height{.here = in(node.height), .at_dx = 0, .at_dy = 0, .dpdx = {}, .dpdy = {}};
  height.at_dx = height.at_dy = height.here;
  const Vec3f normal = in.point.geometric_normal * (in.point.is_backfacing ? -1.0f : 1.0f);
  const Frame frame = make_frame(normal, cross(Vec3f(1.0f), normal));
  const float step = bump_step(node, in);
  height.dpdx = frame.tangent * step;
  height.dpdy = frame.bitangent * step;
  if (!node.height.is_varying()) return bumped_normal(node, in, height);

  const std::size_t count = node.height.operation.is_valid() ? node.height.operation.index + 1 : 0;
  std::array<Vec3f, small_size> few;
  std::vector<Vec3f> many(count > small_size ? count : 0);
  const std::span<Vec3f> values = many.empty() ? std::span<Vec3f>(few) : std::span<Vec3f>(many);
  const auto height_at = [&](Vec3f change) {
    const SurfacePoint point = moved(in.point, change, in.context);
    const Evaluator there(values, in.textures, in.context, point, in.wo);
    for (const std::uint32_t i : node.steps) values[i] = run_one(before[i], before.first(i), there);
    if (node.steps.empty()) run(before.first(count), values, there);
    return there(node.height);
  };
  height.at_dx = height_at(height.dpdx);
  height.at_dy = height_at(height.dpdy);
  return bumped_normal(node, in, height);
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
