# The three OpenCV modules in use. Debian ships the CMake package only with all of OpenCV (libopencv-dev, twice
# the size), so headers and libraries are found by hand.
find_path(OPENCV_INCLUDE opencv2/features2d.hpp PATH_SUFFIXES opencv4)
if(NOT OPENCV_INCLUDE)
  message(FATAL_ERROR "OpenCV headers not found; on Debian: apt-get install libopencv-features2d-dev libopencv-imgproc-dev")
endif()
foreach(module core imgproc features2d)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv::${module} UNKNOWN IMPORTED)
  set_target_properties(opencv::${module} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE})
endforeach()
