#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/base/check.h"
#include "core/geometry/camera.h"

namespace vsgraphs {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();

std::string complaint(const Camera& camera) {
  try {
    camera.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string complaint_after(auto change) {
  Camera camera;
  change(camera);
  return complaint(camera);
}

Camera lens(int width, int height, double focal, std::array<double, 5> distortion) {
  Camera camera;
  camera.width = width, camera.height = height;
  camera.fx = camera.fy = focal;
  camera.cx = width / 2.0, camera.cy = height / 2.0;
  camera.distortion = distortion;
  return camera;
}

TEST(CameraLimits, OfEachFieldTheValueTheRangeAndACureAreSaid) {
  EXPECT_THAT(complaint(Camera{}), IsEmpty());
  EXPECT_EQ(complaint_after([](Camera& c) { c.fx = 1e300; }),
            "camera: fx must be 27.9964 to 7329.2 px, not 1e+300 (at 640x480 a view of 170 to 5 degrees; "
            "give focal "
            "lengths in pixels, of images of this size)");
  for (const double value : {0.0, -1.0, nan, inf, -inf, 1e300, -1e300, 1e-300}) {
    const std::pair<double Camera::*, const char*> fields[] = {{&Camera::fx, "fx"},
                                                               {&Camera::fy, "fy"},
                                                               {&Camera::fps, "fps"},
                                                               {&Camera::depth_scale, "depth_scale"},
                                                               {&Camera::depth_min_m, "depth_min_m"},
                                                               {&Camera::depth_max_m, "depth_max_m"}};
    for (const auto& [field, name] : fields)
      EXPECT_THAT(complaint_after([&](Camera& c) { c.*field = value; }),
                  testing::StartsWith(std::string("camera: ") + name + " must be "))
          << name << " " << value;
  }
  for (const double value : {nan, inf, 1e9, -1e9, 900.0}) {
    EXPECT_THAT(complaint_after([&](Camera& c) { c.cx = value; }), HasSubstr("cx must be -160 to 800 px"));
    EXPECT_THAT(complaint_after([&](Camera& c) { c.cy = value; }), HasSubstr("cy must be -120 to 600 px"));
  }
  for (const int value : {0, -1, 3, 9000, std::numeric_limits<int>::max()}) {
    EXPECT_THAT(complaint_after([&](Camera& c) { c.width = value; }),
                HasSubstr("width must be 64 to 8192 px"));
    EXPECT_THAT(complaint_after([&](Camera& c) { c.height = value; }),
                HasSubstr("height must be 64 to 8192 px"));
  }
  EXPECT_THAT(complaint_after([](Camera& c) { c.depth_min_m = 9; }),
              HasSubstr("depth_max_m must exceed depth_min_m"));
  EXPECT_THAT(complaint_after([](Camera& c) { c.fy = 5000; }), HasSubstr("fy must be 131.25 to 2100 px"));
  EXPECT_THAT(complaint_after([](Camera& c) { c.depth_noise.offset_m = 0; }),
              HasSubstr("depth_noise.offset_m"));
  EXPECT_THAT(complaint_after([](Camera& c) { c.depth_noise.scale_per_m = nan; }),
              HasSubstr("depth_noise.scale"));
  EXPECT_THAT(complaint_after([](Camera& c) { c.depth_noise.onset_m = 1e9; }),
              HasSubstr("depth_noise.onset_m"));
  EXPECT_THAT(complaint_after([](Camera& c) { c.depth_noise.alignment_m = -1; }),
              HasSubstr("depth_noise.alig"));
}

TEST(CameraLimits, LensesThatFoldTheImageAreRefused) {
  for (std::size_t i = 0; i < 5; ++i) {
    for (const double value : {nan, inf, 1e300, -1e300, 1e6})
      EXPECT_THAT(complaint_after([&](Camera& c) { c.distortion[i] = value; }), HasSubstr("distortion")) << i;
  }
  EXPECT_THAT(complaint(lens(640, 480, 525, {-1, 0, 0, 0, 0})), HasSubstr("folds the image over itself"));
  EXPECT_THAT(complaint(lens(640, 480, 525, {-9, 50, 3, 3, 1})), HasSubstr("folds the image over itself"));
  // In another order than ours: k1 k2 k3 p1 p2.
  EXPECT_THAT(complaint(lens(640, 480, 525, {0.2624, -0.9531, 1.1633, -0.0054, 0.0026})), HasSubstr("order"));
}

TEST(CameraLimits, RealCamerasAreNot) {
  EXPECT_THAT(complaint(lens(640, 480, 517, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633})),
              IsEmpty());                                                         // TUM freiburg1
  EXPECT_THAT(complaint(lens(640, 480, 517, {0.2, -0.59, 0, 0, 0})), IsEmpty());  // a Kinect without its k3
  EXPECT_THAT(complaint(lens(752, 480, 458, {-0.28340811, 0.07395907, 0.00019359, 1.76e-05, 0})),
              IsEmpty());  // EuRoC
  EXPECT_THAT(complaint(lens(1392, 512, 984, {-0.3729, 0.2037, 0.0022, 0.0014, -0.0723})),
              IsEmpty());  // KITTI
  EXPECT_THAT(complaint(lens(512, 424, 365, {0.0905, -0.2682, 0, 0, 0.0951})),
              IsEmpty());                                                            // Kinect v2, depth
  EXPECT_THAT(complaint(lens(4032, 3024, 9000, {0.5, -20, 0, 0, 300})), IsEmpty());  // a telephoto lens
  EXPECT_THAT(complaint(lens(1920, 1440, 1600, {})), IsEmpty());                     // a phone
  EXPECT_THAT(complaint(lens(1280, 720, 172, {})), IsEmpty());                       // 150 degrees wide
  EXPECT_THAT(complaint(lens(160, 120, 131, {})), IsEmpty());
  Camera part = lens(200, 480, 525, {});  // cut out of a larger image
  part.cx = 230;
  EXPECT_THAT(complaint(part), IsEmpty());
}

}  // namespace
}  // namespace vsgraphs
