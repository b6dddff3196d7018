// SPDX-License-Identifier: GPL-3.0-or-later
// The hash, and the manifest as JSON.
#include "film/cryptomatte.h"

#include <array>
#include <bit>
#include <cstdio>

namespace basicrt {
namespace {

std::uint32_t scramble(std::uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) {
      result += c;
      continue;
    }
    std::array<char, 8> escape{};
    std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(c));
    result += escape.data();
  }
  return result + "\"";
}

}  // namespace

std::uint32_t murmur_hash(std::string_view bytes) {
  const auto byte_at = [&](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(bytes[i])}; };
  std::uint32_t hash = 0;
  std::size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) {
    const std::uint32_t block = byte_at(i) | byte_at(i + 1) << 8 | byte_at(i + 2) << 16 | byte_at(i + 3) << 24;
    hash = std::rotl(hash ^ scramble(block), 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t rest = 0;
  for (std::size_t j = bytes.size(); j > i; --j) rest = rest << 8 | byte_at(j - 1);
  hash ^= scramble(rest);
  hash ^= static_cast<std::uint32_t>(bytes.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

std::uint32_t matte_id(std::string_view name) {
  const std::uint32_t hash = murmur_hash(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::string matte_id_text(std::uint32_t id) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", id);
  return text.data();
}

std::vector<std::pair<std::string, std::string>> matte_metadata(std::string_view layer,
                                                                const std::set<std::string>& names) {
  std::string manifest = "{";
  for (const std::string& name : names) {
    if (manifest.size() > 1) manifest += ',';
    manifest += quoted(name) + ":\"" + matte_id_text(matte_id(name)) + "\"";
  }
  const std::string key = "cryptomatte/" + matte_id_text(murmur_hash(layer)).substr(0, 7) + "/";
  return {{key + "name", std::string(layer)},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", manifest + "}"}};
}

}  // namespace basicrt
