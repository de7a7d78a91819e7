#include "core/vision/depth_lookup.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

struct Scene {
  Camera camera;
  Image<std::uint16_t> raw;
  Scene() : raw(640, 480, 10000) {}  // 2 m
  DepthView view() const { return {raw.view(), {}}; }
};

TEST(DepthLookup, InterpolatesASlantedSurface) {
  Scene s;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) s.raw.at(u, v) = static_cast<std::uint16_t>(8000 + 10 * u + 5 * v);
  const DepthLookup lookup(s.camera);
  EXPECT_NEAR(lookup.at(s.view(), 100.25, 50.5), (8000 + 1002.5 + 252.5) / 5000, 1e-6);
  EXPECT_NEAR(lookup.at(s.view(), 100, 50), (8000 + 1000 + 250) / 5000.0, 1e-6);
  EXPECT_NEAR(lookup.pixel(s.view(), 3, 4), 8050 / 5000.0, 1e-6);
}

TEST(DepthLookup, RefusesBothSidesOfADepthEdge) {
  Scene s;
  for (int v = 0; v < 480; ++v)
    for (int u = 300; u < 640; ++u) s.raw.at(u, v) = 11000;  // 20 cm behind
  const DepthLookup lookup(s.camera);
  for (double u : {298.6, 299.0, 299.5, 300.0, 300.4}) EXPECT_EQ(lookup.at(s.view(), u, 200), 0) << u;
  EXPECT_NEAR(lookup.at(s.view(), 297.4, 200), 2.0, 1e-6);
  EXPECT_NEAR(lookup.at(s.view(), 301.6, 200), 2.2, 1e-6);
}

TEST(DepthLookup, ToleratesTheSensorsNoiseButNoMore) {
  Scene s;
  const double sigma = s.camera.depth_noise.sigma_m(2.0);
  const DepthLookup lookup(s.camera);
  s.raw.at(200, 200) = static_cast<std::uint16_t>(10000 + 2.5 * sigma * 5000);
  EXPECT_GT(lookup.at(s.view(), 200.3, 200.3), 2.0);
  s.raw.at(200, 200) = static_cast<std::uint16_t>(10000 + 12 * sigma * 5000);
  EXPECT_EQ(lookup.at(s.view(), 200.3, 200.3), 0);
}

TEST(DepthLookup, RefusesInvalidReadingsRangesAndBorders) {
  Scene s;
  s.camera.invalid_depth = {0, 65535, 9999};
  const DepthLookup lookup(s.camera);
  for (int value : {0, 65535, 9999, 1400 /* 0.28 m */, 40100 /* 8.02 m */}) {
    s.raw.at(100, 100) = static_cast<std::uint16_t>(value);
    EXPECT_EQ(lookup.pixel(s.view(), 100, 100), 0) << value;
    EXPECT_EQ(lookup.at(s.view(), 100, 100), 0) << value;
    EXPECT_EQ(lookup.at(s.view(), 99.2, 99.7), 0) << "a corner of the square is invalid: " << value;
  }
  for (double u : {-3.0, 0.5, 638.5, 1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(lookup.at(s.view(), u, 50), 0);
}

TEST(DepthLookup, MetresGiveTheSameAndNanIsNoReading) {
  Camera camera;
  Image<float> metres(640, 480, 2.0f);
  metres.at(10, 10) = std::numeric_limits<float>::quiet_NaN();
  metres.at(20, 20) = std::numeric_limits<float>::infinity();
  const DepthLookup lookup(camera);
  const DepthView view{{}, metres.view()};
  EXPECT_NEAR(lookup.at(view, 100.5, 100.5), 2.0, 1e-6);
  EXPECT_EQ(lookup.at(view, 10.2, 10.2), 0);
  EXPECT_EQ(lookup.at(view, 20.2, 20.2), 0);
}

TEST(DepthLookup, RefusesBadInput) {
  Scene s;
  const DepthLookup lookup(s.camera);
  Image<float> metres(640, 480, 2.0f);
  Image<std::uint16_t> small(320, 240, 1);
  EXPECT_NO_THROW(lookup.validate(s.view()));
  EXPECT_THROW(lookup.validate({}), InputError);
  EXPECT_THROW(lookup.validate({s.raw.view(), metres.view()}), InputError);
  EXPECT_THROW(lookup.validate({small.view(), {}}), InputError);
}

}  // namespace
}  // namespace vsgraphs
