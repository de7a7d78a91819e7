# vsgraphs_layer(NAME [LIBRARIES lib...] BELOW layer...)
# One folder is one target. Sources are NAME/**/*.cpp below the list file that calls it; *_test.cpp files
# become the test program NAME_test (a slash of the name becomes _). BELOW lists the layers it may include.
function(vsgraphs_layer NAME)
  cmake_parse_arguments(LAYER "" "" "LIBRARIES;BELOW;TEST_LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")

  string(REPLACE "/" "_" name ${NAME})
  set(target vsgraphs_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:vsgraphs_options>)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/vsgraphs>)
  list(TRANSFORM LAYER_BELOW REPLACE "/" "_")
  list(TRANSFORM LAYER_BELOW PREPEND vsgraphs_)
  target_link_libraries(${target} ${scope} vsgraphs_abi ${LAYER_BELOW} ${LAYER_LIBRARIES})
  install(TARGETS ${target} EXPORT vsgraphs_targets COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

  if(VSGRAPHS_BUILD_TESTS AND tests)
    find_package(GTest REQUIRED)
    include(GoogleTest)
    add_executable(${name}_test ${tests})
    target_link_libraries(${name}_test PRIVATE
      ${target} vsgraphs_options GTest::gmock GTest::gtest_main ${LAYER_TEST_LIBRARIES})
    gtest_discover_tests(${name}_test DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
