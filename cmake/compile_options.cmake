# What the compiled code and whoever includes our headers must agree on: Eigen's alignment and the order of its sums
# follow the instruction set, and inline functions exist on both sides. The installed package hands these on.
add_library(vsgraphs_abi INTERFACE)
target_compile_features(vsgraphs_abi INTERFACE cxx_std_20)
# Fused multiply-add would make results depend on the instruction set.
target_compile_options(vsgraphs_abi INTERFACE -ffp-contract=off)
# Eigen's own threads would reorder sums; the project brings its own.
target_compile_definitions(vsgraphs_abi INTERFACE EIGEN_DONT_PARALLELIZE)

# x86-64-v3 (AVX2, 2013 and later) halves the cost of features and matching. The Python package asks the processor
# before it loads a module, so that an older machine gets a sentence and not an illegal instruction.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  set(VSGRAPHS_CPU "x86-64-v3" CACHE STRING "Oldest x86 level to run on: x86-64-v2, x86-64-v3, x86-64-v4, native")
  target_compile_options(vsgraphs_abi INTERFACE -march=${VSGRAPHS_CPU})
else()
  set(VSGRAPHS_CPU "generic")
endif()

# Flags of the project's own sources; link to this instead of repeating them.
add_library(vsgraphs_options INTERFACE)
target_compile_options(vsgraphs_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
if(NOT VSGRAPHS_CPU MATCHES "v3|v4|native")
  # Without AVX the compiler warns of how it hands on 32-byte vectors; ours (core/vision/simd.h) stay in one file.
  target_compile_options(vsgraphs_options INTERFACE -Wno-psabi)
endif()
# Where defects are hunted, a part that fails must not be switched off in silence.
if(VSGRAPHS_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(vsgraphs_options INTERFACE VSGRAPHS_STOP_ON_FAULT)
endif()
if(VSGRAPHS_SANITIZE)
  target_compile_options(vsgraphs_options INTERFACE
    -fsanitize=${VSGRAPHS_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # gcc 12 takes Eigen's temporaries for uninitialised once a sanitizer's code stands between; the sanitizers
    # themselves watch memory better than the warning.
    -Wno-maybe-uninitialized)
  target_link_options(vsgraphs_options INTERFACE -fsanitize=${VSGRAPHS_SANITIZE})
endif()
