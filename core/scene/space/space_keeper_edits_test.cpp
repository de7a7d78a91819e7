// Any edits in any order: what is kept is what would be found by carving everything where it stands.
#include <gtest/gtest.h>

#include "core/scene/space/test_kept_space.h"

namespace vsgraphs {
namespace {

using test::difference;
using test::KeptMap;
using test::share_near;

class RandomEdits {
 public:
  explicit RandomEdits(std::uint64_t seed) : rng_(seed, "space_keeper_edits", 0) {}

  // `bends`: single keyframes move against their stretch too; `moves`: stretches move.
  void run(int steps, bool bends, bool moves) {
    kept_.up();
    for (int step = 0; step < steps; ++step) {
      const std::uint32_t kind = rng_.index(12);
      if (kind < 6) walk_on(kept_);
      if (kind == 6 && bends) bend();
      if (kind == 7 && moves) kept_.move_stretch(any_stretch(), correction());
      if (kind == 8) remove(false);
      if (kind == 9) remove(true);
      if (kind == 10) absorb(moves ? correction() : Se3{});
      if (kind == 11) switch_over(moves);
      if (rng_.index(3) == 0) kept_.catch_up(false);
    }
    kept_.catch_up(true);
  }
  const KeptMap& kept() const { return kept_; }

 private:
  void walk_on(KeptMap& kept) {
    for (int i = 0; i < 4 && next_ < walk_.poses().size(); ++i, ++next_) {
      const KeyframeId stretch = next_ % 10 == 0 ? KeyframeId{} : stretch_;
      const KeyframeId id = kept.add(test::beside_voxels() * walk_.poses()[next_].level_from_camera,
                                     walk_.depths()[next_], stretch);
      stretch_ = kept.map.stretch_of(id);
    }
    kept.keeper->catch_up(kept.map, false);  // so that what is removed later was carved
  }
  KeyframeId any_keyframe() {
    const std::uint32_t bound = kept_.map.keyframes().index_bound();
    return bound == 0 ? KeyframeId{} : kept_.map.keyframes().at_index(rng_.index(bound));
  }
  KeyframeId any_stretch() { return kept_.map.stretch_of(any_keyframe()); }
  Se3 correction() {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = rng_.uniform(-1, 1) * (i < 3 ? 0.3 : 0.03);
    return Se3::exp(xi);
  }
  void bend() {
    const KeyframeId id = any_keyframe();
    if (!id.valid()) return;
    kept_.edit({MoveKeyframe{id, kept_.map.keyframes().find(id)->world_from_camera *
                                     Se3::exp((Vector6d() << 0.05, 0, 0, 0, 0.01, 0).finished())}});
  }
  void remove(bool replaced) {
    const KeyframeId id = any_keyframe(), anchor = any_keyframe();
    if (!id.valid() || !anchor.valid() || id == anchor ||
        kept_.map.stretch_of(id) != kept_.map.stretch_of(anchor))
      return;
    kept_.edit({RemoveKeyframe{id, anchor, replaced}});
  }
  // Another map is begun, walked in and taken in.
  void absorb(const Se3& world_from_other) {
    KeptMap other;
    other.edit({OpenMap{kept_.map.unused_ids(), 0}});
    other.up();
    stretch_ = {};
    walk_on(other);
    if (other.map.keyframes().size() == 0) return;
    for (const auto& [id, depth] : other.depths) kept_.depths[id] = depth;
    kept_.edit({AbsorbMap{other.map.snapshot(), world_from_other}}, other.keeper.get());
  }
  // Sleeps as a copy, and wakes in an archive's stead as another; or sees another way up.
  void switch_over(bool moves) {
    kept_.keeper = std::dynamic_pointer_cast<SpaceKeeper>(kept_.keeper->copy());
    if (moves)
      kept_.edit({vsgraphs::SetUp{
          Eigen::Vector3d(rng_.uniform(-0.01, 0.01), rng_.uniform(-0.01, 0.01), 1).normalized()}});
  }

  Rng rng_;
  test::TestWalk walk_ = test::walk_two_rooms(test::two_rooms());
  KeptMap kept_;
  std::size_t next_ = 0;
  KeyframeId stretch_;
};

TEST(SpaceKeeperEdits, WhereNoStretchMovesVoxelsAreThoseOfOneGrid) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    RandomEdits edits(seed);
    edits.run(60, false, false);
    EXPECT_GT(edits.kept().keeper->parts().size(), 1U);
    EXPECT_EQ(difference(edits.kept().keeper->voxels(), edits.kept().anew().voxels()), 0U) << seed;
  }
}

TEST(SpaceKeeperEdits, WhereStretchesMoveSurfacesAreWhereTheyWouldBeCarved) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    RandomEdits edits(100 + seed);
    edits.run(60, true, true);
    const VoxelBlocks anew = edits.kept().anew().voxels();
    EXPECT_GT(share_near(anew, edits.kept().keeper->voxels()), 0.98) << seed;
    EXPECT_GT(share_near(edits.kept().keeper->voxels(), anew), 0.98) << seed;
  }
}

}  // namespace
}  // namespace vsgraphs
