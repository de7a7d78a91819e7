#include "core/tracking/depth_alignment.h"

#include <gtest/gtest.h>

#include "core/vision/test_rooms.h"

namespace vsgraphs {
namespace {

using namespace test;

Se3 moved(double x, double y, double z, double turn_x = 0, double turn_y = 0, double turn_z = 0) {
  Vector6d xi;
  xi << x, y, z, turn_x, turn_y, turn_z;
  return Se3::exp(xi);
}

// The reference is seen from the world's origin, or from wherever `reference_` says.
class DepthAlignmentTest : public ::testing::Test {
 protected:
  DepthGrid seen_from(const Se3& world_from_camera, const std::vector<Wall>& room) const {
    const Image<float> depth = depth_of_room(camera_, world_from_camera, room);
    return aligner_.sampler().sample(view_of(depth));
  }
  DepthAlignment align(const std::vector<Wall>& room, const Se3& truth, const Se3& initial,
                       std::span<const PoseObservation> features = {}) const {
    const DepthGrid there = seen_from(reference_, room);
    return aligner_.align(Map{}, seen_from(truth, room), {KeyframeId{0, 0}, reference_, &there}, initial,
                          features, prior_at(initial));
  }
  DepthAlignment judge(const std::vector<Wall>& room, const Se3& truth, const Se3& pose) const {
    const DepthGrid there = seen_from(reference_, room);
    return aligner_.judge(seen_from(truth, room), {KeyframeId{0, 0}, reference_, &there}, pose);
  }
  static PosePriorTerm prior_at(const Se3& pose) {
    PosePriorTerm prior;
    prior.world_from_camera = pose;
    prior.information = 1.0 / (0.05 * 0.05) * Matrix6d::Identity();
    return prior;
  }
  static double distance(const Se3& a, const Se3& b) { return (a.translation() - b.translation()).norm(); }
  static double turn(const Se3& a, const Se3& b) {
    return rotation_angle(a.rotation().transpose() * b.rotation());
  }

  Camera camera_;
  DepthAligner aligner_{camera_};
  Se3 reference_;
};

TEST_F(DepthAlignmentTest, ACornerGivesTheWholePose) {
  reference_ = moved(0.1, -0.1, 0.05, 0.02, -0.1, 0.05);
  const Se3 truth = reference_ * moved(0.06, -0.04, 0.08, 0.02, -0.03, 0.02);
  const DepthAlignment found = align(corner_room(), truth, reference_);
  EXPECT_LT(distance(found.solution.world_from_camera, truth), 0.004);
  EXPECT_LT(turn(found.solution.world_from_camera, truth), 0.001);
  EXPECT_FALSE(found.solution.degenerate);
  EXPECT_TRUE(found.convincing());
  EXPECT_FALSE(found.contradicts());
}

TEST_F(DepthAlignmentTest, AlongABlankCorridorThePredictionStaysAndThatIsSaid) {
  const Se3 truth = moved(0.05, -0.04, 0.10, 0.01, -0.02, 0.02);
  const DepthAlignment found = align(corridor(), truth, moved(0, 0, 0.02));
  const Eigen::Vector3d at = found.solution.world_from_camera.translation();
  EXPECT_NEAR(at.x(), truth.translation().x(), 0.002);
  EXPECT_NEAR(at.y(), truth.translation().y(), 0.002);
  EXPECT_NEAR(at.z(), 0.02, 0.005) << "no surface tells the way along";
  EXPECT_LT(turn(found.solution.world_from_camera, truth), 0.002);
  EXPECT_TRUE(found.solution.degenerate);
  EXPECT_TRUE(found.convincing());
}

// What the surfaces did not hold, their information must not claim.
TEST_F(DepthAlignmentTest, InformationIsThatOfTheSurfacesAlone) {
  const Se3 truth = moved(0.02, 0, 0.05);
  const Matrix6d information = align(corridor(), truth, Se3{}).surface_information;
  EXPECT_LT(information(2, 2), 1e-3 * information(0, 0));
  EXPECT_GT(information(0, 0), 1.0 / (0.005 * 0.005));
  // Sixty independent samples at most, however many there are.
  EXPECT_LT(information(0, 0), 60 / (0.0012 * 0.0012));
  EXPECT_LT(information(0, 0) + information(1, 1), 60 / (0.0012 * 0.0012));
}

TEST_F(DepthAlignmentTest, FeaturesHoldTheWayAlongTheCorridor) {
  const Se3 truth = moved(0.05, -0.04, 0.10);
  std::vector<PoseObservation> features;
  for (int i = 0; i < 20; ++i) {
    PoseObservation o;
    o.point_in_world = {i % 2 == 0 ? 0.8 : -0.8, 0.05 * i - 0.5, 3.0 + 0.1 * (i % 7)};
    const Eigen::Vector2d pixel = camera_.project(truth.inverse() * o.point_in_world);
    o.u = pixel.x();
    o.v = pixel.y();
    features.push_back(o);
  }
  const DepthAlignment found = align(corridor(), truth, Se3{}, features);
  EXPECT_LT(distance(found.solution.world_from_camera, truth), 0.005);
  EXPECT_FALSE(found.solution.degenerate);
  EXPECT_EQ(found.solution.inliers, 20);
}

TEST_F(DepthAlignmentTest, TheRightPoseConvincesAndAWrongOneIsContradicted) {
  const Se3 truth = moved(0.2, -0.1, 0.1, 0, 0.05, 0);
  const DepthAlignment right = judge(corner_room(), truth, truth);
  EXPECT_TRUE(right.convincing());
  EXPECT_FALSE(right.contradicts());
  EXPECT_GT(right.agreeing, 0.9 * right.associated);
  for (const Se3& wrong : {moved(0.3, 0.1, 0.2), moved(0, 0, -0.2), moved(0.15, -0.15, 0.15)}) {
    const DepthAlignment judged = judge(corner_room(), truth, truth * wrong);
    EXPECT_TRUE(judged.contradicts()) << judged.agreeing << " of " << judged.associated;
    EXPECT_FALSE(judged.convincing());
    EXPECT_TRUE(judged.solution.world_from_camera.matrix() == (truth * wrong).matrix()) << "only judged";
  }
}

TEST_F(DepthAlignmentTest, FarFromTheTruthNothingConvinces) {
  EXPECT_FALSE(align(corner_room(), moved(0.2, -0.1, 0.1), moved(0.2, -0.1, 1.2)).convincing());
}

TEST_F(DepthAlignmentTest, WithoutCommonSurfaceNothingIsSaid) {
  auto room = corner_room();
  room.push_back({Eigen::Vector3d(0, 0, -1), 2.0});
  room.push_back({Eigen::Vector3d(-1, 0, 0), 2.0});
  const Se3 away = moved(0, 0, 0, 0, 3.0, 0);
  const DepthAlignment judged = judge(room, away, away);
  EXPECT_FALSE(judged.convincing());
  EXPECT_FALSE(judged.contradicts());
}

TEST_F(DepthAlignmentTest, WithoutDepthThePriorIsTheAnswer) {
  const Se3 initial = moved(0.1, 0.2, 0.3);
  const DepthAlignment found = align({}, Se3{}, initial);
  EXPECT_LT(distance(found.solution.world_from_camera, initial), 1e-9);
  EXPECT_EQ(found.associated, 0);
  EXPECT_FALSE(found.convincing());
  EXPECT_FALSE(found.contradicts());
  EXPECT_TRUE(found.solution.degenerate);
}

}  // namespace
}  // namespace vsgraphs
