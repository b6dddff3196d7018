# SPDX-License-Identifier: GPL-3.0-or-later
# The core library from its sources.
find_package(nlohmann_json 3.10 REQUIRED)
find_path(TINYOBJLOADER_INCLUDE_DIR tiny_obj_loader.h REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_image.h REQUIRED)

file(GLOB_RECURSE core_sources CONFIGURE_DEPENDS src/*.cpp)
list(REMOVE_ITEM core_sources ${CMAKE_CURRENT_SOURCE_DIR}/src/io/exr.cpp)
add_library(basicrt_core STATIC ${core_sources})
target_include_directories(basicrt_core PUBLIC src)
target_include_directories(basicrt_core SYSTEM PRIVATE ${TINYOBJLOADER_INCLUDE_DIR} ${STB_INCLUDE_DIR})
target_link_libraries(basicrt_core PUBLIC Threads::Threads PRIVATE nlohmann_json::nlohmann_json)
# Each ray kernel for its instruction set; the best that the machine has is chosen at run time.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#ifndef __x86_64__\n#error\n#endif\nint main() {}" BASICRT_IS_FOR_X86_64)
if(BASICRT_IS_FOR_X86_64)
  set(kernel_flags_sse42 -msse4.2)
  set(kernel_flags_avx2 -mavx2 -mbmi -mbmi2 -mlzcnt)
  set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512vl -mavx512dq -mavx512bw)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ 12 takes the undefined register of its own intrinsics for a mistake of ours (GCC bug 105593).
    list(APPEND kernel_flags_avx512 -Wno-maybe-uninitialized -Wno-uninitialized)
  endif()
  foreach(isa sse42 avx2 avx512)
    set_source_files_properties(src/bvh/kernels/${isa}.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags_${isa}}")
  endforeach()
  set_source_files_properties(src/geometry/kernels/avx2.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags_avx2}")
endif()
target_compile_definitions(basicrt_core PRIVATE BASICRT_VERSION="${PROJECT_VERSION}")
