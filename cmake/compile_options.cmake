# Flags every target of the project shares; link to this instead of repeating them.
add_library(vsgraphs_options INTERFACE)
target_compile_options(vsgraphs_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  # Fused multiply-add would make results depend on the instruction set chosen at run time.
  -ffp-contract=off)
# Eigen's own threads would reorder sums; the project brings its own.
target_compile_definitions(vsgraphs_options INTERFACE EIGEN_DONT_PARALLELIZE)
if(VSGRAPHS_SANITIZE)
  target_compile_options(vsgraphs_options INTERFACE
    -fsanitize=${VSGRAPHS_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(vsgraphs_options INTERFACE -fsanitize=${VSGRAPHS_SANITIZE})
endif()
