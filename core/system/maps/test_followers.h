// For tests: is what follows a map what would be gathered from the map as it is now?
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/scene/space/space_keeper.h"
#include "core/scene/space/test_kept_space.h"
#include "core/scene/surfaces/surface_keeper.h"
#include "core/system/maps/atlas_state.h"
#include "core/system/maps/followers.h"

namespace vsgraphs::test {

inline void expect_like(const PlaceKeeper& followed, const PlaceKeeper& gathered) {
  EXPECT_EQ(followed.places()->keyframes(), gathered.places()->keyframes());
}

// Of the places of the plane where one's rays tell of a surface or a hole, the share where the other's do not say the opposite.
inline double share_agreed(const KnownSurface& a, const KnownSurface& b) {
  int told = 0, denied = 0;
  const PlaneEvidence &mine = a.evidence(), &others = b.evidence();
  for (int s = mine.cells().min_s(); s < mine.cells().end_s(); ++s) {
    for (int t = mine.cells().min_t(); t < mine.cells().end_t(); ++t) {
      const bool solid = mine.solid({s, t});
      if (!solid && !mine.open({s, t})) continue;
      const Eigen::Vector3d middle =
          mine.frame().point((s + 0.5) * PlaneEvidence::cell_m, (t + 0.5) * PlaneEvidence::cell_m);
      const Eigen::Vector2d there = others.frame().coordinates(middle);
      const Cell cell = cell_at(there.x(), there.y(), PlaneEvidence::cell_m);
      ++told;
      denied += solid ? others.open(cell) : others.solid(cell);
    }
  }
  return told ? 1 - static_cast<double>(denied) / told : 1;
}

inline void expect_like(const SurfaceKeeper& followed, const SurfaceKeeper& gathered, const Map& map) {
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    if (plane.observations.empty()) return;
    const KnownSurface *known = followed.find(id), *right = gathered.find(id);
    ASSERT_TRUE(known && right) << "plane " << id.index;
    EXPECT_EQ(known->keyframes(), right->keyframes());
    EXPECT_GT(right->extent().share_near(known->extent().points(), 0.15), 0.95);
    EXPECT_GT(known->extent().share_near(right->extent().points(), 0.15), 0.95);
    EXPECT_GT(share_agreed(*known, *right), 0.95);
    EXPECT_GT(share_agreed(*right, *known), 0.95);
    ASSERT_EQ(known->class_votes().size(), right->class_votes().size());
    for (std::size_t i = 0; i < known->class_votes().size(); ++i) {
      EXPECT_EQ(known->class_votes()[i].id, right->class_votes()[i].id);
      EXPECT_NEAR(static_cast<double>(known->class_votes()[i].weight),
                  static_cast<double>(right->class_votes()[i].weight), 1e-2);
    }
    for (std::size_t r = 0; r < surface_role_count; ++r)
      EXPECT_NEAR(static_cast<double>(known->votes()[r]), static_cast<double>(right->votes()[r]), 1e-2);
  });
}

// What culled keyframes have carved stays, and cannot be gathered.
inline void expect_like(const SpaceKeeper& followed, const SpaceKeeper& gathered) {
  EXPECT_GT(share_near(gathered.voxels(), followed.voxels()), 0.97);
}

inline void expect_followers_like_gathered(const MapState& state, const Config& config,
                                           const Camera& camera) {
  SCOPED_TRACE("map of " + std::to_string(state.map->keyframes().size()) + " keyframes");
  Followers anew = make_followers(config, camera), followed = state.followers.copy();
  const Followers::Guard run = [](const char*, const std::function<void()>& work) { return work(), true; };
  anew.start(*state.map, {});
  for (Followers* followers : {&anew, &followed}) followers->catch_up(*state.map, true, run);
  ASSERT_EQ(followed.all().size(), anew.all().size()) << "all that the run keeps, whenever it is asked";
  expect_like(*followed.find<PlaceKeeper>(), *anew.find<PlaceKeeper>());
  if (const auto* surfaces = followed.find<SurfaceKeeper>())
    expect_like(*surfaces, *anew.find<SurfaceKeeper>(), *state.map);
  if (const auto* space = followed.find<SpaceKeeper>()) expect_like(*space, *anew.find<SpaceKeeper>());
}

}  // namespace vsgraphs::test
