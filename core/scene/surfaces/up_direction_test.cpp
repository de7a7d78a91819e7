#include "core/scene/surfaces/up_direction.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/map/map.h"

namespace vsgraphs {
namespace {

const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.9, 0.2).normalized();
const Eigen::Vector3d east = up.unitOrthogonal(), north = up.cross(east);

Eigen::Vector3d tilted(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis) * up;
}

const UprightEvidence ground{up, 4, true};
const UprightEvidence east_wall{-east, 4, false}, north_wall{-north, 3, false};

void expect_up(const std::optional<Eigen::Vector3d>& found, double tolerance = 1e-6) {
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((*found - up).norm(), tolerance);
}

TEST(UpDirection, GroundAloneSaysIt) { expect_up(find_up({ground}, tilted(0.3, east))); }

TEST(UpDirection, TwoWallsThatAreNotParallelSayIt) {
  expect_up(find_up({east_wall, north_wall}, tilted(0.3, east)));
  const Eigen::Vector3d oblique = (east + 0.6 * north).normalized();  // rooms need not be rectangular
  expect_up(find_up({east_wall, {oblique, 3, false}}, tilted(0.3, north)));
}

TEST(UpDirection, IsOpenBeforeTheyAgree) {
  EXPECT_FALSE(find_up({}, up).has_value());
  EXPECT_FALSE(find_up({east_wall}, up).has_value()) << "one wall leaves it free to turn";
  const UprightEvidence opposite{east, 4, false};
  EXPECT_FALSE(find_up({east_wall, opposite}, up).has_value()) << "nor do parallel walls hold it";
  UprightEvidence small = ground;
  small.area_m2 = 0.3;
  EXPECT_FALSE(find_up({small}, up).has_value()) << "a stool is not the ground";
}

TEST(UpDirection, ACeilingAloneDoesNotSayIt) {
  const UprightEvidence ceiling{-up, 4, false};
  EXPECT_FALSE(find_up({ceiling}, up).has_value());
}

TEST(UpDirection, TheCameraMayBeHeldThirtyDegreesWrong) {
  for (const Eigen::Vector3d& axis : {east, north, Eigen::Vector3d(east + north).normalized()}) {
    for (const double angle_rad : {-0.5236, 0.5236}) {
      expect_up(find_up({ground, east_wall, north_wall}, tilted(angle_rad, axis)));
      expect_up(find_up({east_wall, north_wall}, tilted(angle_rad, axis)));
    }
  }
}

TEST(UpDirection, ACameraOnItsSideDecidesNothing) {
  EXPECT_FALSE(find_up({ground}, tilted(1.4, east)).has_value());
}

TEST(UpDirection, ASlopeIsOutvoted) {
  const UprightEvidence ramp{tilted(0.4, east), 2, true};
  expect_up(find_up({ground, east_wall, north_wall, ramp}, tilted(0.2, north)));
}

TEST(UpDirection, SurfacesInDisorderDecideNothing) {
  std::vector<UprightEvidence> slopes;
  for (const double angle_rad : {0.2, 0.35, 0.5, -0.25, -0.45}) {
    slopes.push_back({tilted(angle_rad, east), 1.5, true});
    slopes.push_back({tilted(angle_rad, north), 1.5, true});
  }
  EXPECT_FALSE(find_up(slopes, up).has_value());
}

TEST(UpDirection, NoisyNormalsAreAveraged) {
  // Both tilt axes: a ground off about one and walls off about the other.
  const Eigen::Vector3d off = tilted(0.02, east);
  const Eigen::Vector3d leaning = Eigen::AngleAxisd(0.02, north) * -east;
  expect_up(find_up({{off, 4, true}, {leaning, 4, false}, north_wall, ground}, up), 0.02);
}

TEST(UpDirection, DoesNotDependOnTheOrder) {
  const auto a = find_up({ground, east_wall, north_wall}, tilted(0.1, east));
  const auto b = find_up({north_wall, ground, east_wall}, tilted(0.1, east));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a, *b);
}

}  // namespace
}  // namespace vsgraphs
