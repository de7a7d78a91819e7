#include "core/system/maps/map_owner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/map/test_map.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {
namespace {

using namespace test;

// Of which a schedule is kept; no file is written here.
Config recorded() {
  Config config;
  config.system.schedule_out = "schedule";
  return config;
}

class MapOwnerTest : public ::testing::Test {
 protected:
  // A keyframe that looks at the grid from `x`; the first one starts the map.
  KeyframeRequest request(std::int64_t frame, double x) {
    const Keyframe seen = keyframe_seeing(camera_, standing_at(x), points_);
    KeyframeRequest request;
    request.frame_index = frame;
    request.first = frame == 0;
    request.pose = {KeyframeId{0, 0}, standing_at(x)};
    request.features = seen.features;
    const Keyframe* first = cell_.take().snapshot->keyframes().find(KeyframeId{0, 0});
    if (first) request.landmarks = first->landmarks;
    return request;
  }

  Camera camera_;
  Points points_ = point_grid(6, 5);
  SnapshotCell cell_;
  MapOwner owner_{recorded(), camera_, cell_};
};

TEST_F(MapOwnerTest, BeginsWithAnEmptyMapForAllToSee) {
  ASSERT_NE(cell_.take().snapshot, nullptr);
  EXPECT_EQ(cell_.take().snapshot->keyframes().size(), 0U);
  EXPECT_EQ(cell_.take().inserted, 0);
  EXPECT_EQ(owner_.version(), 0U);
}

TEST_F(MapOwnerTest, EveryStepIsAVersionAnEventAndASnapshot) {
  owner_.insert(request(0, 0));
  const SnapshotCell::Content after_first = cell_.take();
  EXPECT_EQ(after_first.inserted, 1);
  EXPECT_EQ(after_first.snapshot->version(), 1U);
  EXPECT_EQ(after_first.snapshot->landmarks().size(), 30U);
  owner_.refine({});
  owner_.insert(request(9, 0.2));
  owner_.refine({});
  EXPECT_EQ(owner_.version(), 4U);
  EXPECT_EQ(cell_.take().snapshot->version(), 4U);
  EXPECT_EQ(cell_.take().inserted, 2);
  EXPECT_EQ(cell_.take().snapshot->keyframes().size(), 2U);
  EXPECT_EQ(cell_.take().snapshot->landmarks().size(), 30U) << "the same points are no new landmarks";
  EXPECT_EQ(after_first.snapshot->keyframes().size(), 1U) << "a snapshot stays as it was";

  ASSERT_EQ(owner_.edits().size(), 4U);
  EXPECT_EQ(owner_.edits()[2].kind, EditEvent::Kind::insert);
  EXPECT_EQ(owner_.edits()[2].frame, 9);
  EXPECT_EQ(owner_.edits()[3].kind, EditEvent::Kind::refine);
  EXPECT_EQ(owner_.edits()[3].frame, 9);
  EXPECT_GT(owner_.edits()[3].iterations, 0);
  EXPECT_NE(owner_.edits()[0].hash, owner_.edits()[2].hash);
}

TEST_F(MapOwnerTest, EqualRequestsMakeEqualEdits) {
  SnapshotCell other_cell;
  MapOwner other(recorded(), camera_, other_cell);
  const KeyframeRequest first = request(0, 0);
  owner_.insert(first);
  const KeyframeRequest second = request(9, 0.2);
  other.insert(first);
  for (MapOwner* owner : {&owner_, &other}) {
    owner->insert(second);
    owner->refine({});
  }
  EXPECT_EQ(owner_.edits(), other.edits());
}

TEST_F(MapOwnerTest, NoScheduleIsKeptThatNobodyAskedFor) {
  SnapshotCell cell;
  MapOwner owner(Config{}, camera_, cell);
  owner.insert(request(0, 0));
  EXPECT_EQ(owner.version(), 1U);
  EXPECT_TRUE(owner.edits().empty());
}

TEST_F(MapOwnerTest, RefiningStopsWhenToldAndSaysHowFarItCame) {
  owner_.insert(request(0, 0));
  owner_.insert(request(9, 0.2));
  owner_.refine([] { return true; });
  EXPECT_EQ(owner_.edits().back().iterations, 0);
}

// Labels of another size than the image's samples are a defect that planes cannot survive.
TEST_F(MapOwnerTest, WhatFailsIsSwitchedOffAndMappingGoesOn) {
  Config config = recorded();
  config.system.stop_on_fault = false;
  SnapshotCell cell;
  MapOwner owner(config, camera_, cell);
  KeyframeRequest first = request(0, 0);
  auto surface = std::make_shared<DepthGrid>();
  surface->columns = surface->rows = 4;
  surface->samples.resize(16);
  first.surface = surface;
  owner.insert(first);
  LabelGrid broken;
  broken.samples.resize(3);
  EXPECT_FALSE(owner.label(0, broken));
  ASSERT_EQ(cell.take().faults->size(), 0U) << "told with the next version";
  owner.find_planes();
  owner.refine({});
  ASSERT_EQ(cell.take().faults->size(), 1U);
  EXPECT_EQ(cell.take().faults->front().rfind("planes failed", 0), 0U) << cell.take().faults->front();
  for (const EditEvent& event : owner.edits()) EXPECT_NE(event.kind, EditEvent::Kind::planes);
  owner.insert(request(9, 0.2));
  EXPECT_EQ(cell.take().snapshot->keyframes().size(), 2U);
  EXPECT_EQ(owner.maps().back().followers.find<SurfaceKeeper>(), nullptr)
      << "it knows nothing of what came since";
  EXPECT_EQ(cell.take().places->size(), 2) << "places go on";
  owner.find_rooms(true);

  config.system.stop_on_fault = true;
  SnapshotCell other_cell;
  MapOwner strict(config, camera_, other_cell);
  strict.insert(first);
  EXPECT_THROW(strict.label(0, broken), std::exception);
}

TEST_F(MapOwnerTest, WhoWaitsIsWokenByTheInsertOrByTheEnd) {
  std::atomic<int> woken = 0;
  std::thread first([&] { cell_.wait_for_inserted(1), ++woken; });
  std::thread never([&] { cell_.wait_for_inserted(100), ++woken; });
  cell_.wait_for_inserted(0);  // is there already
  owner_.insert(request(0, 0));
  first.join();
  EXPECT_EQ(woken, 1);
  cell_.close();
  never.join();
  EXPECT_EQ(woken, 2);
  cell_.wait_for_inserted(200);  // nobody waits any more
}

}  // namespace
}  // namespace vsgraphs
