#include "core/map/map_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/map/draft.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

constexpr ArchiveKind kind{"TEST_MAP", 1, "map"};

std::shared_ptr<const DepthGrid> some_grid(float depth_m) {
  DepthGrid grid;
  grid.columns = 3;
  grid.rows = 2;
  for (int i = 0; i < 6; ++i)
    grid.samples.push_back({{0.1F * static_cast<float>(i), 0, depth_m}, -Eigen::Vector3f::UnitZ()});
  return std::make_shared<const DepthGrid>(std::move(grid));
}

std::shared_ptr<const KeyframeSurfaces> some_patches(int count) {
  KeyframeSurfaces surfaces;
  for (int i = 0; i < count; ++i) {
    SurfacePatch patch;
    patch.plane = {-Eigen::Vector3d::UnitZ(), {0, 0, 2.0 + i}, 0.001 * i};
    patch.information = Eigen::Vector3d(10, 20, 30).asDiagonal();
    patch.points = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    patch.samples = 40;
    patch.area_m2 = 0.5F;
    patch.votes[1] = 0.25F;
    surfaces.patches.push_back(patch);
  }
  surfaces.labelled = true;
  return std::make_shared<const KeyframeSurfaces>(std::move(surfaces));
}

FoundStructure some_structure(PlaneId wall, PlaneId ground) {
  FoundStructure structure;
  structure.sought = true;
  FoundRoom room;
  room.number = 4;
  room.walls = {wall};
  room.ground = ground;
  room.polygon = {{0, 0}, {3, 0}, {3, 2}};
  room.height_m = 2.5;
  room.kind = RoomKind::corridor;
  room.neighbours = {7};
  structure.rooms = {room};
  FoundDoor door;
  door.width_m = 0.9;
  door.rooms = {4, 7};
  structure.doors = {door};
  FoundFloor floor;
  floor.rooms = {4};
  floor.grounds = {ground};
  floor.extent = {room.polygon};
  structure.floors = {floor};
  structure.places = {{{1, 1, 0}, 0.6, 4, {1}}, {{2, 1, 0}, 0.5, no_room, {0}}};
  structure.next_number = 8;
  structure.level_from_world = Se3::exp((Vector6d() << 1, 2, 3, 0.1, 0.2, 0.3).finished());
  structure.room_nodes = {{1, 1, 1}};
  structure.floor_nodes = {{1, 1, 0}};
  return structure;
}

void add_points(Map& map) {
  const Camera camera;
  const auto points = test::point_grid(6, 4);
  std::vector<KeyframeId> keyframes;
  for (int i = 0; i < 4; ++i) {
    Keyframe keyframe = test::keyframe_seeing(camera, test::standing_at(0.1 * i), points);
    keyframe.frame_index = 10 * i;
    keyframe.timestamp_s = 0.1 * i;
    keyframe.surface = some_grid(2.0F + 0.1F * static_cast<float>(i));
    if (i == 2)
      keyframe.tracked_link = TrackedLink{keyframes[0], test::standing_at(0.2), Matrix6d::Identity()};
    keyframes.push_back(test::add_keyframe(map, keyframe));
    map.apply(SetPatches{keyframes.back(), some_patches(3)});
  }
  const auto landmarks = test::add_landmarks(map, points, {keyframes[0], keyframes[1], keyframes[2]});
  const auto twin = test::add_landmark(map, points[0], 0, {{keyframes[3], 0}});
  map.apply(MergeLandmark{twin, landmarks[0]});
  for (const int gone : {5, 3, 4}) map.apply(RemoveLandmark{landmarks[static_cast<std::size_t>(gone)]});
  test::add_landmark(map, points[5], 5, {{keyframes[3], 5}});  // where a landmark was
  map.apply(CountSightings{landmarks[1], 5, 3});
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  map.apply(RemoveKeyframe{keyframes[0], keyframes[2]});  // the first one's anchor goes too
}

void add_planes(Map& map) {
  const auto keyframe = map.keyframes().at_index(2);
  const auto retired = map.retired_keyframes().at_index(0);
  std::vector<PlaneId> planes;
  for (std::uint16_t i = 0; i < 3; ++i) {
    MappedPlane plane;
    plane.role = i == 0 ? SurfaceRole::ground : SurfaceRole::wall;
    plane.votes[1] = 0.5F;
    planes.push_back(map.planes().next_id());
    map.apply(AddPlane{planes.back(), plane});
    map.apply(AddPlaneObservation{planes.back(), {keyframe, i}});
    map.apply(AddPlaneObservation{planes.back(), {retired, i}});
  }
  MappedPlane doubled;
  const PlaneId twin = map.planes().next_id();
  map.apply(AddPlane{twin, doubled});
  map.apply(MergePlane{twin, planes[1]});
  map.apply(PairFaces{planes[1], planes[2], 0.12});
  map.apply(SetUp{{0, -1, 0.1}});
  map.apply(SetStructure{std::make_shared<const FoundStructure>(some_structure(planes[1], planes[0]))});
  map.apply(MapEdit{});
}

void add_markers(Map& map) {
  const auto keyframe = map.keyframes().at_index(2);
  for (const std::uint32_t number : {3U, 40U}) {
    const MarkerId id{number};
    map.apply(AddMarker{id, {0.01 * number, test::standing_at(number), {}}});
    map.apply(AddMarkerObservation{id, {keyframe, test::standing_at(1), 0.5 * Matrix6d::Identity()}});
  }
}

// With everything a map can hold.
Map full_map() {
  Map map;
  add_points(map);
  add_planes(map);
  add_markers(map);
  return map;
}

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
  EXPECT_EQ(back.covisible(back.keyframes().at_index(2), 1), map.covisible(map.keyframes().at_index(2), 1));
  ASSERT_EQ(back.structure().rooms.size(), 1U);
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

}  // namespace
}  // namespace vsgraphs
