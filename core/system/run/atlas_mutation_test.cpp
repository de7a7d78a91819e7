// Atlases that were changed somewhere and given right checksums again: each is refused in one line, or a run can go on in it. For
// the sanitizers above all. VSGRAPHS_MUTATIONS=N in the environment tries N of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <optional>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/system/maps/atlas_file.h"
#include "core/system/maps/followers.h"
#include "core/system/run/slam.h"
#include "core/system/run/test_wall_scene.h"

namespace vsgraphs {
namespace {

using namespace test;

// Rooms, doors and places beside a wall that was mapped; a map of one wall has none by itself.
FoundStructure some_structure(PlaneId wall) {
  FoundStructure structure;
  structure.sought = true;
  for (RoomNumber number = 0; number < 2; ++number) {
    FoundRoom room;
    room.number = number;
    room.walls = {wall};
    room.polygon = {{2.0 * number, 0}, {2.0 * number + 2, 0}, {2.0 * number + 2, 3}};
    room.area_m2 = 3;
    room.height_m = 2.5;
    room.neighbours = {1 - number};
    structure.rooms.push_back(room);
    structure.room_nodes.emplace_back(2.0 * number, 0, 1);
  }
  FoundDoor door;
  door.width_m = 0.9;
  door.rooms = {0, 1};
  structure.doors = {door};
  FoundFloor floor;
  floor.rooms = {0, 1};
  floor.extent = {structure.rooms[0].polygon};
  structure.floors = {floor};
  structure.floor_nodes = {{1, 1, 0}};
  structure.places = {{{1, 1, 0}, 0.6, 0, {1}}, {{3, 1, 0}, 0.5, 1, {0}}};
  structure.next_number = 2;
  return structure;
}

// With all that an atlas can hold.
MapState furnished(const MapState& state) {
  Map map = *state.map;
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  map.apply(vsgraphs::SetUp{up});
  PlaneId wall;
  map.planes().for_each([&](PlaneId id, const MappedPlane&) { wall = id; });
  map.apply(ClassifyPlane{wall, SurfaceRole::wall, {}});
  map.apply(SetStructure{std::make_shared<const FoundStructure>(some_structure(wall))});
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) {
    map.apply(AddMarker{{7}, {0.2, Se3{}, {}}});
    map.apply(
        AddMarkerObservation{{7}, {id, {Eigen::Matrix3d::Identity(), {0, 0, wall_m}}, Matrix6d::Identity()}});
  });
  Followers followers = make_followers(Config{}, small_camera());
  followers.start(map, {});
  followers.catch_up(map, true, [](const char*, const auto& work) { return work(), true; });
  return {map.snapshot(), followers};
}

// With a segmenter that calls one half of each keyframe's image a picture and the other a wall.
void track_named(Slam& slam, const RgbdFrame& frame) {
  static const std::vector<std::string> names{"picture", "wall"};
  const TrackedFrame tracked = slam.track(frame);
  if (!tracked.keyframe_request) return;
  const Image<std::uint8_t> roles(width, height, 0);
  Image<std::uint16_t> classes(width, height, 1);
  for (int v = 0; v < height / 2; ++v)
    for (int u = 0; u < width; ++u) classes.at(u, v) = 2;
  slam.add_segmentation(tracked.index, {roles.view(), {}, classes.view(), classes.view(), names});
}

// Two maps: a walk along the wall, and one along another piece of it after a while in the dark.
SavedAtlas two_walks() {
  WallScene scene;
  Slam slam(configured("serial"), small_camera());
  for (int px = 0; px <= 160; px += 8) track_named(slam, scene.seen_from(px));
  for (int i = 0; i < 16; ++i) slam.track(scene.in_the_dark());
  for (int px = 520; px <= 640; px += 8) track_named(slam, scene.seen_from(px));
  slam.finish();
  SavedAtlas atlas;
  atlas.state = slam.atlas_state();
  atlas.state.maps.back() = furnished(atlas.state.maps.back());
  atlas.camera = small_camera();
  atlas.configuration = configuration_text(configured("serial"));
  atlas.program = "1.2.3";
  atlas.commit = "abc";
  atlas.map_names = {"here", "there"};
  return atlas;
}

template <typename Number>
void put(Bytes& bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, std::min(sizeof number, bytes.size() - at));
}

template <typename Number>
Number odd_number(Rng& rng) {
  using Limits = std::numeric_limits<Number>;
  const Number odd[] = {Limits::quiet_NaN(),  Limits::infinity(), Limits::max(), Limits::lowest(),
                        Limits::denorm_min(), Number(0),          Number(-1),    Number(1e6),
                        Number(-9e4),         Number(1e12)};
  return odd[rng.index(static_cast<std::uint32_t>(std::size(odd)))];
}

// A bit, a small or any number, or one that floats may be: somewhere, half of the time near the beginning, where lengths are.
void mutate(Bytes& bytes, Rng& rng) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const std::size_t at = rng.index(rng.index(2) ? size : std::min(size, 600U));
  switch (rng.index(5)) {
    case 0:
      bytes[at] ^= static_cast<std::byte>(1U << rng.index(8));
      break;
    case 1:
      put(bytes, at, static_cast<std::uint32_t>(rng.index(2) ? rng.index(40) : rng.next()));
      break;
    case 2:
      put(bytes, at / 8 * 8, odd_number<double>(rng));
      break;
    case 3:
      put(bytes, at, odd_number<double>(rng));
      break;
    default:
      put(bytes, at, odd_number<float>(rng));
  }
}

class AtlasMutations : public testing::Test {
 protected:
  // With one section changed, under right checksums.
  Bytes forged(Rng& rng) const {
    const auto names = original_.names();
    const std::string& chosen = names[rng.index(static_cast<std::uint32_t>(names.size()))];
    ArchiveWriter forged(atlas_kind);
    for (const std::string& name : names) {
      Bytes bytes(original_.section(name).begin(), original_.section(name).end());
      if (name == chosen && !bytes.empty()) mutate(bytes, rng);
      forged.add_bytes(name, std::move(bytes));
    }
    return joined(forged.finish());
  }

  // All that a run and those who look at its maps do.
  void go_on_in(const AtlasState& known) const {
    WallScene scene = scene_;
    Slam slam(configured("serial"), small_camera(), known);
    for (const int px : {560, 576, 592, 608}) slam.track(scene.seen_from(px));
    slam.track(scene.in_the_dark());
    slam.track(scene.seen_from(80));
    slam.finish();
    slam.trajectory();
    slam.statistics();
    for (const MapState& state : slam.atlas_state().maps) look_at(state);
  }

  static void look_at(const MapState& state) {
    const Map& map = *state.map;
    map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
      map.covisible(id, 1);
      map.room_at(keyframe.world_from_camera.translation());
      if (state.places()) state.places()->query(*keyframe.features, 5);
    });
    map.planes().for_each([&](PlaneId, const MappedPlane& plane) {
      map.observed_centre(plane);
      for (const ClassVote& vote : plane.class_votes) map.class_names().at(vote.id);
    });
    for (const auto& [id, marker] : map.markers()) map.sightings(*marker);
    count({state.map});
  }

  const WallScene scene_;
  const Bytes whole_ = [] {
    const SavedAtlas atlas = two_walks();
    ArchiveWriter archive(atlas_kind);
    write_atlas(archive, atlas);
    return joined(archive.finish());
  }();
  const ArchiveReader original_{"FILE", whole_, atlas_kind};
};

TEST_F(AtlasMutations, AreRefusedOrCanBeGoneOnIn) {
  const SavedAtlas untouched = read_atlas("FILE", whole_);
  ASSERT_EQ(untouched.state.maps.size(), 2U);
  for (const MapState& state : untouched.state.maps) ASSERT_EQ(state.map->class_names().size(), 2U);
  const char* wanted = std::getenv("VSGRAPHS_MUTATIONS");
#ifdef __SANITIZE_THREAD__
  constexpr int usual_rounds = 10;  // there is one thread here
#else
  constexpr int usual_rounds = 120;
#endif
  const int rounds = wanted ? std::atoi(wanted) : usual_rounds;
  int refused = 0, gone_on_in = 0;
  for (int round = 0; round < rounds; ++round) {
    Rng rng(4, "atlas_mutation_test", static_cast<std::uint64_t>(round));
    const Bytes bytes = forged(rng);
    std::optional<SavedAtlas> atlas;
    try {
      atlas = read_atlas("FILE", bytes);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("FILE: is damaged ("));
      ++refused;
      continue;
    }
    EXPECT_NO_THROW(go_on_in(atlas->state)) << "round " << round;
    ++gone_on_in;
  }
  std::printf("%d refused, %d gone on in\n", refused, gone_on_in);
  EXPECT_GT(refused, rounds / 5);
  EXPECT_GT(gone_on_in, rounds / 20);
}

}  // namespace
}  // namespace vsgraphs
