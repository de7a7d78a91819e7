#include "core/scene/surfaces/plane_extraction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Camera camera;

KeyframeSurfaces extract(const DepthGrid& grid, const LabelGrid* labels = nullptr,
                         const PlaneExtractionOptions& options = {}) {
  return extract_planes(grid, labels, camera, options);
}

// A wall 2 m ahead, wide and high.
World wall_ahead() { return World().sheet({-4, 2, -4}, {8, 0, 0}, {0, 0, 8}); }
Se3 straight_ahead() { return looking({0, 0, 0}, {0, 1, 0}); }

LabelGrid labels_for(const DepthGrid& grid) {
  LabelGrid labels;
  labels.columns = grid.columns;
  labels.rows = grid.rows;
  labels.samples.resize(grid.samples.size());
  return labels;
}

TEST(PlaneExtraction, AWallIsOnePatchTowardsTheCamera) {
  const KeyframeSurfaces found = extract(view(wall_ahead(), straight_ahead()));
  ASSERT_THAT(found.patches, SizeIs(1));
  const SurfacePatch& patch = found.patches[0];
  EXPECT_TRUE(patch.plane.normal.isApprox(-Eigen::Vector3d::UnitZ(), 1e-5)) << "it looks at the camera";
  EXPECT_NEAR(patch.plane.anchor.z(), 2, 1e-5) << "anchored on itself, not at the origin";
  EXPECT_LT(patch.plane.anchor.head<2>().norm(), 0.05);
  const double whole_image_m2 = 640 * 480 * 4 / (camera.fx * camera.fy);
  EXPECT_NEAR(static_cast<double>(patch.area_m2), whole_image_m2, 0.05 * whole_image_m2);
  EXPECT_GT(patch.samples, 4500);
  EXPECT_FALSE(found.labelled);
}

TEST(PlaneExtraction, ARoomsSurfacesAreOnePatchEach) {
  // Two walls of a corner and the floor.
  const World world = World().room({-3, -3, 0}, {2, 2, 6});
  const KeyframeSurfaces found = extract(view(world, looking({0, 0, 1.5}, {2, 2, 0.6})));
  ASSERT_THAT(found.patches, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NEAR(found.patches[i].plane.normal.dot(found.patches[j].plane.normal), 0, 1e-3);
  }
}

TEST(PlaneExtraction, TwoDepthsAreTwoPatchesThoughParallel) {
  World world = wall_ahead();
  world.box({-4, 1.7, -4}, {0, 1.95, 4});
  const KeyframeSurfaces found = extract(view(world, straight_ahead()));
  ASSERT_THAT(found.patches, SizeIs(2));
  EXPECT_NEAR(std::abs(found.patches[0].plane.d() - found.patches[1].plane.d()), 0.3, 0.01);
}

TEST(PlaneExtraction, PiecesOfOnePlaneApartFromEachOtherAreTwoPatches) {
  // An open gap between the two, and nothing behind.
  const World world =
      World().sheet({-2, 2, -4}, {1.5, 0, 0}, {0, 0, 8}).sheet({0.5, 2, -4}, {1.5, 0, 0}, {0, 0, 8});
  EXPECT_THAT(extract(view(world, straight_ahead())).patches, SizeIs(2));
}

TEST(PlaneExtraction, APosterIsPartOfItsWall) {
  World world = wall_ahead();
  world.box({-0.4, 1.985, -0.3}, {0.4, 2.0, 0.3});
  ASSERT_THAT(extract(view(world, straight_ahead())).patches, SizeIs(1));
}

TEST(PlaneExtraction, CurvedSurfacesAreNoPlanes) {
  World world;
  world.balls.push_back({{0, 1.5, 0}, 0.5});
  EXPECT_THAT(extract(view(world, straight_ahead())).patches, IsEmpty());
}

TEST(PlaneExtraction, TooFewSamplesAreNoPlane) {
  const auto square = [](double size_m) {
    return World().sheet({-size_m / 2, 2, -size_m / 2}, {size_m, 0, 0}, {0, 0, size_m});
  };
  EXPECT_THAT(extract(view(square(0.2), straight_ahead())).patches, IsEmpty());
  EXPECT_THAT(extract(view(square(0.5), straight_ahead())).patches, SizeIs(1));
  PlaneExtractionOptions options;
  options.min_samples = 2000;
  EXPECT_THAT(extract(view(square(0.5), straight_ahead()), nullptr, options).patches, IsEmpty());
  options = {};
  options.min_area_m2 = 0.5;
  EXPECT_THAT(extract(view(square(0.5), straight_ahead()), nullptr, options).patches, IsEmpty());
}

TEST(PlaneExtraction, WhatIsOutOfRangeIsNotUsed) {
  PlaneExtractionOptions options;
  options.max_range_m = 1.9;
  EXPECT_THAT(extract(view(wall_ahead(), straight_ahead()), nullptr, options).patches, IsEmpty());
  options.max_range_m = 5;
  options.min_range_m = 2.0;
  EXPECT_THAT(
      extract(view(World().sheet({-4, 1.5, -4}, {8, 0, 0}, {0, 0, 8}), straight_ahead()), nullptr, options)
          .patches,
      IsEmpty());
  EXPECT_THAT(extract(view({}, straight_ahead())).patches, IsEmpty()) << "no reading at all";
}

TEST(PlaneExtraction, ClassesAndInstancesKeepPiecesOfOnePlaneApart) {
  const DepthGrid grid = view(wall_ahead(), straight_ahead());
  LabelGrid labels = labels_for(grid);
  const auto paint = [&](SurfaceRole right, std::uint16_t right_instance) {
    for (int i = 0; i < grid.columns * grid.rows; ++i) {
      const bool left = i % grid.columns < grid.columns / 2;
      labels.samples[static_cast<std::size_t>(i)] = {left ? SurfaceRole::wall : right, 0.8F,
                                                     left ? std::uint16_t{1} : right_instance};
    }
    return extract(grid, &labels);
  };
  EXPECT_THAT(paint(SurfaceRole::wall, 1).patches, SizeIs(1));
  EXPECT_THAT(paint(SurfaceRole::wall, 2).patches, SizeIs(2)) << "two instances";
  const KeyframeSurfaces by_class = paint(SurfaceRole::door, 1);
  ASSERT_THAT(by_class.patches, SizeIs(2)) << "two classes";
  EXPECT_TRUE(by_class.labelled);
  EXPECT_THAT(paint(SurfaceRole::undecided, 0).patches, SizeIs(1)) << "what says nothing parts nothing";
}

TEST(PlaneExtraction, AKeyframeHasOneVoteOfTheLabelsConfidence) {
  const DepthGrid grid = view(wall_ahead(), straight_ahead());
  LabelGrid labels = labels_for(grid);
  for (LabelSample& l : labels.samples) l = {SurfaceRole::wall, 0.75F, 0};
  const RoleVotes votes = extract(grid, &labels).patches.at(0).votes;
  EXPECT_NEAR(votes[static_cast<std::size_t>(SurfaceRole::wall)], 0.75F, 1e-3F);
  EXPECT_EQ(votes[static_cast<std::size_t>(SurfaceRole::door)], 0);
  for (LabelSample& l : labels.samples) l.confidence = 0.05F;
  const RoleVotes unsure = extract(grid, &labels).patches.at(0).votes;
  EXPECT_EQ(unsure[static_cast<std::size_t>(SurfaceRole::wall)], 0) << "too little confidence says nothing";
}

TEST(PlaneExtraction, AWallHalfOfWhichIsCalledPictureHasVotesOfBothClasses) {
  const DepthGrid grid = view(wall_ahead(), straight_ahead());
  LabelGrid labels = labels_for(grid);
  const ClassId wall = class_id("wall"), picture = class_id("picture");
  for (int i = 0; i < grid.columns * grid.rows; ++i)
    labels.samples[static_cast<std::size_t>(i)] = {SurfaceRole::wall, 0.8F, 0,
                                                   i % grid.columns < grid.columns / 2 ? wall : picture};
  const KeyframeSurfaces found = extract(grid, &labels);
  ASSERT_THAT(found.patches, SizeIs(1)) << "a class parts nothing";
  const ClassVotes& votes = found.patches[0].class_votes;
  ASSERT_THAT(votes, SizeIs(2));
  for (const ClassVote& vote : votes) EXPECT_NEAR(vote.weight, 0.4F, 0.01F);
  EXPECT_TRUE(are_named(votes, {{wall, "wall"}, {picture, "picture"}}));
  EXPECT_TRUE(are_sane(votes));
  EXPECT_NEAR(found.patches[0].votes[static_cast<std::size_t>(SurfaceRole::wall)], 0.8F, 0.01F);
}

TEST(PlaneExtraction, AClassCountsWhereTheRoleIsUndecidedToo) {
  const DepthGrid grid = view(wall_ahead(), straight_ahead());
  LabelGrid labels = labels_for(grid);
  for (LabelSample& l : labels.samples) l = {SurfaceRole::undecided, 0.75F, 0, class_id("curtain")};
  const ClassVotes votes = extract(grid, &labels).patches.at(0).class_votes;
  ASSERT_THAT(votes, SizeIs(1));
  EXPECT_NEAR(votes[0].weight, 0.75F, 1e-3F);
  for (LabelSample& l : labels.samples) l.confidence = 0.05F;
  EXPECT_THAT(extract(grid, &labels).patches.at(0).class_votes, SizeIs(0)) << "too little confidence";
}

}  // namespace
}  // namespace vsgraphs
