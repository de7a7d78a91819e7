#include "core/map/map_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/map/draft.h"
#include "core/map/test_full_map.h"

namespace vsgraphs {
namespace {

using test::full_map;

constexpr ArchiveKind kind{"TEST_MAP", 5, "map"};

Bytes bytes_of(const Map& map) {
  ArchiveWriter archive(kind);
  save_map(archive, "m", map);
  return test::joined(archive.finish());
}

Map map_of(std::span<const std::byte> bytes) {
  ArchiveReader archive("FILE", bytes, kind);
  load_shared_constants(archive);
  return load_map(archive, "m");
}

TEST(MapArchive, SavingWhatWasLoadedGivesTheSameBytes) {
  const Map map = full_map();
  const Bytes bytes = bytes_of(map);
  EXPECT_EQ(bytes_of(map_of(bytes)), bytes);
  EXPECT_EQ(bytes_of(map_of(bytes_of(Map()))), bytes_of(Map()));
}

TEST(MapArchive, ValuesComeBack) {
  const Map map = full_map();
  const Map back = map_of(bytes_of(map));
  EXPECT_EQ(back.version(), map.version());
  EXPECT_EQ(back.keyframes().size(), 2U);
  EXPECT_EQ(back.landmarks().size(), map.landmarks().size());
  EXPECT_EQ(*back.up_in_world(), *map.up_in_world());
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    const Keyframe* other = back.keyframes().find(id);
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(other->timestamp_s, keyframe.timestamp_s);
    EXPECT_EQ(other->landmarks, keyframe.landmarks);
    EXPECT_EQ(other->features->descriptors(), keyframe.features->descriptors());
    EXPECT_EQ(other->surface->samples[4].point, keyframe.surface->samples[4].point);
    EXPECT_EQ(other->tracked_link.has_value(), keyframe.tracked_link.has_value());
    // The grid that finds features by place is made anew.
    std::vector<int> there, here;
    keyframe.features->in_area(320, 240, 80, 0, 7, there);
    other->features->in_area(320, 240, 80, 0, 7, here);
    EXPECT_EQ(here, there);
    EXPECT_FALSE(here.empty());
  });
  EXPECT_EQ(back.class_names(), map.class_names());
  EXPECT_EQ(back.class_names().size(), 2U);
  const ClassGrid& classes = *map.keyframes().find(map.keyframes().at_index(2))->classes;
  const ClassGrid& same = *back.keyframes().find(back.keyframes().at_index(2))->classes;
  EXPECT_EQ(same.classes, classes.classes);
  EXPECT_EQ(same.which, classes.which);
  EXPECT_EQ(same.confidences, classes.confidences);
  EXPECT_EQ(same.instances, classes.instances);
  const PlaneId called = map.planes().at_index(1);
  EXPECT_EQ(back.planes().find(called)->class_votes, map.planes().find(called)->class_votes);
  const SurfacePatch* patch = back.patch(back.planes().find(called)->observations[0]);
  EXPECT_THAT(patch->class_votes, testing::SizeIs(1));
  EXPECT_EQ(back.covisible(back.keyframes().at_index(2), 1), map.covisible(map.keyframes().at_index(2), 1));
  ASSERT_EQ(back.structure().rooms.size(), 2U);
  EXPECT_EQ(back.structure().rooms[0].kind, RoomKind::corridor);
  EXPECT_EQ(back.structure().rooms[0].height_m, 2.5);
  ASSERT_EQ(back.markers().size(), 2U);
  const MappedMarker &marker = *back.markers().at({40}), &was = *map.markers().at({40});
  EXPECT_EQ(marker.size_m, was.size_m);
  EXPECT_EQ(marker.world_from_marker.matrix(), was.world_from_marker.matrix());
  ASSERT_EQ(marker.observations.size(), 1U);
  EXPECT_EQ(marker.observations[0].keyframe, was.observations[0].keyframe);
  EXPECT_EQ(marker.observations[0].covariance, was.observations[0].covariance);
}

TEST(MapArchive, IdsGoOnWhereTheyWere) {
  const Map map = full_map();
  const Map back = map_of(bytes_of(map));
  EXPECT_EQ(back.keyframes().next_id(), map.keyframes().next_id());
  EXPECT_EQ(back.landmarks().next_id(), map.landmarks().next_id());
  EXPECT_EQ(back.planes().next_id(), map.planes().next_id());
  for (std::uint32_t i = 0; i < map.landmarks().index_bound(); ++i)
    EXPECT_EQ(back.landmarks().resolve({i, 0}), map.landmarks().resolve({i, 0})) << i;
  const AnchoredPose on_retired{{0, 0}, test::standing_at(1)};
  EXPECT_EQ(back.resolve(on_retired)->matrix(), map.resolve(on_retired)->matrix());
}

TEST(MapArchive, ALoadedMapIsEditedWithoutTouchingItsCopies) {
  const auto loaded = std::make_shared<const Map>(map_of(bytes_of(full_map())));
  const Bytes before = bytes_of(*loaded);
  Draft draft(loaded);
  draft.add(Landmark{});
  draft.record(MoveKeyframe{loaded->keyframes().at_index(2), test::standing_at(9)});
  EXPECT_EQ(bytes_of(*loaded), before);
}

TEST(MapArchive, ASharedGridIsStoredOnce) {
  Map map = full_map();
  const std::size_t once = bytes_of(map).size();
  const Keyframe& first = *map.keyframes().find(map.keyframes().at_index(2));
  Keyframe again = first;
  again.landmarks.clear();
  again.tracked_link.reset();
  again.odometry.reset();
  test::add_keyframe(map, again);
  const std::size_t features = static_cast<std::size_t>(first.features->size());
  EXPECT_LT(bytes_of(map).size() - once, 400 + 8 * features);  // its pose and its landmarks alone
}

// As maps have it that were opened beside others: their ids begin behind those of the others.
TEST(MapArchive, ATableThatStartsLateComesBack) {
  using Numbers = Table<KeyframeId, int, 4>;
  Numbers table;
  table.start_at(40);
  table.insert_at(table.next_id(), 1);
  table.insert_at(table.next_id(), 2);
  table.erase({40, 0}, {41, 0});
  table.start_at(64);
  ArchiveWriter archive(kind);
  archive.add("table", table);
  const Bytes bytes = test::joined(archive.finish());
  EXPECT_LT(bytes.size(), 300U);  // nothing for what was passed over
  Numbers back;
  ArchiveReader("FILE", bytes, kind).read("table", back);
  EXPECT_EQ(back.index_bound(), 64U);
  EXPECT_EQ(back.size(), 1U);
  EXPECT_EQ(*back.find({41, 0}), 2);
  EXPECT_EQ(back.resolve({40, 0}), (KeyframeId{41, 0}));
  EXPECT_EQ(back.find({3, 0}), nullptr);
  EXPECT_EQ(back.next_id(), table.next_id());
  back.insert_at(back.next_id(), 5);
  EXPECT_EQ(back.next_id(), (KeyframeId{64, 0}));
}

// The content is forged under right checksums: the result is a map that can be walked through, or InputError.
TEST(MapArchive, ForgedSectionsAreErrorsOrMaps) {
  const Bytes whole = bytes_of(full_map());
  const ArchiveReader original("FILE", whole, kind);
  Rng rng(3, "map_archive_test", 0);
  int errors = 0, maps = 0;
  for (int round = 0; round < 1500; ++round) {
    const auto chosen = rng.index(static_cast<std::uint32_t>(original.names().size()));
    ArchiveWriter forged(kind);
    for (const std::string& name : original.names()) {
      Bytes bytes(original.section(name).begin(), original.section(name).end());
      if (name == original.names()[chosen] && !bytes.empty()) {
        // Small numbers, for those are what lengths, ids and flags are.
        bytes[rng.index(static_cast<std::uint32_t>(bytes.size()))] =
            static_cast<std::byte>(rng.index(2) ? rng.index(8) : rng.next());
      }
      forged.add_bytes(name, std::move(bytes));
    }
    const Bytes bytes = test::joined(forged.finish());
    try {
      const Map map = map_of(bytes);
      map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { map.covisible(id, 1); });
      for (std::uint32_t i = 0; i < map.keyframes().index_bound(); ++i) map.resolve({{i, 0}, Se3{}});
      map.planes().for_each([&](PlaneId, const MappedPlane& plane) { map.observed_centre(plane); });
      for (const auto& [id, marker] : map.markers()) map.sightings(*marker);
      bytes_of(map);
      ++maps;
    } catch (const InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 100);
  EXPECT_GT(maps, 100);
}

TEST(MapArchive, AFeatureAtNextToNoDistanceIsNone) {
  Map map = full_map();
  Keyframe keyframe = *map.keyframes().find(map.keyframes().at_index(2));
  keyframe = test::with_features_changed(keyframe, Camera{}, [](std::vector<Feature>& features) {
    features[0].depth_m = std::numeric_limits<float>::denorm_min();
  });
  test::add_keyframe(map, keyframe);
  EXPECT_THROW(map_of(bytes_of(map)), InputError);
}

}  // namespace
}  // namespace vsgraphs
