# find_package(vsgraphs) for C++ projects: `cmake --install BUILD --component development --prefix PREFIX`.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/vsgraphs)

# One name for all of it; headers keep their paths: #include "core/system/run/slam.h".
add_library(vsgraphs INTERFACE)
target_link_libraries(vsgraphs INTERFACE vsgraphs_system_run vsgraphs_simulate)
install(TARGETS vsgraphs vsgraphs_abi EXPORT vsgraphs_targets COMPONENT development)
install(EXPORT vsgraphs_targets NAMESPACE vsgraphs:: FILE vsgraphs-targets.cmake
        DESTINATION ${package} COMPONENT development)
install(DIRECTORY core simulate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vsgraphs COMPONENT development
        FILES_MATCHING PATTERN "*.h" REGEX "test[^/]*\\.h$" EXCLUDE)

# Before 1.0 a new minor version may change any interface.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vsgraphs-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES cmake/vsgraphs-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/vsgraphs-config-version.cmake
        DESTINATION ${package} COMPONENT development)
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
