// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses what solves hits on triangles.
#include "geometry/kernels/chosen_point_kernel.h"

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

// AVX-512 machines have AVX2.
bool is_avx2_wanted() {
  const char* name = std::getenv("BASICRT_ISA");
  const std::string_view wanted = name == nullptr ? "" : name;
  return wanted.empty() || wanted == "avx2" || wanted == "avx512";
}

const PointKernel& choose() {
  const PointKernel* avx2 = is_avx2_wanted() ? find_point_kernel("avx2") : nullptr;
  return avx2 != nullptr ? *avx2 : plain::point_kernel;
}

}  // namespace

const PointKernel* find_point_kernel(std::string_view name) {
#if defined(__x86_64__)
  if (name == avx2::point_kernel.name && __builtin_cpu_supports("avx2")) return &avx2::point_kernel;
#endif
  return name == plain::point_kernel.name ? &plain::point_kernel : nullptr;
}

const PointKernel& chosen_point_kernel() {
  static const PointKernel& kernel = choose();
  return kernel;
}

}  // namespace basicrt
