// SPDX-License-Identifier: GPL-3.0-or-later
// Names as the ids of mattes: Friedman and Jones 2015, "Fully automatic ID mattes with support for motion blur and
// transparency", and the Cryptomatte specification 1.2.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace basicrt {

// MurmurHash3_x86_32 by Austin Appleby, seed 0, of the UTF-8 bytes.
[[nodiscard]] std::uint32_t murmur_hash(std::string_view bytes);
// The hash with an exponent that makes its bits an ordinary float.
[[nodiscard]] std::uint32_t matte_id(std::string_view name);
// As the specification writes an id.
[[nodiscard]] std::string matte_id_text(std::uint32_t id);

// Entries of an EXR header that say which names a layer's ids stand for. `layer` is what its channels' names begin with,
// without their numbers: "CryptoObject", or "ViewLayer.CryptoObject".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> matte_metadata(std::string_view layer,
                                                                              const std::set<std::string>& names);

}  // namespace basicrt
