// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses a kernel for this machine.
#include "bvh/kernels/chosen_kernel.h"

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace basicrt {

namespace scalar {
extern const Kernel kernel;
}
#if defined(__x86_64__)
namespace sse42 {
extern const Kernel kernel;
}
namespace avx2 {
extern const Kernel kernel;
}
namespace avx512 {
extern const Kernel kernel;
}
#endif

namespace {

struct Choice {
  const Kernel& kernel;
  bool is_supported;
};

// The best first.
auto choices() {
#if defined(__x86_64__)
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
  const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  return std::array{Choice{avx512::kernel, has_avx512}, Choice{avx2::kernel, has_avx2},
                    Choice{sse42::kernel, __builtin_cpu_supports("sse4.2") != 0}, Choice{scalar::kernel, true}};
#else
  return std::array{Choice{scalar::kernel, true}};
#endif
}

const Kernel& choose() {
  const char* name = std::getenv("BASICRT_ISA");
  if (name == nullptr || *name == '\0') return *find_kernel("");
  if (const Kernel* kernel = find_kernel(name)) return *kernel;
  std::string message = std::string("BASICRT_ISA: '") + name + "' is not available here; it must be one of";
  for (const Choice& choice : choices())
    if (choice.is_supported) message += std::string(" ") + choice.kernel.name;
  throw std::runtime_error(message);
}

}  // namespace

const Kernel* find_kernel(std::string_view name) {
  for (const Choice& choice : choices())
    if (choice.is_supported && (name.empty() || name == choice.kernel.name)) return &choice.kernel;
  return nullptr;
}

const Kernel& chosen_kernel() {
  static const Kernel& kernel = choose();
  return kernel;
}

}  // namespace basicrt
