#include "core/system/maps/markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

using ::testing::HasSubstr;

MarkerDetection sound() {
  return {{12}, 0.16, Se3(Eigen::Matrix3d::Identity(), {0, 0, 2}), 1e-4 * Matrix6d::Identity()};
}

// What checking complains of; empty if of nothing.
template <typename Change>
std::string complaint(Change&& change) {
  MarkerDetections detections{sound(), sound()};
  change(detections[1]);
  try {
    check_markers(detections);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(CheckMarkers, SoundOnesPass) {
  EXPECT_EQ(complaint([](MarkerDetection&) {}), "");
  EXPECT_NO_THROW(check_markers({}));
}

TEST(CheckMarkers, WhatMakesNoSenseIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_THAT(complaint([&](auto& d) { d.size_m = size; }), HasSubstr("marker 12: its size"));
  const Eigen::Vector3d somewhere(0, 0, 1);
  for (const Eigen::Matrix3d& turn :
       {Eigen::Matrix3d(2 * Eigen::Matrix3d::Identity()), Eigen::Matrix3d(-Eigen::Matrix3d::Identity()),
        Eigen::Matrix3d(Eigen::Matrix3d::Constant(nan))})
    EXPECT_THAT(complaint([&](auto& d) { d.camera_from_marker = Se3(turn, somewhere); }), HasSubstr("rigid"));
  EXPECT_THAT(
      complaint([&](auto& d) { d.camera_from_marker = Se3(Eigen::Matrix3d::Identity(), {nan, 0, 1}); }),
      HasSubstr("rigid"));
  EXPECT_THAT(complaint([&](auto& d) { d.covariance(0, 0) = nan; }), HasSubstr("covariance"));
  EXPECT_THAT(complaint([&](auto& d) { d.covariance(0, 0) = 0; }), HasSubstr("covariance"));
  EXPECT_THAT(complaint([&](auto& d) { d.covariance(0, 1) = 1e-5; }), HasSubstr("covariance"));
  EXPECT_THAT(complaint([&](auto& d) { d.covariance(0, 1) = d.covariance(1, 0) = 1; }),
              HasSubstr("covariance"));
}

}  // namespace
}  // namespace vsgraphs
