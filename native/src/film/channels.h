// SPDX-License-Identifier: GPL-3.0-or-later
// THE table of passes: a pass is one row here and one assignment in the integrator.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "light/light_group.h"
#include "shading/aov.h"

namespace basicrt {

enum class Pass : std::uint8_t {
  combined,
  depth,
  normal,
  mist,
  position,
  vector,
  uv,
  object_index,
  material_index,
  diffuse_direct,
  diffuse_indirect,
  diffuse_color,
  glossy_direct,
  glossy_indirect,
  glossy_color,
  transmission_direct,
  transmission_indirect,
  transmission_color,
  volume_direct,
  volume_indirect,
  emission,
  environment,
  ambient_occlusion,
  roughness,
  shadow_catcher,
  sample_count,
  denoising_normal,
  denoising_albedo,
  denoising_depth,
  denoising_specular_albedo,
  denoising_roughness,
  // The first of eight each, two ids with their coverages in every one.
  crypto_object,
  crypto_material = crypto_object + 8,
  crypto_asset = crypto_material + 8,
  // The first of those that users number: the light of each group of lights.
  light_group = crypto_asset + 8,
  // The first of those that materials write.
  aov_color = light_group + light_groups,
  aov_value = aov_color + aovs,
};

// How a pixel's value comes from its samples'.
enum class PassRule : std::uint8_t {
  own,    // film.cpp says
  mean,   //
  light,  // the mean of what the integrator filed, divided by the pass `color` where there is one
  first,  // that of the first sample that hits anything
  some,   // the mean of the samples that say something: those record a 1 after their values
  matte,  // ids ranked by coverage
};

struct PassInfo {
  Pass pass;
  std::string_view name;      // Blender's, and that of the EXR layer
  std::string_view channels;  // one letter for each
  float background = 0;       // where no sample hits anything
  PassRule rule = PassRule::mean;
  std::optional<Pass> color = {};
};

// How many numbers a sample has of it.
constexpr int recorded_size(const PassInfo& info) {
  return static_cast<int>(info.channels.size()) + (info.rule == PassRule::some ? 1 : 0);
}

inline constexpr int matte_passes = 8;  // of each kind

// Of the number that a material calls it by, from 1 on.
constexpr Pass aov_color_pass(int number) { return static_cast<Pass>(static_cast<int>(Pass::aov_color) + number - 1); }
constexpr Pass aov_value_pass(int number) { return static_cast<Pass>(static_cast<int>(Pass::aov_value) + number - 1); }

// Of a group's number, from 1 on.
constexpr Pass light_group_pass(int group) {
  return static_cast<Pass>(static_cast<int>(Pass::light_group) + group - 1);
}

namespace detail {
constexpr PassInfo light(Pass pass, std::string_view name, std::optional<Pass> color = {}) {
  return {pass, name, "RGB", 0, PassRule::light, color};
}
// Small letters: as other programs know them, and some compress those without loss.
constexpr PassInfo matte(Pass first, int index, std::string_view name) {
  return {static_cast<Pass>(static_cast<int>(first) + index), name, "rgba", 0, PassRule::matte};
}
// Numbers, not names: whoever names the groups knows which is which.
constexpr PassInfo light_group(int group, std::string_view name) { return {light_group_pass(group), name, "RGB"}; }
constexpr PassInfo aov_color(int number, std::string_view name) { return {aov_color_pass(number), name, "RGBA"}; }
constexpr PassInfo aov_value(int number, std::string_view name) { return {aov_value_pass(number), name, "X"}; }
}  // namespace detail

inline constexpr std::array passes = {
    PassInfo{Pass::combined, "Combined", "RGBA", 0, PassRule::own},
    PassInfo{Pass::depth, "Depth", "Z", 1e10f, PassRule::own},
    PassInfo{Pass::normal, "Normal", "XYZ", 0, PassRule::own},
    PassInfo{Pass::mist, "Mist", "Z", 1, PassRule::own},
    PassInfo{Pass::position, "Position", "XYZ", 0, PassRule::first},
    PassInfo{Pass::vector, "Vector", "XYZW", 0, PassRule::some},
    PassInfo{Pass::uv, "UV", "UVA"},
    PassInfo{Pass::object_index, "Object Index", "X", 0, PassRule::first},
    PassInfo{Pass::material_index, "Material Index", "X", 0, PassRule::first},
    detail::light(Pass::diffuse_direct, "Diffuse Direct", Pass::diffuse_color),
    detail::light(Pass::diffuse_indirect, "Diffuse Indirect", Pass::diffuse_color),
    PassInfo{Pass::diffuse_color, "Diffuse Color", "RGB"},
    detail::light(Pass::glossy_direct, "Glossy Direct", Pass::glossy_color),
    detail::light(Pass::glossy_indirect, "Glossy Indirect", Pass::glossy_color),
    PassInfo{Pass::glossy_color, "Glossy Color", "RGB"},
    detail::light(Pass::transmission_direct, "Transmission Direct", Pass::transmission_color),
    detail::light(Pass::transmission_indirect, "Transmission Indirect", Pass::transmission_color),
    PassInfo{Pass::transmission_color, "Transmission Color", "RGB"},
    detail::light(Pass::volume_direct, "Volume Direct"),
    detail::light(Pass::volume_indirect, "Volume Indirect"),
    detail::light(Pass::emission, "Emission"),
    detail::light(Pass::environment, "Environment"),
    PassInfo{Pass::ambient_occlusion, "Ambient Occlusion", "RGB"},
    PassInfo{Pass::roughness, "Roughness", "X"},
    PassInfo{Pass::shadow_catcher, "Shadow Catcher", "RGB", 1, PassRule::own},
    PassInfo{Pass::sample_count, "Debug Sample Count", "X", 0, PassRule::own},
    PassInfo{Pass::denoising_normal, "Denoising Normal", "XYZ"},
    PassInfo{Pass::denoising_albedo, "Denoising Albedo", "RGB"},
    PassInfo{Pass::denoising_depth, "Denoising Depth", "Z"},
    PassInfo{Pass::denoising_specular_albedo, "Denoising Specular Albedo", "RGB"},
    PassInfo{Pass::denoising_roughness, "Denoising Roughness", "X"},
    detail::matte(Pass::crypto_object, 0, "CryptoObject00"),
    detail::matte(Pass::crypto_object, 1, "CryptoObject01"),
    detail::matte(Pass::crypto_object, 2, "CryptoObject02"),
    detail::matte(Pass::crypto_object, 3, "CryptoObject03"),
    detail::matte(Pass::crypto_object, 4, "CryptoObject04"),
    detail::matte(Pass::crypto_object, 5, "CryptoObject05"),
    detail::matte(Pass::crypto_object, 6, "CryptoObject06"),
    detail::matte(Pass::crypto_object, 7, "CryptoObject07"),
    detail::matte(Pass::crypto_material, 0, "CryptoMaterial00"),
    detail::matte(Pass::crypto_material, 1, "CryptoMaterial01"),
    detail::matte(Pass::crypto_material, 2, "CryptoMaterial02"),
    detail::matte(Pass::crypto_material, 3, "CryptoMaterial03"),
    detail::matte(Pass::crypto_material, 4, "CryptoMaterial04"),
    detail::matte(Pass::crypto_material, 5, "CryptoMaterial05"),
    detail::matte(Pass::crypto_material, 6, "CryptoMaterial06"),
    detail::matte(Pass::crypto_material, 7, "CryptoMaterial07"),
    detail::matte(Pass::crypto_asset, 0, "CryptoAsset00"),
    detail::matte(Pass::crypto_asset, 1, "CryptoAsset01"),
    detail::matte(Pass::crypto_asset, 2, "CryptoAsset02"),
    detail::matte(Pass::crypto_asset, 3, "CryptoAsset03"),
    detail::matte(Pass::crypto_asset, 4, "CryptoAsset04"),
    detail::matte(Pass::crypto_asset, 5, "CryptoAsset05"),
    detail::matte(Pass::crypto_asset, 6, "CryptoAsset06"),
    detail::matte(Pass::crypto_asset, 7, "CryptoAsset07"),
    detail::light_group(1, "Light Group 01"),
    detail::light_group(2, "Light Group 02"),
    detail::light_group(3, "Light Group 03"),
    detail::light_group(4, "Light Group 04"),
    detail::light_group(5, "Light Group 05"),
    detail::light_group(6, "Light Group 06"),
    detail::light_group(7, "Light Group 07"),
    detail::light_group(8, "Light Group 08"),
    detail::light_group(9, "Light Group 09"),
    detail::light_group(10, "Light Group 10"),
    detail::light_group(11, "Light Group 11"),
    detail::light_group(12, "Light Group 12"),
    detail::light_group(13, "Light Group 13"),
    detail::light_group(14, "Light Group 14"),
    detail::light_group(15, "Light Group 15"),
    detail::light_group(16, "Light Group 16"),
    detail::aov_color(1, "AOV Color 01"),
    detail::aov_color(2, "AOV Color 02"),
    detail::aov_color(3, "AOV Color 03"),
    detail::aov_color(4, "AOV Color 04"),
    detail::aov_color(5, "AOV Color 05"),
    detail::aov_color(6, "AOV Color 06"),
    detail::aov_color(7, "AOV Color 07"),
    detail::aov_color(8, "AOV Color 08"),
    detail::aov_color(9, "AOV Color 09"),
    detail::aov_color(10, "AOV Color 10"),
    detail::aov_color(11, "AOV Color 11"),
    detail::aov_color(12, "AOV Color 12"),
    detail::aov_color(13, "AOV Color 13"),
    detail::aov_color(14, "AOV Color 14"),
    detail::aov_color(15, "AOV Color 15"),
    detail::aov_color(16, "AOV Color 16"),
    detail::aov_value(1, "AOV Value 01"),
    detail::aov_value(2, "AOV Value 02"),
    detail::aov_value(3, "AOV Value 03"),
    detail::aov_value(4, "AOV Value 04"),
    detail::aov_value(5, "AOV Value 05"),
    detail::aov_value(6, "AOV Value 06"),
    detail::aov_value(7, "AOV Value 07"),
    detail::aov_value(8, "AOV Value 08"),
    detail::aov_value(9, "AOV Value 09"),
    detail::aov_value(10, "AOV Value 10"),
    detail::aov_value(11, "AOV Value 11"),
    detail::aov_value(12, "AOV Value 12"),
    detail::aov_value(13, "AOV Value 13"),
    detail::aov_value(14, "AOV Value 14"),
    detail::aov_value(15, "AOV Value 15"),
    detail::aov_value(16, "AOV Value 16"),
};
static_assert([] {
  for (std::size_t i = 0; i < passes.size(); ++i)
    if (passes[i].pass != static_cast<Pass>(i)) return false;
  return true;
}());

constexpr const PassInfo& pass_info(Pass pass) { return passes[static_cast<std::size_t>(pass)]; }

// Where each chosen pass lies among a pixel's floats, one after another in the order of the table.
struct PassLayout {
  std::array<bool, passes.size()> chosen = {true};  // by Pass

  [[nodiscard]] static constexpr PassLayout none() { return {.chosen = {}}; }
  [[nodiscard]] constexpr bool is_empty() const { return *this == none(); }
  [[nodiscard]] constexpr bool has(Pass pass) const { return chosen[static_cast<std::size_t>(pass)]; }
  [[nodiscard]] constexpr bool has(PassRule rule) const {
    for (const PassInfo& info : passes)
      if (info.rule == rule && has(info.pass)) return true;
    return false;
  }
  constexpr void enable(Pass pass, bool is_chosen = true) { chosen[static_cast<std::size_t>(pass)] = is_chosen; }
  [[nodiscard]] constexpr int offset(Pass pass) const {
    int offset = 0;
    for (const PassInfo& info : passes) {
      if (info.pass == pass) break;
      if (has(info.pass)) offset += static_cast<int>(info.channels.size());
    }
    return offset;
  }
  [[nodiscard]] constexpr int channel_count() const {
    int count = 0;
    for (const PassInfo& info : passes)
      if (has(info.pass)) count += static_cast<int>(info.channels.size());
    return count;
  }
  constexpr bool operator==(const PassLayout&) const = default;
};

// What the film must be told of each sample beside Combined, Depth and Normal to make the chosen passes.
[[nodiscard]] constexpr PassLayout recorded_passes(PassLayout chosen) {
  PassLayout recorded = PassLayout::none();
  for (const PassInfo& info : passes) {
    if (!chosen.has(info.pass)) continue;
    const bool is_filmed = info.rule != PassRule::own && info.rule != PassRule::matte;
    if (is_filmed || info.pass == Pass::mist) recorded.enable(info.pass);
    if (info.color) recorded.enable(*info.color);
  }
  return recorded;
}

// Where a recorded pass lies among a sample's numbers, and how many those are.
[[nodiscard]] constexpr int recorded_offset(PassLayout recorded, Pass pass) {
  int offset = 0;
  for (const PassInfo& info : passes) {
    if (info.pass == pass) break;
    if (recorded.has(info.pass)) offset += recorded_size(info);
  }
  return offset;
}
[[nodiscard]] constexpr int recorded_count(PassLayout recorded) {
  int count = 0;
  for (const PassInfo& info : passes)
    if (recorded.has(info.pass)) count += recorded_size(info);
  return count;
}

}  // namespace basicrt
