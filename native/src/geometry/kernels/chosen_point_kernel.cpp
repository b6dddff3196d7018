// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses what solves hits on triangles.
#include "geometry/kernels/chosen_point_kernel.h"

#include <atomic>
#include <cstdlib>

namespace basicrt {

namespace plain {
extern const PointKernel point_kernel;
}
#if defined(__x86_64__)
namespace avx2 {
extern const PointKernel point_kernel;
}
#endif

namespace {

// AVX-512 machines have AVX2. The environment variable says which where `isa` is empty.
const PointKernel& choose(std::string_view isa) {
  const char* name = std::getenv("BASICRT_ISA");
  if (isa.empty() && name != nullptr) isa = name;
  const bool is_avx2_wanted = isa.empty() || isa == "avx2" || isa == "avx512";
  const PointKernel* avx2 = is_avx2_wanted ? find_point_kernel("avx2") : nullptr;
  return avx2 != nullptr ? *avx2 : plain::point_kernel;
}

std::atomic<const PointKernel*>& chosen() {
  static std::atomic<const PointKernel*> kernel = &choose({});
  return kernel;
}

}  // namespace

const PointKernel* find_point_kernel(std::string_view name) {
#if defined(__x86_64__)
  if (name == avx2::point_kernel.name && __builtin_cpu_supports("avx2")) return &avx2::point_kernel;
#endif
  return name == plain::point_kernel.name ? &plain::point_kernel : nullptr;
}

const PointKernel& chosen_point_kernel() { return *chosen().load(std::memory_order_acquire); }

void choose_point_kernel(std::string_view isa) { chosen() = &choose(isa); }

}  // namespace basicrt
