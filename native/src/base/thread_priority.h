// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that work behind an interface let its own go first.
#pragma once

namespace basicrt {

// Of the calling thread, from now on. Where the system refuses, nothing changes.
void lower_thread_priority();

}  // namespace basicrt
