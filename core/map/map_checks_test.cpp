// Maps that cannot be. No edit makes such a map: they come from files that somebody changed.
#include "core/map/map_checks.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/map/test_full_map.h"

namespace vsgraphs {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Changes the part of a map that is of this type.
template <typename Part, typename Change>
void in(Map& map, Change&& change) {
  visit_tables(map, [&](const char*, auto& part, std::uint32_t = 1) {
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(part)>, Part>) change(part);
  });
}

class MapChecks : public testing::Test {
 protected:
  // What is wrong with the map once its part of this type has been changed.
  template <typename Part, typename Change>
  std::string after(Change&& change) const {
    Map changed = map_;
    in<Part>(changed, change);
    Wrong wrong = wrong_with_references(changed);
    if (!wrong) wrong = wrong_with_values(changed);
    return wrong ? wrong : "";
  }
  template <typename Change>
  std::string after_keyframe(Change&& change) const {
    return after<Map::Keyframes>([&](auto& table) { change(*table.edit(keyframe_)); });
  }
  template <typename Change>
  std::string after_landmark(Change&& change) const {
    return after<Map::Landmarks>([&](auto& table) { change(*table.edit(landmark_)); });
  }
  template <typename Change>
  std::string after_structure(Change&& change) const {
    return after<FoundStructure>(change);
  }

  const Map map_ = test::full_map();
  const KeyframeId keyframe_ = map_.keyframes().at_index(2), other_keyframe_ = map_.keyframes().at_index(3);
  const LandmarkId landmark_ = map_.keyframes().find(keyframe_)->landmarks[1];
};

TEST_F(MapChecks, AMapThatWasMadeByEditsPasses) {
  EXPECT_EQ(after<std::uint64_t>([](auto&) {}), "");
  const Map empty;
  EXPECT_EQ(wrong_with_references(empty), nullptr);
  EXPECT_EQ(wrong_with_values(empty), nullptr);
}

TEST_F(MapChecks, OdometryBeginsAtALivingKeyframeBefore) {
  const auto with_step = [this](const OdometryStep& step) {
    return after_keyframe([&step](Keyframe& keyframe) { keyframe.odometry = step; });
  };
  EXPECT_EQ(with_step({}), "") << "a gap";
  EXPECT_NE(with_step({map_.retired_keyframes().at_index(0), Se3{}}), "") << "it was culled";
  EXPECT_NE(with_step({other_keyframe_, Se3{}}), "") << "it came later";
  const auto of_other = [this](const OdometryStep& step) {
    return after<Map::Keyframes>([&](auto& table) { table.edit(other_keyframe_)->odometry = step; });
  };
  EXPECT_EQ(of_other({keyframe_, Se3{}, Matrix6d::Identity()}), "");
  EXPECT_NE(of_other({keyframe_, Se3{}, nan * Matrix6d::Identity()}), "");
  EXPECT_NE(of_other({keyframe_, Se3{}, -Matrix6d::Identity()}), "");
  EXPECT_NE(
      of_other({keyframe_, {2 * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()}, Matrix6d::Identity()}),
      "");
}

TEST_F(MapChecks, KeyframesAndLandmarksNameEachOther) {
  ASSERT_TRUE(landmark_.valid());
  const std::string unknown = "a keyframe that sees a landmark which does not exist";
  EXPECT_EQ(after_keyframe([](Keyframe& k) { k.landmarks[4] = {999, 0}; }), unknown);
  EXPECT_EQ(after_keyframe([&](Keyframe& k) { k.landmarks[4] = landmark_; }), unknown)
      << "which it does not know";
  EXPECT_EQ(after_keyframe([&](Keyframe& k) { k.landmarks[1] = {}; }), "a landmark seen by nothing");
  EXPECT_EQ(after_keyframe([](Keyframe& k) { k.landmarks.pop_back(); }),
            "a keyframe whose landmarks do not fit its features");
  EXPECT_EQ(after_landmark([](Landmark& l) { l.observations[0].feature = 60000; }),
            "a landmark seen by nothing");
  EXPECT_EQ(after_landmark([](Landmark& l) { l.observations[0].keyframe.generation = 5; }),
            "a landmark seen by nothing");
  EXPECT_EQ(after_landmark([](Landmark& l) { l.observations.push_back(l.observations[0]); }),
            "a landmark seen twice by one keyframe");
}

TEST_F(MapChecks, AnchorsAndLinksLeadToKeyframes) {
  EXPECT_EQ(after_keyframe([](Keyframe& k) { k.tracked_link->to = {77, 0}; }),
            "a keyframe linked with one that does not exist");
  const auto anchor = [this](KeyframeId id) {
    return after<Map::RetiredKeyframes>([id](auto& table) {
      if (table.find({0, 0})) table.edit({0, 0})->anchor = id;
    });
  };
  EXPECT_EQ(anchor(keyframe_), "");
  EXPECT_EQ(anchor({0, 0}), "a retired keyframe without a living anchor") << "but itself";
  EXPECT_EQ(anchor({1, 0}), "a retired keyframe without a living anchor") << "but one that hangs on it";
  EXPECT_EQ(anchor({99, 0}), "a retired keyframe without a living anchor");
}

TEST_F(MapChecks, PlanesAndMarkersAreSeenBySomething) {
  const auto plane = [this](auto change) {
    return after<Map::Planes>([&](auto& table) { change(*table.edit(table.at_index(1))); });
  };
  EXPECT_EQ(plane([](MappedPlane& p) { p.observations[0].patch = 99; }), "a plane seen where nothing was");
  EXPECT_EQ(plane([](MappedPlane& p) { p.observations[0].keyframe.index = 99; }),
            "a plane seen where nothing was");
  EXPECT_EQ(plane([](MappedPlane& p) { p.other_face = {99, 0}; }), "a wall whose other face is missing");
  EXPECT_EQ(plane([](MappedPlane& p) { p.other_face = {1, 0}; }), "a wall whose other face is missing")
      << "itself";
  const auto marker = [this](auto change) {
    return after<Markers>([&](Markers& markers) {
      MappedMarker changed = *markers.at({3});
      change(changed);
      markers.at({3}) = std::make_shared<const MappedMarker>(changed);
    });
  };
  EXPECT_EQ(marker([](MappedMarker& m) { m.observations[0].keyframe = {99, 0}; }),
            "a marker seen by nothing");
  EXPECT_EQ(marker([](MappedMarker& m) { m.size_m = nan; }), "a marker that is nowhere");
  EXPECT_EQ(marker([](MappedMarker& m) { m.observations[0].covariance(3, 4) = nan; }),
            "a marker that is nowhere");
}

TEST_F(MapChecks, ClassesHaveTheNamesOfTheirNumbers) {
  EXPECT_EQ(after<ClassNames>([](ClassNames& names) { names.erase(class_id("chair")); }),
            "a class without a name")
      << "of a keyframe's classes";
  EXPECT_EQ(after<ClassNames>([](ClassNames& names) { names.at(class_id("chair")) = "table"; }),
            "a class whose name is not its own");
  EXPECT_EQ(after<ClassNames>([](ClassNames& names) { names[class_id("\xff")] = "\xff"; }),
            "a class whose name is not its own");
  const auto called = [this](const ClassVotes& votes) {
    return after<Map::Planes>([&](auto& table) { table.edit(table.at_index(1))->class_votes = votes; });
  };
  EXPECT_EQ(called({{class_id("chair"), 1}}), "");
  EXPECT_EQ(called({{class_id("table"), 1}}), "a class without a name");
  EXPECT_EQ(called({{class_id("chair"), -1}}), "a plane that is nowhere");
  const auto seen = [this](const ClassVotes& votes) {
    return after_keyframe([&](Keyframe& keyframe) {
      KeyframeSurfaces surfaces = *keyframe.patches;
      surfaces.patches[0].class_votes = votes;
      keyframe.patches = std::make_shared<const KeyframeSurfaces>(surfaces);
    });
  };
  EXPECT_EQ(seen({{class_id("table"), 1}}), "a class without a name");
  EXPECT_EQ(seen({{class_id("chair"), std::numeric_limits<float>::infinity()}}),
            "a keyframe that is nowhere, or saw what cannot be");
}

TEST_F(MapChecks, RoomsDoorsFloorsAndPlacesNameWhatIsThere) {
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].walls[0] = {}; }), "a room without its walls");
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].ground = {99, 0}; }), "a room without its walls");
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].number = 7; }),
            "a room's number that was not given to it");
  EXPECT_EQ(after_structure([](auto& s) { s.next_number = 5; }), "a room's number that was not given to it");
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].neighbours = {5}; }),
            "a room beside one that does not exist");
  EXPECT_EQ(after_structure([](auto& s) { s.doors[0].rooms[1] = 5; }),
            "a door into a room that does not exist");
  EXPECT_EQ(after_structure([](auto& s) { s.doors[0].rooms[1] = no_room; }), "");
  EXPECT_EQ(after_structure([](auto& s) { s.floors[0].rooms = {5}; }),
            "a floor with a room that does not exist");
  EXPECT_EQ(after_structure([](auto& s) { s.floors[0].grounds = {{99, 0}}; }), "a floor without its ground");
  EXPECT_EQ(after_structure([](auto& s) { s.elements[0].planes = {{99, 0}}; }),
            "an element without its planes");
  EXPECT_EQ(after_structure([](auto& s) { s.elements[0].rooms = {5}; }),
            "an element in a room that does not exist");
  EXPECT_EQ(after_structure([](auto& s) { s.elements[0].number = 3; }),
            "an element's number that was not given to it");
  const std::string place = "a place beside one, or in a room, that does not exist";
  EXPECT_EQ(after_structure([](auto& s) { s.places[0].room = 5; }), place);
  EXPECT_EQ(after_structure([](auto& s) { s.places[0].neighbours = {2}; }), place);
  EXPECT_EQ(after_structure([](auto& s) { s.room_nodes.pop_back(); }), "rooms or floors that are nowhere");
  EXPECT_EQ(after_structure([](auto& s) { s.floor_nodes.clear(); }), "rooms or floors that are nowhere");
}

TEST_F(MapChecks, NumbersAreSomewhere) {
  const std::string keyframe = "a keyframe that is nowhere, or saw what cannot be";
  for (const double odd : {nan, std::numeric_limits<double>::infinity(), 1e300, -2e5}) {
    EXPECT_EQ(after_keyframe([&](Keyframe& k) { k.world_from_camera = test::standing_at(odd); }), keyframe);
    EXPECT_EQ(after_landmark([&](Landmark& l) { l.point_in_world.y() = 1e4 * odd; }),
              "a landmark that is nowhere");
    EXPECT_EQ(after_structure([&](auto& s) { s.rooms[0].polygon[1].x() = odd; }), "a room of no shape");
    EXPECT_EQ(after_structure([&](auto& s) { s.doors[0].position.x() = odd; }), "a door of no size");
    EXPECT_EQ(after_structure([&](auto& s) { s.places[0].position.x() = odd; }), "a place that is nowhere");
    EXPECT_EQ(after_structure([&](auto& s) { s.elements[0].size_m.x() = odd; }), "an element of no size");
    EXPECT_EQ(after_structure([&](auto& s) { s.room_nodes[0].x() = odd; }),
              "rooms or floors that are nowhere");
  }
  const Eigen::Matrix3d twice = 2 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(after_keyframe([&](Keyframe& k) { k.world_from_camera = {twice, {0, 0, 0}}; }), keyframe);
  EXPECT_EQ(after_keyframe([](Keyframe& k) { k.frame_index = std::numeric_limits<std::int64_t>::max(); }),
            keyframe);
  EXPECT_EQ(after_keyframe([](Keyframe& k) { k.timestamp_s = nan; }), keyframe);
  EXPECT_EQ(after_keyframe([](Keyframe& k) {
              DepthGrid grid = *k.surface;
              grid.samples[1].point.x() = 1e30F;
              k.surface = std::make_shared<const DepthGrid>(grid);
            }),
            keyframe);
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].polygon.clear(); }), "a room of no shape");
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].polygon[1].x() = 40000; }), "") << "a corridor";
  EXPECT_EQ(after_structure([](auto& s) { s.rooms[0].polygon = {{0, 0}, {2000, 0}, {2000, 2000}}; }),
            "a room of no shape");
  EXPECT_EQ(after<std::optional<Eigen::Vector3d>>([](auto& up) { up = Eigen::Vector3d(0, 0, 2); }),
            "an upward direction that is none");
}

}  // namespace
}  // namespace vsgraphs
