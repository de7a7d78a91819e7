// Whatever is done to a map, its surfaces are known as if they had been gathered from it as it is now.
#include "core/scene/surfaces/surface_keeper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/map/map_archive.h"
#include "core/map/stretch.h"
#include "core/map/test_map.h"
#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr ArchiveKind kind{"SURFACES", 5, "test"};
constexpr ClassId left_half{5}, right_half{9};

// A map whose planes are the walls y = 3 + 4 i, each by three ids that may be merged.
class FollowedMap {
 public:
  explicit FollowedMap(std::uint64_t seed) : rng_(seed, "followed_map", 0) {
    map.apply(NameClasses{{{left_half, "left"}, {right_half, "right"}}});
  }

  Map map;
  SurfaceKeeper keeper;

  void apply(std::vector<EditOperation> operations, const SurfaceKeeper* absorbed = nullptr) {
    const MapEdit edit{map.version(), std::move(operations)};
    const Snapshot before = map.snapshot();
    map.apply(edit);
    keeper.follow(*before, edit, map, absorbed);
  }

  void add_keyframe() {
    const int wall = static_cast<int>(rng_.uniform(0, 3));
    const double x = rng_.uniform(-2, 2), y = 3 + 4 * wall;
    Keyframe keyframe =
        keyframe_seeing(camera_, looking({x, y - rng_.uniform(1, 2.5), 1.4}, {x, y, 1.2}), {});
    if (!living_.empty() && rng_.uniform(0, 1) < 0.7) keyframe.stretch = map.stretch_of(living_.back());
    const KeyframeId id = map.keyframes().next_id();
    apply({AddKeyframe{id, keyframe}});
    living_.push_back(id);
    look(id, wall);
  }

  // Two pieces of the wall, on a plane each.
  void look(KeyframeId id, int wall) {
    const Se3 camera_from_world = map.keyframes().find(id)->world_from_camera.inverse();
    KeyframeSurfaces surfaces;
    for (const double s : {-1.0, 1.0}) {
      SurfacePatch patch;
      const Eigen::Vector3d middle(s + rng_.uniform(-0.5, 0.5), 3 + 4 * wall, 1.2);
      patch.plane = plane_at(middle, -Eigen::Vector3d::UnitY()).transformed(camera_from_world);
      patch.area_m2 = static_cast<float>(rng_.uniform(0.2, 1));
      patch.votes[1] = static_cast<float>(rng_.uniform(0, 1));
      // What one half of the walls is called goes with the role's votes, so that they can be compared.
      patch.class_votes = {{s < 0 ? left_half : right_half, patch.votes[1]}};
      for (double a = -0.6; a <= 0.6; a += 0.05)
        for (double b = -0.6; b <= 0.6; b += 0.05)
          patch.points.push_back((camera_from_world * (middle + Eigen::Vector3d(a, 0, b))).cast<float>());
      surfaces.patches.push_back(std::move(patch));
    }
    std::vector<EditOperation> operations{SetPatches{id, std::make_shared<const KeyframeSurfaces>(surfaces)}};
    for (std::uint16_t i = 0; i < 2; ++i)
      operations.push_back(
          AddPlaneObservation{plane_of(3 * wall + static_cast<int>(rng_.uniform(0, 3))), {id, i}});
    apply(std::move(operations));
  }

  // As a loop does it: a stretch as a whole.
  void move_stretch() {
    const KeyframeId stretch = map.stretch_of(any());
    const Se3 change = Se3::exp(small_twist(0.5, 0.1));
    std::vector<EditOperation> operations;
    map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
      if (keyframe.stretch == stretch)
        operations.push_back(MoveKeyframe{id, change * keyframe.world_from_camera});
    });
    apply(std::move(operations));
  }
  void move_keyframe() {
    const KeyframeId id = any();
    apply({MoveKeyframe{id, Se3::exp(small_twist(0.3, 0.05)) * map.keyframes().find(id)->world_from_camera}});
  }
  void remove_keyframe() {
    if (living_.size() < 3) return;
    const KeyframeId id = any(), anchor = any();
    if (id == anchor || map.stretch_of(id) != map.stretch_of(anchor)) return;
    std::erase(living_, id);
    apply({RemoveKeyframe{id, anchor}});
  }
  void remove_observation() {
    const auto at = static_cast<std::uint32_t>(rng_.uniform(0, 9));
    const MappedPlane* plane = map.planes().find(map.planes().at_index(at));
    if (plane && !plane->observations.empty())
      apply({RemovePlaneObservation{map.planes().at_index(at), plane->observations.front()}});
  }
  void merge() {
    const int wall = static_cast<int>(rng_.uniform(0, 3));
    const PlaneId first = plane_of(3 * wall), second = plane_of(3 * wall + 1), third = plane_of(3 * wall + 2);
    if (rng_.uniform() < 0.5)
      apply({MergePlane{first, second}});
    else
      apply({MergePlane{first, second}, MergePlane{second, third}});
  }
  void remove_plane() { apply({RemovePlane{plane_of(static_cast<int>(rng_.uniform(0, 9)))}}); }
  void forget_patches() { apply({SetPatches{any(), nullptr}}); }
  void do_something() {
    static constexpr void (FollowedMap::* edits[])() = {
        &FollowedMap::add_keyframe,    &FollowedMap::add_keyframe,       &FollowedMap::add_keyframe,
        &FollowedMap::move_stretch,    &FollowedMap::move_keyframe,      &FollowedMap::remove_keyframe,
        &FollowedMap::remove_keyframe, &FollowedMap::remove_observation, &FollowedMap::merge,
        &FollowedMap::remove_plane,    &FollowedMap::forget_patches};
    (this->*edits[living_.empty() ? 0 : static_cast<std::size_t>(rng_.uniform(0, std::size(edits)))])();
  }

  PlaneId plane_of(int number) {
    PlaneId& id = planes_[number];
    if (map.planes().contains(id)) return id;
    id = map.planes().next_id();
    MappedPlane plane;
    plane.plane = plane_at({0, 3.0 + 4 * (number / 3), 1.2}, -Eigen::Vector3d::UnitY());
    apply({AddPlane{id, plane}});
    return id;
  }

 private:
  KeyframeId any() {
    return living_[static_cast<std::size_t>(rng_.uniform(0, static_cast<double>(living_.size())))];
  }
  Vector6d small_twist(double most_m, double most_rad) {
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = rng_.uniform(-1, 1) * (i < 3 ? most_m : most_rad);
    return twist;
  }

  Rng rng_;
  Camera camera_;
  std::vector<KeyframeId> living_;
  std::map<int, PlaneId> planes_;
};

// Of one's points, the share that the other has near.
double share_found(const PlaneExtent& of, const PlaneExtent& in) { return in.share_near(of.points(), 0.15); }

double weight_of(const ClassVotes& votes, ClassId id) {
  const auto at = std::find_if(votes.begin(), votes.end(), [id](const ClassVote& v) { return v.id == id; });
  return at == votes.end() ? 0 : static_cast<double>(at->weight);
}

void expect_like_gathered(const FollowedMap& followed) {
  SurfaceKeeper anew;
  anew.gather(followed.map);
  followed.map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    const KnownSurface *known = followed.keeper.find(id), *right = anew.find(id);
    if (plane.observations.empty()) return;
    ASSERT_TRUE(known && right) << id.index;
    EXPECT_EQ(known->keyframes(), right->keyframes());
    EXPECT_NEAR(known->largest_patch_m2(), right->largest_patch_m2(), 1e-6);
    EXPECT_NEAR(static_cast<double>(known->votes()[1]), static_cast<double>(right->votes()[1]), 1e-3);
    for (const ClassId half : {left_half, right_half})
      EXPECT_NEAR(weight_of(known->class_votes(), half), weight_of(right->class_votes(), half), 5e-3);
    EXPECT_LT((known->mean_camera(followed.keeper.stretches()) - right->mean_camera(anew.stretches())).norm(),
              0.05);
    EXPECT_LT((known->mean_middle(followed.keeper.stretches()) - right->mean_middle(anew.stretches())).norm(),
              0.05);
    EXPECT_GT(share_found(known->extent(), right->extent()), 0.97);
    EXPECT_GT(share_found(right->extent(), known->extent()), 0.97);
    EXPECT_NEAR(known->extent().area_m2(), right->extent().area_m2(), 0.15 * right->extent().area_m2() + 0.1);
  });
  EXPECT_STREQ(followed.keeper.wrong_with(followed.map), nullptr);
}

class SurfaceKeeperRandomly : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(SurfaceKeeperRandomly, KnowsWhatAKeeperGatheredAnewWouldKnow) {
  FollowedMap followed(GetParam());
  for (int i = 0; i < 60; ++i) {
    followed.do_something();
    if (i % 10 == 9) expect_like_gathered(followed);
    if (i == 30) followed.keeper = *std::dynamic_pointer_cast<SurfaceKeeper>(followed.keeper.copy());
  }
  // Another map is taken in, and life goes on.
  FollowedMap other(GetParam() + 100);
  other.apply({OpenMap{followed.map.unused_ids(), 0}});
  for (int i = 0; i < 20; ++i) other.do_something();
  // As a join does it: in one edit, the doubled walls with it.
  Vector6d twist;
  twist << 0.03, -0.02, 0.01, 0.002, 0.01, 0.003;
  std::vector<EditOperation> merges;
  for (int wall = 0; wall < 3; ++wall)
    merges.push_back(MergePlane{other.plane_of(3 * wall), followed.plane_of(3 * wall)});
  merges.insert(merges.begin(), AbsorbMap{other.map.snapshot(), Se3::exp(twist)});
  followed.apply(std::move(merges), &other.keeper);
  expect_like_gathered(followed);
  for (int i = 0; i < 20; ++i) followed.do_something();
  expect_like_gathered(followed);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SurfaceKeeperRandomly, ::testing::Range<std::uint64_t>(1, 9));

// --- rays ---

class SurfaceKeeperRays : public ::testing::Test {
 protected:
  void apply(std::vector<EditOperation> operations) {
    const MapEdit edit{map_.version(), std::move(operations)};
    const Snapshot before = map_.snapshot();
    map_.apply(edit);
    keeper_.follow(*before, edit, map_, nullptr);
  }
  KeyframeId see(const Se3& pose, bool looks = true) {
    Keyframe keyframe = keyframe_seeing(camera_, pose, {});
    keyframe.surface = std::make_shared<const DepthGrid>(view(world_, pose, camera_));
    if (map_.keyframes().size() > 0) keyframe.stretch = KeyframeId{0, 0};
    const KeyframeId id = map_.keyframes().next_id();
    apply({AddKeyframe{id, keyframe}});
    if (looks) look(id, pose);
    return id;
  }
  void look(KeyframeId id, const Se3& pose) {
    SurfacePatch patch;
    patch.area_m2 = 1;
    if (map_.class_names().contains(class_id("picture"))) patch.class_votes = {{class_id("picture"), 0.5F}};
    patch.plane = plane_at({0, 3, 1}, -Eigen::Vector3d::UnitY()).transformed(pose.inverse());
    for (double s = -0.5; s <= 0.5; s += 0.05)
      for (double t = -0.5; t <= 0.5; t += 0.05)
        patch.points.push_back((pose.inverse() * Eigen::Vector3d(s, 3, 1 + t)).cast<float>());
    apply({SetPatches{id, std::make_shared<const KeyframeSurfaces>(KeyframeSurfaces{{patch}, false})},
           AddPlaneObservation{wall_, {id, 0}}});
  }
  void SetUp() override {
    apply({AddPlane{wall_, MappedPlane{plane_at({0, 3, 1}, -Eigen::Vector3d::UnitY()), {}, {}, {}, {}, 0}},
           vsgraphs::SetUp{Eigen::Vector3d::UnitZ()}});
  }

  Camera camera_;
  World world_ = World().sheet({-1, 3, 0}, {2, 0, 0}, {0, 0, 2}).sheet({-4, 6, 0}, {8, 0, 0}, {0, 0, 3});
  Map map_;
  SurfaceKeeper keeper_;
  PlaneId wall_{0, 0};
};

TEST_F(SurfaceKeeperRays, TellWhereTheWallIsAndWhereItEnds) {
  for (const double x : {-0.2, 0.0, 0.2}) see(looking({x, 0, 1}, {x, 3, 1}));
  const PlaneEvidence& evidence = keeper_.find(wall_)->evidence();
  EXPECT_TRUE(evidence.solid_at({0.5, 3, 1}));
  EXPECT_FALSE(evidence.solid_at({1.5, 3, 1}));
  const Eigen::Vector2d beside = evidence.frame().coordinates({1.15, 3, 1});
  EXPECT_TRUE(evidence.open(cell_at(beside.x(), beside.y(), PlaneEvidence::cell_m)));
}

TEST_F(SurfaceKeeperRays, AreCountedOnceHoweverOftenTheKeyframeIsLookedAt) {
  const Se3 pose = looking({0, 0, 1}, {0, 3, 1});
  see(looking({0.1, 0, 1}, {0.1, 3, 1}));
  const KeyframeId id = see(pose);
  const auto on = [&] {
    const Eigen::Vector2d c = keeper_.find(wall_)->evidence().frame().coordinates({0.42, 3, 1});
    return keeper_.find(wall_)->evidence().cells().at(cell_at(c.x(), c.y(), 0.1)).on;
  };
  const auto once = on();
  ASSERT_GT(once, 0);
  look(id, pose);
  EXPECT_EQ(on(), once);
}

TEST_F(SurfaceKeeperRays, ComeBackFromAnArchiveWithAllElse) {
  apply({NameClasses{{{class_id("picture"), "picture"}}}});
  for (const double x : {-0.2, 0.0, 0.2}) see(looking({x, 0, 1}, {x, 3, 1}));
  ArchiveWriter writer(kind);
  save_map(writer, "m", map_);
  keeper_.save(writer, "m/surfaces");
  const Bytes bytes = joined(writer.finish());
  ArchiveReader reader("FILE", bytes, kind);
  load_shared_constants(reader);
  const Map map = load_map(reader, "m");
  SurfaceKeeper back;
  back.load(reader, "m/surfaces");
  EXPECT_EQ(back.wrong_with(map), nullptr);
  const KnownSurface &known = *keeper_.find(wall_), &other = *back.find(wall_);
  EXPECT_EQ(other.extent().points(), known.extent().points());
  EXPECT_EQ(other.keyframes(), known.keyframes());
  ASSERT_EQ(known.class_votes().size(), 1U);
  EXPECT_EQ(other.class_votes(), known.class_votes());
  for (const double x : {-0.7, 0.5, 1.15})
    EXPECT_EQ(other.evidence().solid_at({x, 3, 1}), known.evidence().solid_at({x, 3, 1}));
  Map elsewhere;
  EXPECT_NE(back.wrong_with(elsewhere), nullptr);
}

TEST_F(SurfaceKeeperRays, ChangeWhatTheyMeetAndNothingElse) {
  see(looking({0, 0, 1}, {0, 3, 1}));
  EXPECT_TRUE(keeper_.changed().contains(wall_));
  apply({});  // what was made of it
  EXPECT_FALSE(keeper_.changed().contains(wall_));
  const auto look_elsewhere = [&](double x) {
    const KeyframeId id = see(looking({x, 0, 1}, {x, 3, 1}), false);
    apply({SetPatches{id, std::make_shared<const KeyframeSurfaces>()}});
  };
  look_elsewhere(40);
  EXPECT_FALSE(keeper_.changed().contains(wall_));
  apply({});
  look_elsewhere(0.5);
  EXPECT_TRUE(keeper_.changed().contains(wall_));
}

}  // namespace
}  // namespace vsgraphs
