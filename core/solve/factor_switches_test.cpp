// An off switch takes exactly its factors out of a window that has all kinds.
#include "core/solve/factor_switches.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <typeinfo>

#include "core/map/test_map.h"
#include "core/solve/factors/marker_pose.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/window.h"

namespace vsgraphs {
namespace {

using namespace test;

// A square room, its ground, a floor and a marker, all seen by five keyframes, the last of them tied to the one before.
class EveryKind : public ::testing::Test {
 protected:
  EveryKind() {
    const std::vector<AnchoredPlane> truths = {{-Eigen::Vector3d::UnitZ(), {0, 0, 3}, 0},
                                               {Eigen::Vector3d::UnitZ(), {0, 0, -3}, 0},
                                               {-Eigen::Vector3d::UnitX(), {2, 0, 2}, 0},
                                               {-Eigen::Vector3d::UnitY(), {0, 1.4, 2}, 0}};
    for (std::size_t i = 0; i < truths.size(); ++i) {
      MappedPlane plane;
      plane.plane = truths[i];
      plane.role = i == 3 ? SurfaceRole::ground : SurfaceRole::wall;
      planes.push_back(map.planes().next_id());
      map.apply(AddPlane{planes.back(), plane});
    }
    map.apply(vsgraphs::SetUp{{0, -1, 0}});
    map.apply(AddMarker{{7}, {0.16, standing_at(0, 0, 3), {}}});
    for (int k = 0; k < 5; ++k) add_keyframe_at(0.2 * k, truths);
    auto structure = std::make_shared<FoundStructure>();
    FoundRoom room;
    room.number = 0;
    room.walls = {planes[0], planes[1], planes[2]};
    room.ground = planes[3];
    structure->rooms = {room};
    FoundFloor floor;
    floor.rooms = {0};
    structure->floors = {floor};
    structure->room_nodes = structure->floor_nodes = {Eigen::Vector3d::Zero()};
    map.apply(SetStructure{structure});
  }
  void add_keyframe_at(double x, const std::vector<AnchoredPlane>& truths) {
    const Se3 pose = standing_at(x);
    Keyframe keyframe = keyframe_seeing(Camera{}, pose, {});
    if (!keyframes.empty())
      keyframe.tracked_link = TrackedLink{keyframes.back(), standing_at(0.2), Matrix6d::Identity()};
    keyframes.push_back(add_keyframe(map, keyframe));
    auto surfaces = std::make_shared<KeyframeSurfaces>();
    for (const AnchoredPlane& truth : truths) {
      SurfacePatch& patch = surfaces->patches.emplace_back();
      patch.plane = truth.transformed(pose.inverse());
      patch.information = 1e5 * Eigen::Matrix3d::Identity();
    }
    map.apply(SetPatches{keyframes.back(), surfaces});
    for (std::size_t i = 0; i < planes.size(); ++i)
      map.apply(AddPlaneObservation{planes[i], {keyframes.back(), static_cast<std::uint16_t>(i)}});
    map.apply(AddMarkerObservation{
        {7}, {keyframes.back(), pose.inverse() * standing_at(0, 0, 3), 1e-6 * Matrix6d::Identity()}});
  }
  // Kind of factor -> how many. A wall on its ground is told from two walls by its sigma's share.
  std::map<std::string, int> counted(const FactorSwitches& switches) const {
    MeasurementModel model;
    model.factors = switches;
    Window window;
    window.free = {keyframes[4], keyframes[3]};
    window.fixed = {keyframes[2]};
    const WindowProblem problem = build_problem(map, window, model);
    std::map<std::string, int> count;
    for (const auto& factor : problem.bundle.factors) {
      const DenseFactor& f = *factor;
      std::string kind = typeid(f).name();
      if (dynamic_cast<const PlanePerpendicular*>(factor.get())) {
        const auto on_ground = [&](VariableRef v) {
          return problem.plane_of_variable[static_cast<std::size_t>(v.index)] == planes[3];
        };
        kind += on_ground(f.variables()[0]) || on_ground(f.variables()[1]) ? " upright" : " of a room";
      }
      if (f.variables()[0].kind == VariableKind::marker) kind = typeid(MarkerPose).name();  // its priors
      ++count[kind];
    }
    return count;
  }

  Map map;
  std::vector<PlaneId> planes;
  std::vector<KeyframeId> keyframes;
};

// Sets one switch by its name, or lists the names.
struct Switch {
  std::string off;
  std::vector<std::string> names;
  void operator()(const char* name, bool& value, const char*) {
    names.emplace_back(name);
    if (off == name) value = false;
  }
};

TEST_F(EveryKind, AnOffSwitchRemovesExactlyItsFactors) {
  const std::map<std::string, int> all = counted({});
  Switch names;
  FactorSwitches fresh;
  describe(fresh, names);
  ASSERT_EQ(names.names.size(), 9U);
  std::set<std::string> removed_kinds;
  for (const std::string& name : names.names) {
    SCOPED_TRACE(name);
    FactorSwitches switches;
    Switch one{name, {}};
    describe(switches, one);
    std::map<std::string, int> left = counted(switches);
    std::vector<std::string> gone;
    for (const auto& [kind, count] : all) {
      if (!left.contains(kind)) {
        gone.push_back(kind);
      } else {
        EXPECT_EQ(left[kind], count) << kind;
      }
    }
    // A floor's node is the mean of its rooms': without theirs there is none.
    ASSERT_EQ(gone.size(), name == "room_centroid" ? 2U : 1U);
    for (const std::string& kind : gone) removed_kinds.insert(kind);
  }
  EXPECT_EQ(removed_kinds.size(), all.size()) << "each kind has a switch";
  EXPECT_EQ(all.size(), 9U);
}

TEST_F(EveryKind, NoFactorIsLeftWithAllOff) {
  FactorSwitches none;
  struct Off {
    void operator()(const char*, bool& value, const char*) { value = false; }
  } off;
  describe(none, off);
  EXPECT_TRUE(counted(none).empty());
}

}  // namespace
}  // namespace vsgraphs
