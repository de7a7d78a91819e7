// Tracking with its mapper on a scene whose truth needs no renderer: a painted wall, along which the camera is put by
// whole pixels.
#include "core/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/loops/loop_closer.h"
#include "core/mapping/local_mapper.h"
#include "core/vision/place_keeper.h"
#include "core/vision/test_painted_wall.h"

namespace vsgraphs {
namespace {

constexpr int width = test::painted_view_width, height = test::painted_view_height, wall_px = 700;
constexpr double wall_m = 2.0, focal_px = test::painted_view_focal_px, frame_s = 1.0 / 30.0;
constexpr double metres_per_px = wall_m / focal_px;

Camera small_camera() { return test::painted_wall_camera(1 / frame_s); }

Image<std::uint8_t> painted_wall() { return test::painted_wall(wall_px, 1600, Rng(7, "painted_wall", 0)); }

// Depth with a hole wherever surfaces are sampled: features keep theirs, surfaces have nothing to say.
Image<float> depth_for_features_only() {
  Image<float> depth(width, height, static_cast<float>(wall_m));
  for (int v = 4; v < height; v += 8)
    for (int u = 4; u < width; u += 8) depth.at(u, v) = 0;
  return depth;
}

class TrackerTest : public ::testing::Test {
 protected:
  // The camera has moved by that many pixels of the wall; mapping is done before the next frame comes.
  TrackedFrame track(double timestamp_s, int shift_px) {
    const ImageView<std::uint8_t> wall = wall_.view();
    return track_images(timestamp_s, {wall.data + shift_px, width, height, wall.stride}, depth_.view());
  }
  TrackedFrame track_dark(double timestamp_s) {
    return track_images(timestamp_s, dark_.view(), no_depth_.view());
  }
  TrackedFrame track_images(double timestamp_s, const ImageView<std::uint8_t>& grey,
                            const ImageView<float>& depth) {
    RgbdFrame frame;
    frame.index = next_index_++;
    frame.timestamp_s = timestamp_s;
    frame.grey = grey;
    frame.depth.metres = depth;
    TrackedFrame result = tracker_->track(frame, known(), 0, nullptr);
    if (result.keyframe_request) {
      KeyframeId id;
      apply(mapper_.insert(*result.keyframe_request, snapshot_, id, nullptr));
      SolveReport report;
      apply(mapper_.refine(id, snapshot_, {}, report, nullptr));
    }
    return result;
  }
  void apply(const MapEdit& edit) {
    map_.apply(edit);
    snapshot_ = map_.snapshot();
    complete(map_, places_);
  }
  KnownMaps known() const { return {{snapshot_, std::make_shared<const PlaceIndex>(places_)}, dormant_}; }
  // Frames 0..count-1 at 3 px each, as a camera moves that is followed well.
  void slide(int count) {
    for (int i = 0; i < count; ++i) {
      const TrackedFrame frame = track(i * frame_s, 3 * i);
      EXPECT_EQ(frame.status, i == 0 ? TrackStatus::initialised : TrackStatus::ok) << "frame " << i;
      expect_at(frame, 3 * i);
    }
  }
  static void expect_at(const TrackedFrame& frame, double shift_px, double tolerance_m = 0.005) {
    const Eigen::Vector3d truth(shift_px * metres_per_px, 0, 0);
    EXPECT_LT((frame.world_from_camera.translation() - truth).norm(), tolerance_m) << "frame " << frame.index;
    EXPECT_LT(rotation_angle(frame.world_from_camera.rotation()), 0.5 * tolerance_m)
        << "frame " << frame.index;
  }

  Image<std::uint8_t> wall_ = painted_wall(), dark_{width, height, 0};
  Image<float> depth_ = depth_for_features_only(), no_depth_{width, height, 0.0F};
  Map map_;
  Snapshot snapshot_ = map_.snapshot();
  PlaceIndex places_;
  std::vector<KnownMap> dormant_;
  OrbOptions orb_;
  LocalMapper mapper_{LocalMapperOptions{}, small_camera(), orb_.pyramid()};
  std::optional<Tracker> tracker_{std::in_place, TrackerOptions{}, orb_, small_camera(), 1};
  std::int64_t next_index_ = 0;
};

TEST_F(TrackerTest, WaitsForDepthBeforeItStartsAMap) {
  const ImageView<std::uint8_t> wall = wall_.view();
  const TrackedFrame blind = track_images(0, {wall.data, width, height, wall.stride}, no_depth_.view());
  EXPECT_EQ(blind.status, TrackStatus::waiting);
  EXPECT_EQ(blind.keyframe_request, nullptr);
  EXPECT_EQ(track_dark(frame_s).status, TrackStatus::waiting);
  const TrackedFrame first = track(2 * frame_s, 50);
  EXPECT_EQ(first.status, TrackStatus::initialised);
  ASSERT_NE(first.keyframe_request, nullptr);
  EXPECT_TRUE(first.keyframe_request->first);
  EXPECT_EQ(first.keyframe_request->frame_index, 2);
  EXPECT_TRUE(first.world_from_camera.matrix().isIdentity()) << "the world begins where the map does";
}

TEST_F(TrackerTest, FollowsTheCameraAndAsksForKeyframesAsTheViewChanges) {
  slide(30);
  EXPECT_GE(map_.keyframes().size(), 2U);
  EXPECT_LE(map_.keyframes().size(), 10U);
}

TEST_F(TrackerTest, ACameraThatStandsNeedsNoMoreKeyframes) {
  for (int i = 0; i < 40; ++i) expect_at(track(0.1 * i, 0), 0);
  EXPECT_EQ(map_.keyframes().size(), 1U);
}

TEST_F(TrackerTest, PosesHangOnLivingKeyframes) {
  slide(10);
  const TrackedFrame frame = track(10 * frame_s, 30);
  ASSERT_TRUE(map_.keyframes().contains(frame.pose.keyframe));
  EXPECT_LT((map_.resolve(frame.pose)->translation() - frame.world_from_camera.translation()).norm(), 0.005);
}

TEST_F(TrackerTest, DarknessIsCoastedAtConstantVelocityThenLostThenRecognised) {
  slide(15);
  for (int i = 15; i < 35; ++i) {
    const TrackedFrame frame = track_dark(i * frame_s);
    EXPECT_EQ(frame.keyframe_request, nullptr);
    // Measured last at frame 14; 0.4 s are 12 frames.
    const bool coasted = i <= 26;
    EXPECT_EQ(frame.status, coasted ? TrackStatus::coasting : TrackStatus::lost) << "frame " << i;
    EXPECT_EQ(has_pose(frame.status), coasted);
    if (coasted) expect_at(frame, 3 * i, 0.03);
  }
  const TrackedFrame back = track(35 * frame_s, 20);
  EXPECT_EQ(back.status, TrackStatus::relocalised);
  expect_at(back, 20);
  const TrackedFrame next = track(36 * frame_s, 23);
  EXPECT_EQ(next.status, TrackStatus::ok);
  expect_at(next, 23);
}

// Most of the view fits, features and surfaces, but beside it the camera looks through the wall: it is another room.
TEST_F(TrackerTest, APlaceThatLooksAlikeButHasNoWallThereIsNotRecognised) {
  depth_ = Image<float>(width, height, static_cast<float>(wall_m));
  Image<float> deeper = depth_;
  for (int v = 0; v < height; ++v)
    for (int u = width * 80 / 100; u < width; ++u) deeper.at(u, v) = static_cast<float>(1.4 * wall_m);
  for (const bool trusting : {false, true}) {
    map_ = Map{};
    snapshot_ = map_.snapshot();
    places_ = PlaceIndex{};
    TrackerOptions options;
    if (trusting) options.recovery.max_seen_through_share = 1;
    tracker_.emplace(options, orb_, small_camera(), 1);
    slide(15);
    for (int i = 15; i < 35; ++i) track_dark(i * frame_s);
    const ImageView<std::uint8_t> wall = wall_.view();
    const TrackedFrame back =
        track_images(35 * frame_s, {wall.data + 20, width, height, wall.stride}, deeper.view());
    EXPECT_EQ(back.status, trusting ? TrackStatus::relocalised : TrackStatus::lost);
    EXPECT_EQ(track(36 * frame_s, 20).status, trusting ? TrackStatus::ok : TrackStatus::relocalised);
  }
}

// On leaving a room the reference's surfaces are mostly other ones than those in view: a poster's worth of matches knows better.
TEST_F(TrackerTest, EnoughMatchesStandWhereSurfacesContradict) {
  const ImageView<std::uint8_t> wall = wall_.view();
  // Features keep their depth; where surfaces are sampled stands another one.
  Image<float> other_surface(width, height, static_cast<float>(wall_m));
  for (int v = 4; v < height; v += 8)
    for (int u = 4; u < width; u += 8) other_surface.at(u, v) = static_cast<float>(0.7 * wall_m);
  struct Case {
    int poster_px, enough_inliers;
    bool stands;
  };
  for (const auto [poster_px, enough_inliers, stands] :
       {Case{24, 40, true}, Case{24, 110, false}, Case{8, 40, false}}) {
    map_ = Map{};
    snapshot_ = map_.snapshot();
    places_ = PlaceIndex{};
    next_index_ = 0;
    TrackerOptions options;
    options.enough_inliers = enough_inliers;
    tracker_.emplace(options, orb_, small_camera(), 1);
    depth_ = Image<float>(width, height, static_cast<float>(wall_m));
    for (int i = 0; i < 15; ++i) ASSERT_EQ(track(i * frame_s, 3 * i).status == TrackStatus::ok, i > 0);
    Image<std::uint8_t> poster(width, height, 128);
    for (int v = 0; v < height; ++v)
      for (const int u : {40, width - 40 - poster_px})
        std::copy_n(wall.data + v * wall.stride + 45 + u, poster_px, &poster.at(u, v));
    const TrackedFrame frame = track_images(15 * frame_s, poster.view(), other_surface.view());
    EXPECT_EQ(frame.status, stands ? TrackStatus::ok : TrackStatus::coasting) << poster_px;
    EXPECT_EQ(frame.matches >= enough_inliers, stands) << frame.matches;
    EXPECT_LT(frame.matches, options.few_inliers) << "surfaces would not be asked";
    if (stands) expect_at(frame, 45, 0.02);
  }
}

TEST_F(TrackerTest, HoweverSlowTheFramesAFewAreCoasted) {
  for (int i = 0; i < 5; ++i) track(1.0 * i, 3 * i);
  for (int i = 5; i < 8; ++i) EXPECT_EQ(track_dark(1.0 * i).status, TrackStatus::coasting) << "frame " << i;
  EXPECT_EQ(track_dark(8.0).status, TrackStatus::lost);
}

TEST_F(TrackerTest, AShortDarknessCostsNothing) {
  slide(15);
  for (int i = 15; i < 20; ++i) track_dark(i * frame_s);
  const TrackedFrame frame = track(20 * frame_s, 60);
  EXPECT_EQ(frame.status, TrackStatus::ok);
  expect_at(frame, 60);
}

// 90 px are 0.7 m: more than a camera can go between two frames, but not in a second.
TEST_F(TrackerTest, AJumpIsNotBelieved) {
  slide(15);
  const TrackedFrame jump = track(15 * frame_s, 45 + 90);
  EXPECT_EQ(jump.status, TrackStatus::coasting);
  EXPECT_EQ(jump.keyframe_request, nullptr);
  expect_at(jump, 45, 0.02);
  const TrackedFrame after = track(16 * frame_s, 48);
  EXPECT_EQ(after.status, TrackStatus::ok);
  expect_at(after, 48);
}

// 20 px back are 0.15 m, slow enough for a camera, but not for one that went the other way a frame ago.
TEST_F(TrackerTest, ASuddenTurnBackIsNotBelieved) {
  slide(15);
  EXPECT_EQ(track(15 * frame_s, 42 - 20).status, TrackStatus::coasting);
  const TrackedFrame after = track(16 * frame_s, 48);
  EXPECT_EQ(after.status, TrackStatus::ok);
  expect_at(after, 48);
}

TEST_F(TrackerTest, TheSameStepInASecondIsFollowed) {
  slide(15);
  const TrackedFrame far = track(14 * frame_s + 1.0, 42 + 90);
  EXPECT_EQ(far.status, TrackStatus::ok);
  expect_at(far, 42 + 90, 0.01);
}

TEST_F(TrackerTest, ImagesOfTheWrongSizeAreRefusedAndHarmNothing) {
  slide(5);
  const Image<std::uint8_t> small(width / 2, height, 0);
  const Image<float> small_depth(width, height / 2, 1.0F);
  EXPECT_THROW(track_images(5 * frame_s, small.view(), depth_.view()), InputError);
  EXPECT_THROW(track_images(5 * frame_s, dark_.view(), small_depth.view()), InputError);
  const TrackedFrame frame = track(5 * frame_s, 15);
  EXPECT_EQ(frame.status, TrackStatus::ok);
  expect_at(frame, 15);
}

}  // namespace
}  // namespace vsgraphs
