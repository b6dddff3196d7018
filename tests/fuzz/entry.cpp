// SPDX-License-Identifier: GPL-3.0-or-later
// What libFuzzer calls. BASICRT_FUZZ_TARGET is the function in basicrt::fuzz that looks for faults.
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "fuzz/trees.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string fault = basicrt::fuzz::BASICRT_FUZZ_TARGET(std::span(data, size));
  if (fault.empty()) return 0;
  std::fprintf(stderr, "fault: %s\n", fault.c_str());
  std::abort();
}
