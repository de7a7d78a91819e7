#include "core/vision/place_keeper.h"

#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

class FollowedPlaces {
 public:
  Map map;
  PlaceKeeper keeper;

  void apply(std::vector<EditOperation> operations, const PlaceKeeper* absorbed = nullptr) {
    const MapEdit edit{map.version(), std::move(operations)};
    const Snapshot before = map.snapshot();
    map.apply(edit);
    keeper.follow(*before, edit, map, absorbed);
  }
  void add() {
    const KeyframeId id = map.keyframes().next_id();
    apply({AddKeyframe{
        id, keyframe_seeing(Camera{}, standing_at(0), point_grid(6, 5), static_cast<int>(30 * id.index))}});
    living.push_back(id);
  }
  void remove(std::size_t number) {
    if (living.size() < 2) return;
    const KeyframeId id = living[number % living.size()];
    std::erase(living, id);
    apply({RemoveKeyframe{id, living.front()}});
  }
  // Holds each living keyframe, and finds it by its own look.
  void expect_complete() const {
    EXPECT_EQ(keeper.places()->keyframes(), living_in_order());
    for (const KeyframeId id : living) {
      const auto found = keeper.places()->query(*map.keyframes().find(id)->features, 1);
      ASSERT_FALSE(found.empty());
      EXPECT_EQ(found[0].keyframe, id);
    }
    EXPECT_EQ(keeper.wrong_with(map), nullptr);
  }
  std::vector<KeyframeId> living;

 private:
  std::vector<KeyframeId> living_in_order() const {
    std::vector<KeyframeId> ids;
    map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
    return ids;
  }
};

TEST(PlaceKeeper, HoldsTheLivingKeyframesWhateverIsDone) {
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    Rng rng(seed, "place_keeper", 0);
    FollowedPlaces followed, other;
    other.apply({OpenMap{{64, 64, 64}, 0}});
    for (int i = 0; i < 30; ++i) {
      FollowedPlaces& one = rng.uniform() < 0.4 + 0.1 * static_cast<double>(seed % 3) ? followed : other;
      if (rng.uniform() < 0.7)
        one.add();
      else
        one.remove(rng.index(30));
    }
    followed.expect_complete();
    followed.apply({AbsorbMap{std::make_shared<const Map>(other.map), standing_at(3)}}, &other.keeper);
    followed.living.insert(followed.living.end(), other.living.begin(), other.living.end());
    followed.expect_complete();
    PlaceKeeper anew;
    anew.gather(followed.map);
    EXPECT_EQ(anew.places()->keyframes(), followed.keeper.places()->keyframes());
  }
}

TEST(PlaceKeeper, WhoeverKeepsAnIndexKeepsItAsItWas) {
  FollowedPlaces followed;
  followed.add();
  const auto kept = followed.keeper.places();
  followed.add();
  EXPECT_EQ(kept->size(), 1);
  followed.apply({});
  const auto same = followed.keeper.places();
  followed.apply({MoveKeyframe{followed.living[0], standing_at(1)}});
  EXPECT_EQ(followed.keeper.places(), same) << "nothing to do";
}

}  // namespace
}  // namespace vsgraphs
