#include "core/map/map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/draft.h"

namespace vsgraphs {
namespace {

std::shared_ptr<const FeatureSet> some_features(int count) {
  std::vector<Feature> features(static_cast<std::size_t>(count));
  return std::make_shared<const FeatureSet>(features, std::vector<Descriptor>(features.size()), 640, 480);
}

Keyframe keyframe_at(double x, std::int64_t frame) {
  Keyframe keyframe;
  keyframe.frame_index = frame;
  keyframe.world_from_camera = Se3(Eigen::Matrix3d::Identity(), {x, 0, 0});
  keyframe.features = some_features(8);
  return keyframe;
}

// Three keyframes in a row; landmark i is feature i of all three, of the first two, and so on.
class MapTest : public ::testing::Test {
 protected:
  MapTest() {
    Draft draft(map.snapshot());
    for (int k = 0; k < 3; ++k) keyframes.push_back(draft.add(keyframe_at(k, 10 * k)));
    for (int i = 0; i < 6; ++i) {
      Landmark landmark;
      landmark.point_in_world = {0.1 * i, 0, 2};
      landmarks.push_back(draft.add(landmark));
      const int observers = i < 2 ? 3 : i < 4 ? 2 : 1;
      for (int k = 0; k < observers; ++k) observe(draft, i, k, i);
    }
    map.apply(draft.take());
  }
  void observe(Draft& draft, int landmark, int keyframe, int feature) {
    draft.record(
        AddObservation{landmarks[static_cast<std::size_t>(landmark)],
                       {keyframes[static_cast<std::size_t>(keyframe)], static_cast<std::uint16_t>(feature)}});
  }
  // Every observation is known to both sides.
  void expect_consistent(const Map& m) const {
    m.landmarks().for_each([&](LandmarkId id, const Landmark& landmark) {
      for (const Observation& o : landmark.observations) {
        ASSERT_TRUE(m.keyframes().contains(o.keyframe));
        EXPECT_EQ(m.keyframes().find(o.keyframe)->landmarks[o.feature], id);
      }
    });
    m.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
      for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
        if (!keyframe.landmarks[i].valid()) continue;
        const Landmark* landmark = m.landmarks().find(keyframe.landmarks[i]);
        ASSERT_NE(landmark, nullptr);
        EXPECT_THAT(landmark->observations,
                    ::testing::Contains(Observation{id, static_cast<std::uint16_t>(i)}));
      }
    });
  }

  Map map;
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
};

TEST_F(MapTest, OwnerRepeatsWhatTheDraftDid) {
  EXPECT_EQ(map.keyframes().size(), 3U);
  EXPECT_EQ(map.landmarks().size(), 6U);
  EXPECT_EQ(map.version(), 1U);
  expect_consistent(map);
}

TEST_F(MapTest, CovisibleCountsSharedLandmarksAndBreaksTiesById) {
  const auto of_second = map.covisible(keyframes[1], 1);
  ASSERT_EQ(of_second.size(), 2U);
  EXPECT_EQ(of_second[0], std::make_pair(keyframes[0], 4));
  EXPECT_EQ(of_second[1], std::make_pair(keyframes[2], 2));
  EXPECT_EQ(map.covisible(keyframes[1], 3).size(), 1U);
}

TEST_F(MapTest, RemovedKeyframeLeavesItsFramesOnTheAnchor) {
  const AnchoredPose frame{keyframes[1], Se3(Eigen::Matrix3d::Identity(), {0, 0, 0.5})};
  const Se3 before = *map.resolve(frame);
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  EXPECT_TRUE(map.resolve(frame)->translation().isApprox(before.translation()));
  EXPECT_EQ(map.reanchor(frame)->keyframe, keyframes[0]);
  // A correction of the anchor moves the frame.
  map.apply(MoveKeyframe{keyframes[0], Se3(Eigen::Matrix3d::Identity(), {0, 1, 0})});
  EXPECT_TRUE(map.resolve(frame)->translation().isApprox(before.translation() + Eigen::Vector3d(0, 1, 0)));
  expect_consistent(map);
}

TEST_F(MapTest, FramesFollowThroughSeveralRemovals) {
  const AnchoredPose frame{keyframes[2], Se3{}};
  map.apply(RemoveKeyframe{keyframes[2], keyframes[1]});
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  EXPECT_NEAR(map.resolve(frame)->translation().x(), 2.0, 1e-12);
  EXPECT_FALSE(map.resolve({KeyframeId{77, 0}, Se3{}}).has_value());
}

TEST_F(MapTest, MergeMovesObservationsAndRedirects) {
  // Landmarks 0 and 4 both are in keyframe 0: the survivor keeps its own there.
  map.apply(MergeLandmark{landmarks[4], landmarks[0]});
  EXPECT_EQ(map.landmarks().resolve(landmarks[4]), landmarks[0]);
  EXPECT_EQ(map.landmarks().find(landmarks[0])->observations.size(), 3U);
  expect_consistent(map);
  map.apply(MergeLandmark{landmarks[0], landmarks[5]});
  EXPECT_EQ(map.landmarks().find(landmarks[5])->observations.size(), 3U);
  expect_consistent(map);
}

TEST_F(MapTest, ObservationsAreNotDoubled) {
  map.apply(AddObservation{landmarks[0], {keyframes[0], 7}});  // seen there already
  map.apply(AddObservation{landmarks[5], {keyframes[1], 0}});  // feature taken
  EXPECT_EQ(map.landmarks().find(landmarks[0])->observations.size(), 3U);
  EXPECT_EQ(map.landmarks().find(landmarks[5])->observations.size(), 1U);
  expect_consistent(map);
}

TEST_F(MapTest, OperationsOnVanishedThingsDoNothing) {
  map.apply(RemoveLandmark{landmarks[0]});
  expect_consistent(map);
  map.apply(MoveLandmark{landmarks[0], {1, 2, 3}});
  map.apply(MergeLandmark{landmarks[0], landmarks[1]});
  map.apply(MergeLandmark{landmarks[1], landmarks[0]});
  map.apply(AddObservation{landmarks[0], {keyframes[0], 0}});
  map.apply(RemoveObservation{landmarks[0], keyframes[0]});
  map.apply(RemoveKeyframe{keyframes[0], KeyframeId{50, 0}});
  EXPECT_EQ(map.landmarks().size(), 5U);
  EXPECT_EQ(map.keyframes().size(), 3U);
  expect_consistent(map);
}

TEST_F(MapTest, SnapshotStaysAsItWas) {
  const Snapshot snapshot = map.snapshot();
  map.apply(RemoveKeyframe{keyframes[2], keyframes[0]});
  map.apply(MoveLandmark{landmarks[0], {9, 9, 9}});
  EXPECT_EQ(snapshot->keyframes().size(), 3U);
  EXPECT_EQ(snapshot->landmarks().find(landmarks[0])->point_in_world.z(), 2.0);
  expect_consistent(*snapshot);
}

TEST_F(MapTest, EditHashTellsEditsApart) {
  const auto hash_of = [this](const Eigen::Vector3d& p) {
    Draft draft(map.snapshot());
    draft.record(MoveLandmark{landmarks[0], p});
    return draft.take().hash();
  };
  EXPECT_EQ(hash_of({1, 2, 3}), hash_of({1, 2, 3}));
  EXPECT_NE(hash_of({1, 2, 3}), hash_of({1, 2, 3.0000001}));
  Draft other(map.snapshot());
  other.record(RemoveLandmark{landmarks[0]});
  EXPECT_NE(other.take().hash(), hash_of({1, 2, 3}));
}

}  // namespace
}  // namespace vsgraphs
