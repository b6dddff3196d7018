// SPDX-License-Identifier: GPL-3.0-or-later
// A material's operations as a program: made smaller once, run at every point.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "shading/evaluator.h"
#include "shading/material.h"

namespace basicrt {

// The same material with less to run: what is constant is folded (by running the operation itself), equal operations are
// one, branches of Mix shaders that never show are cut, and what nothing refers to is dropped. Nodes keep their indices.
[[nodiscard]] Material compile(Material material, const Table<Texture>& textures);

// Runs all operations of a material at a point.
class ProgramRun {
 public:
  ProgramRun(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
             const ShadingContext& context);
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;

  static constexpr std::size_t small_size = 96;

  [[nodiscard]] const Evaluator& values() const { return evaluator_; }

 private:
  std::array<Vec3f, small_size> few_;
  std::vector<Vec3f> many_;  // instead, of a long program
  Evaluator evaluator_;
};

// Calls use(Evaluator) with the values of the material's operations there.
template <class Function>
auto with_values(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                 const ShadingContext& context, Function&& use) {
  if (material.operations.empty()) return use(Evaluator({}, textures, context, point, wo));
  const ProgramRun run(material, textures, point, wo, context);
  return use(run.values());
}

// A value of an input as its range allows it; what is not a number is the least of the range, or 0.
[[nodiscard]] float clamp_to_range(float value, const Range& range);

// A shader with constants for all inputs.
template <class Shader>
[[nodiscard]] Shader resolve(const Shader& shader, const Evaluator& in) {
  Shader resolved = shader;
  for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
    if constexpr (IsInput<Value>) {
      const Value& input = shader.*field.member;
      if (!input.is_varying()) return;
      auto value = in(input);
      if constexpr (std::same_as<Value, NumberInput>)
        value = clamp_to_range(value, field.range);
      else if (input.operation.is_valid())  // textures are colours, but may be brighter than white
        for (std::size_t i = 0; i < 3; ++i) value[i] = clamp_to_range(value[i], field.range);
      resolved.*field.member = value;
    }
  });
  return resolved;
}

template <class Shader>
[[nodiscard]] bool is_varying(const Shader& shader) {
  bool varies = false;
  for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
    if constexpr (IsInput<Value>) varies = varies || (shader.*field.member).is_varying();
  });
  return varies;
}

}  // namespace basicrt
