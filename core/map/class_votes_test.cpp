// A segmenter's own classes: their numbers, their votes, and what a map keeps of them.
#include "core/map/class_votes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/map_checks.h"
#include "core/map/test_full_map.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const ClassId wall = class_id("wall"), chair = class_id("chair"), table = class_id("table");

ClassVotes votes_of(std::initializer_list<ClassVote> given) {
  ClassVotes votes;
  for (const ClassVote& vote : given) add_votes(votes, {vote}, 1);
  return votes;
}

TEST(ClassVotes, AClassIsNumberedByItsName) {
  EXPECT_EQ(class_id("wall").hash, 0xa7262d15U) << "FNV-1a: the same in every session and build";
  EXPECT_EQ(class_id("costarring"), class_id("liquid")) << "it has 32 bits";
  EXPECT_FALSE(class_id("").none());
}

TEST(ClassVotes, AreAddedByClassAndTakenBackWithoutATrace) {
  ClassVotes sum = votes_of({{wall, 0.5F}, {chair, 0.25F}});
  EXPECT_TRUE(are_sane(sum)) << "in order, however they came";
  add_votes(sum, votes_of({{wall, 0.5F}, {table, 1}}), 0.5F);
  EXPECT_EQ(sum, votes_of({{chair, 0.25F}, {wall, 0.75F}, {table, 0.5F}}));
  add_votes(sum, votes_of({{wall, 0.5F}, {table, 1}}), -0.5F);
  add_votes(sum, votes_of({{wall, 0.5F}}), -1);
  EXPECT_EQ(sum, votes_of({{chair, 0.25F}}));
  add_votes(sum, votes_of({{table, 0.5F}}), -1);
  EXPECT_EQ(sum, votes_of({{chair, 0.25F}})) << "nothing is less than not named";
}

TEST(ClassVotes, OutOfOrderOrWithoutNameAreNone) {
  EXPECT_FALSE(are_sane({{{2}, 1}, {{1}, 1}}));
  EXPECT_FALSE(are_sane({{{2}, 1}, {{2}, 1}}));
  EXPECT_FALSE(are_sane({{{2}, -1}}));
  EXPECT_FALSE(are_sane({{{2}, std::numeric_limits<float>::quiet_NaN()}}));
  EXPECT_FALSE(are_sane({{{0}, 1}}));
  EXPECT_TRUE(are_named({{wall, 1}}, {{wall, "wall"}}));
  EXPECT_FALSE(are_named({{wall, 1}, {chair, 1}}, {{wall, "wall"}}));
}

LabelGrid labels() {
  LabelGrid grid;
  grid.columns = 3;
  grid.rows = 1;
  grid.samples = {{SurfaceRole::wall, 1, 0, wall}, {}, {SurfaceRole::other, 0.5F, 7, chair}};
  grid.class_names = {{wall, "wall"}, {chair, "chair"}};
  return grid;
}

TEST(ClassGrid, KeepsClassConfidenceAndInstanceOfEverySample) {
  const auto grid = classes_of(labels());
  ASSERT_NE(grid, nullptr);
  EXPECT_TRUE(fits_together(*grid));
  ASSERT_EQ(grid->classes.size(), 2U);
  const auto named = [&](std::size_t i) {
    return grid->which[i] ? grid->classes[grid->which[i] - 1U] : ClassId{};
  };
  EXPECT_EQ(named(0), wall);
  EXPECT_TRUE(named(1).none());
  EXPECT_EQ(named(2), chair);
  EXPECT_THAT(grid->confidences, ElementsAre(255, 0, 128));
  EXPECT_THAT(grid->instances, ElementsAre(0, 0, 7));
  EXPECT_EQ(classes_of({3, 1, std::vector<LabelSample>(3), {}}), nullptr) << "nothing costs nothing";
}

TEST(ClassGrid, PartsThatDoNotFitAreTold) {
  const auto after = [](auto change) {
    ClassGrid grid = *classes_of(labels());
    change(grid);
    return fits_together(grid);
  };
  EXPECT_FALSE(after([](ClassGrid& g) { g.which[0] = 3; }));
  EXPECT_FALSE(after([](ClassGrid& g) { g.rows = 2; }));
  EXPECT_FALSE(after([](ClassGrid& g) { g.rows = -1; }));
  EXPECT_FALSE(after([](ClassGrid& g) { g.instances.pop_back(); }));
  EXPECT_FALSE(after([](ClassGrid& g) { g.confidences.clear(); }));
  EXPECT_FALSE(after([](ClassGrid& g) { std::swap(g.classes[0], g.classes[1]); }));
  EXPECT_FALSE(after([](ClassGrid& g) { g.classes[0] = {}; }));
}

class MapClasses : public ::testing::Test {
 protected:
  Map map = full_map();
  KeyframeId keyframe = map.keyframes().at_index(2);
};

TEST_F(MapClasses, AKeyframeKeepsThemUntilItIsRelabelledOrCulled) {
  map.apply(SetClasses{keyframe, classes_of(labels())});
  ASSERT_NE(map.keyframes().find(keyframe)->classes, nullptr);
  map.apply(SetClasses{keyframe, nullptr});
  EXPECT_EQ(map.keyframes().find(keyframe)->classes, nullptr);
  const std::weak_ptr<const ClassGrid> kept = [&] {
    auto grid = classes_of(labels());
    map.apply(SetClasses{keyframe, grid});
    return grid;
  }();
  ASSERT_FALSE(kept.expired());
  map.apply(RemoveKeyframe{keyframe, map.keyframes().at_index(3)});
  EXPECT_TRUE(kept.expired());
}

TEST_F(MapClasses, AMergedPlaneHasTheVotesOfBoth) {
  const PlaneId first = map.planes().at_index(1), second = map.planes().at_index(2);
  map.apply(SetPlaneClasses{first, votes_of({{wall, 1}, {chair, 0.5F}})});
  map.apply(SetPlaneClasses{second, votes_of({{wall, 2}})});
  map.apply(MergePlane{second, first});
  EXPECT_EQ(map.planes().find(first)->class_votes, votes_of({{wall, 3}, {chair, 0.5F}}));
}

TEST_F(MapClasses, AJoinedMapKnowsTheNamesOfBoth) {
  map.apply(NameClasses{{{chair, "chair"}, {wall, "wall"}}});
  Map other;
  other.apply(OpenMap{map.unused_ids(), 0});
  other.apply(NameClasses{{{wall, "wall"}, {table, "table"}}});
  const ClassNames before = map.class_names();
  map.apply(AbsorbMap{other.snapshot(), Se3{}});
  ClassNames both = before;
  both.emplace(table, "table");
  EXPECT_EQ(map.class_names(), both);
}

TEST_F(MapClasses, ACopyKeepsTheNamesItHad) {
  const Snapshot before = map.snapshot();
  const std::size_t known = before->class_names().size();
  map.apply(NameClasses{{{table, "table"}}});
  EXPECT_EQ(before->class_names().size(), known);
  EXPECT_EQ(map.class_names().size(), known + 1);
}

TEST_F(MapClasses, EditsOfThemHaveHashesOfTheirOwn) {
  const auto hash = [](EditOperation operation) { return MapEdit{0, {std::move(operation)}}.hash(); };
  EXPECT_NE(hash(NameClasses{{{wall, "wall"}}}), hash(NameClasses{{{wall, "well"}}}));
  LabelGrid other = labels();
  other.samples[1].named = wall;
  EXPECT_NE(hash(SetClasses{keyframe, classes_of(labels())}), hash(SetClasses{keyframe, classes_of(other)}));
  EXPECT_EQ(hash(SetClasses{keyframe, classes_of(labels())}),
            hash(SetClasses{keyframe, classes_of(labels())}));
  EXPECT_NE(hash(SetPlaneClasses{{}, {{wall, 1}}}), hash(SetPlaneClasses{{}, {{chair, 1}}}));
  const auto patches = [](ClassId id) {
    KeyframeSurfaces surfaces{{SurfacePatch{}}, true};
    surfaces.patches[0].class_votes = {{id, 1}};
    return std::make_shared<const KeyframeSurfaces>(surfaces);
  };
  EXPECT_NE(hash(SetPatches{keyframe, patches(wall)}), hash(SetPatches{keyframe, patches(chair)}));
}

}  // namespace
}  // namespace vsgraphs
