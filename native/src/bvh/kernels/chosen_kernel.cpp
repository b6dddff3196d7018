// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses a kernel for this machine.
#include "bvh/kernels/chosen_kernel.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"
#include "geometry/kernels/chosen_point_kernel.h"

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

// `item` is who asks for it.
const Kernel& need_kernel(std::string_view name, std::string_view item) {
  if (const Kernel* kernel = find_kernel(name)) return *kernel;
  std::string problem("'");
  problem.append(name).append("' is not available here; it must be one of");
  for (const std::string_view known : kernel_names()) problem.append(" ").append(known);
  throw SceneError(item, problem);
}

const Kernel& choose() {
  const char* name = std::getenv("BASICRT_ISA");
  return need_kernel(name == nullptr ? "" : name, "BASICRT_ISA");
}

// None: nobody has asked yet.
std::atomic<const Kernel*>& chosen() {
  static std::atomic<const Kernel*> kernel = nullptr;
  return kernel;
}

}  // namespace

const Kernel* find_kernel(std::string_view name) {
  for (const Choice& choice : choices())
    if (choice.is_supported && (name.empty() || name == choice.kernel.name)) return &choice.kernel;
  return nullptr;
}

const Kernel& chosen_kernel() {
  const Kernel* kernel = chosen().load(std::memory_order_acquire);
  if (kernel == nullptr) {
    // Who chooses meanwhile counts.
    const Kernel* first = &choose();
    kernel = chosen().compare_exchange_strong(kernel, first) ? first : kernel;
  }
  return *kernel;
}

void choose_kernel(std::string_view name) {
  chosen() = name.empty() ? &choose() : &need_kernel(name, "choose_kernel");
  choose_point_kernel(name);
}

std::vector<std::string_view> kernel_names() {
  std::vector<std::string_view> names;
  for (const Choice& choice : choices())
    if (choice.is_supported) names.emplace_back(choice.kernel.name);
  return names;
}

}  // namespace basicrt
