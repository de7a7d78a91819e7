// The whole map's adjustment, run later than it was asked for.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/system/maps/map_owner.h"
#include "core/system/run/test_wall_scene.h"
#include "core/system/run/tracking_lane.h"

namespace vsgraphs {
namespace {

using namespace test;

// Tracking and the map's owner by hand, so that an adjustment of the whole map can be let come late.
class StepByStep {
 public:
  void see(int px) { track(scene_.seen_from(px)); }
  void walk(int from_px, int to_px) {
    const int step = from_px < to_px ? 8 : -8;
    for (int px = from_px; px != to_px; px += step) see(px);
  }
  void cover() {
    for (int i = 0; i < 16; ++i) track(scene_.in_the_dark());
  }
  void walk_elsewhere() {
    for (int px = 0; px < 160; px += 8) track(scene_.seen_elsewhere(px));
  }
  MapOwner& owner() { return owner_; }
  SnapshotCell::Content content() const { return cell_.take(); }
  double largest_error_m() const {
    double largest = 0;
    const Snapshot map = cell_.take().snapshot;
    map->keyframes().for_each([&](KeyframeId, const Keyframe& k) {
      const auto truth = scene_.truth(k.timestamp_s);
      if (truth) largest = std::max(largest, (k.world_from_camera.translation() - *truth).norm());
    });
    return largest;
  }

 private:
  void track(const RgbdFrame& frame) {
    const TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) owner_.work_on(*result.keyframe_request, {});
  }

  static Config recorded() {
    Config config = configured("serial");
    config.system.schedule_out = "schedule";  // kept, not written
    return config;
  }

  Config config_ = recorded();
  WallScene scene_;
  SnapshotCell cell_;
  TrackingLane tracking_{config_, small_camera()};
  MapOwner owner_{config_, small_camera(), cell_};
};

TEST(WholeMapAdjustment, ThatComesLateFitsTheMapThatWentOn) {
  StepByStep walk;
  walk.walk(0, 160);
  walk.cover();
  int px = 520;
  for (; !walk.owner().adjustment(); px -= 8) {
    ASSERT_GT(px, 100) << "the two maps were never joined";
    walk.see(px);
  }
  const std::shared_ptr<FullAdjustment> asked_for = walk.owner().adjustment();
  EXPECT_LT(walk.content().completed, walk.content().inserted) << "who waits goes on waiting";
  walk.walk(px, 0);
  walk.walk(0, 240);
  ASSERT_EQ(walk.owner().adjustment(), asked_for) << "nothing moved the map: it is still wanted";
  EXPECT_GT(walk.content().snapshot->version(), asked_for->base().version());
  walk.owner().adjust_here();
  EXPECT_EQ(walk.content().completed, walk.content().inserted);
  EXPECT_LT(walk.largest_error_m(), 0.03);
  walk.walk(240, 400);
  EXPECT_LT(walk.largest_error_m(), 0.03);
}

TEST(WholeMapAdjustment, IsLeftOutOfARunThatIsStopped) {
  StepByStep walk;
  walk.walk(0, 160);
  walk.cover();
  for (int px = 520; !walk.owner().adjustment() && px > 100; px -= 8) walk.see(px);
  ASSERT_NE(walk.owner().adjustment(), nullptr);
  walk.owner().end_run([] { return true; });
  EXPECT_EQ(walk.owner().adjustment(), nullptr);
  EXPECT_TRUE(walk.content().counts.unadjusted);
  EXPECT_EQ(walk.content().completed, walk.content().inserted) << "nobody waits for it";
  const std::vector<EditEvent>& edits = walk.owner().edits();
  EXPECT_EQ(edits.back().kind, EditEvent::Kind::rooms) << "the last pass, but no more than a usual one";
  for (const EditEvent& edit : edits) EXPECT_NE(edit.kind, EditEvent::Kind::adjust);
}

TEST(WholeMapAdjustment, IsPutOffWhileAnotherMapIsWorkedOn) {
  StepByStep walk;
  walk.walk(0, 160);
  walk.cover();
  for (int px = 520; !walk.owner().adjustment() && px > 100; px -= 8) walk.see(px);
  ASSERT_NE(walk.owner().adjustment(), nullptr);
  walk.cover();
  walk.walk_elsewhere();
  EXPECT_EQ(walk.owner().adjustment(), nullptr);
  EXPECT_EQ(walk.content().completed, walk.content().inserted);
  walk.cover();
  walk.walk(80, 160);
  ASSERT_EQ(walk.content().dormant->size(), 1U) << "the first map is worked on again";
  EXPECT_NE(walk.owner().adjustment(), nullptr) << "and still to be adjusted";
  walk.owner().end_run();
  EXPECT_EQ(walk.owner().adjustment(), nullptr);
  EXPECT_LT(walk.largest_error_m(), 0.03);
}

}  // namespace
}  // namespace vsgraphs
