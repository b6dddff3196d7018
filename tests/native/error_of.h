// SPDX-License-Identifier: GPL-3.0-or-later
// What a call complains of.
#pragma once

#include <string>

#include "base/error.h"

namespace basicrt {

// The message of the SceneError that `call` throws; empty: it threw none. Any other exception passes through.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

}  // namespace basicrt
