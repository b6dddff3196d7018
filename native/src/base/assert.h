// SPDX-License-Identifier: GPL-3.0-or-later
// Assertions: they say that we are wrong, never that the caller's data is (that is SceneError).
#pragma once

#include <cassert>

#define BASICRT_ASSERT(condition) assert(condition)
