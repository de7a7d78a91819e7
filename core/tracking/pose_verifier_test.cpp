#include "core/tracking/pose_verifier.h"

#include <gtest/gtest.h>

#include "core/tracking/test_tracking_world.h"

namespace vsgraphs {
namespace {

using namespace test;

// A keyframe at the origin saw a room 6 m wide; the frame sees one that may be wider.
class PoseVerifierTest : public ::testing::Test {
 protected:
  PoseVerifierTest() {
    keyframe_ = world_.keep(world_.frame({}, points_, square_room(3)), {});
    landmarks_ = add_landmarks(world_.map, points_, {keyframe_});
    local_map_.select(world_.map, landmarks_, keyframe_, 5);
    world_.follow(world_.frame({}, {}, {}), {}, keyframe_);
  }
  bool follows(const Se3& truth, double half_width_m, bool guessed, const Se3& predicted) {
    now_ = world_.frame(truth, {}, square_room(half_width_m));
    return verifier_.follows(world_.step(now_, predicted), local_map_, pose(truth), guessed);
  }
  bool fits(double half_width_m, int inliers = 100) {
    now_ = world_.frame({}, {}, square_room(half_width_m));
    return verifier_.fits(world_.map, local_map_, *now_.surface, pose({}, inliers));
  }
  static FramePose pose(const Se3& world_from_camera, int inliers = 100) {
    FramePose pose;
    pose.world_from_camera = world_from_camera;
    pose.inliers = inliers;
    return pose;
  }

  Points points_ = point_grid(6, 4);
  TrackingWorld world_;
  RecoveryOptions options_;
  DepthAligner aligner_{world_.camera};
  PoseVerifier verifier_{options_, world_.camera, aligner_};
  LocalMap local_map_;
  KeyframeId keyframe_;
  std::vector<LandmarkId> landmarks_;
  FrameState now_;
};

TEST_F(PoseVerifierTest, AGuessMustLieOnTheSurfacesOfTheReference) {
  const Se3 truth = standing_at(0.1);
  EXPECT_TRUE(follows(truth, 3, true, truth));
  EXPECT_FALSE(follows(truth, 2.5, true, truth));
  EXPECT_TRUE(follows(truth, 2.5, false, truth)) << "a predicted one need not: people walk by";
}

TEST_F(PoseVerifierTest, ALeapMustNotLookThroughWalls) {
  const Se3 leap(so3_exp({0, 0.22, 0}), Eigen::Vector3d::Zero());
  const Se3 turn(so3_exp({0, 0.18, 0}), Eigen::Vector3d::Zero());
  EXPECT_TRUE(follows(leap, 3, false, leap));
  EXPECT_FALSE(follows(leap, 4, false, leap));
  EXPECT_TRUE(follows(leap, 2.5, false, leap)) << "what stands before the wall may have come since";
  EXPECT_TRUE(follows(turn, 4, false, turn));
}

TEST_F(PoseVerifierTest, APoseOutOfReachIsNotBelieved) {
  EXPECT_TRUE(follows(standing_at(0.1), 3, false, {}));
  EXPECT_FALSE(follows(standing_at(0.3), 3, false, {}));
}

TEST_F(PoseVerifierTest, AfterALossSurfacesMustFitBothWays) {
  EXPECT_TRUE(fits(3));
  EXPECT_FALSE(fits(4)) << "looks through the wall";
  EXPECT_FALSE(fits(2.5)) << "the wall is not where it was";
}

// Beside the part that agrees the frame looks through: not enough to contradict, enough to be another room.
TEST_F(PoseVerifierTest, AShareOfTheSurfacesLookedThroughIsTooMuch) {
  const auto now_with_a_hole = [&](int columns) {
    DepthGrid grid = grid_of(world_.camera, {}, square_room(3));
    for (int r = 0; r < grid.rows; ++r)
      for (int c = 0; c < columns; ++c)
        grid.samples[static_cast<std::size_t>(r * grid.columns + c)].point *= 1.5F;
    return verifier_.fits(world_.map, local_map_, grid, pose({}));
  };
  EXPECT_TRUE(now_with_a_hole(1));
  EXPECT_FALSE(now_with_a_hole(10));
}

TEST_F(PoseVerifierTest, WhereSurfacesSayNothingTheNumberOfMatchesDoes) {
  const DepthGrid dark = grid_of(world_.camera, {}, {});
  const int enough = 2 * options_.min_relocalisation_inliers;
  EXPECT_TRUE(verifier_.fits(world_.map, local_map_, dark, pose({}, enough)));
  EXPECT_FALSE(verifier_.fits(world_.map, local_map_, dark, pose({}, enough - 1)));
}

}  // namespace
}  // namespace vsgraphs
