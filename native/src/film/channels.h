// SPDX-License-Identifier: GPL-3.0-or-later
// THE table of passes: a pass is one row here and one assignment in the integrator.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace basicrt {

enum class Pass : std::uint8_t { combined, depth, normal };

struct PassInfo {
  Pass pass;
  std::string_view name;      // Blender's, and that of the EXR layer
  std::string_view channels;  // one letter for each
  float background;           // where no sample hits anything
};

inline constexpr std::array passes = {
    PassInfo{Pass::combined, "Combined", "RGBA", 0},
    PassInfo{Pass::depth, "Depth", "Z", 1e10f},
    PassInfo{Pass::normal, "Normal", "XYZ", 0},
};
static_assert([] {
  for (std::size_t i = 0; i < passes.size(); ++i)
    if (passes[i].pass != static_cast<Pass>(i)) return false;
  return true;
}());

constexpr const PassInfo& pass_info(Pass pass) { return passes[static_cast<std::size_t>(pass)]; }

// Where each chosen pass lies among a pixel's floats, one after another in the order of the table.
struct PassLayout {
  std::uint32_t mask = 1u << static_cast<unsigned>(Pass::combined);

  [[nodiscard]] constexpr bool has(Pass pass) const { return (mask >> static_cast<unsigned>(pass)) & 1u; }
  constexpr void enable(Pass pass) { mask |= 1u << static_cast<unsigned>(pass); }
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

}  // namespace basicrt
