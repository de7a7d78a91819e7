#include "core/system/run/segmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

using ::testing::HasSubstr;

class SegmentationTest : public ::testing::Test {
 protected:
  // What sampling complains of; empty if of nothing.
  std::string complaint(const Segmentation& segmentation) const {
    try {
      sample_labels(segmentation, camera);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  Camera camera;
  Image<std::uint8_t> roles{640, 480, 1};
  Image<float> confidence{640, 480, 0.5F};
  Image<std::uint16_t> instances{640, 480, 3};
};

TEST_F(SegmentationTest, EverySampleHasTheLabelOfItsPixel) {
  roles.at(8 * 10 + 4, 8 * 20 + 4) = static_cast<std::uint8_t>(SurfaceRole::door);
  confidence.at(8 * 10 + 4, 8 * 20 + 4) = 0.75F;
  instances.at(8 * 10 + 4, 8 * 20 + 4) = 7;
  const LabelGrid grid = sample_labels({roles.view(), confidence.view(), instances.view()}, camera);
  ASSERT_EQ(grid.columns, 80);
  ASSERT_EQ(grid.rows, 60);
  ASSERT_EQ(grid.samples.size(), 4800U);
  const LabelSample& there = grid.samples[20 * 80 + 10];
  EXPECT_EQ(there.role, SurfaceRole::door);
  EXPECT_EQ(there.confidence, 0.75F);
  EXPECT_EQ(there.instance, 7);
  EXPECT_EQ(grid.samples[20 * 80 + 11].role, SurfaceRole::wall);
  EXPECT_EQ(grid.samples[20 * 80 + 11].confidence, 0.5F);
  EXPECT_EQ(grid.samples[20 * 80 + 11].instance, 3);
}

TEST_F(SegmentationTest, ASegmentersOwnImageSizeCoversTheWholeView) {
  Image<std::uint8_t> small(64, 36, 0);
  for (int v = 0; v < 36; ++v)
    for (int u = 32; u < 64; ++u) small.at(u, v) = 2;
  const LabelGrid grid = sample_labels({small.view(), {}, {}}, camera);
  for (int r : {0, 30, 59}) {
    EXPECT_EQ(grid.samples[static_cast<std::size_t>(r * 80 + 39)].role, SurfaceRole::undecided);
    EXPECT_EQ(grid.samples[static_cast<std::size_t>(r * 80 + 40)].role, SurfaceRole::ground);
    EXPECT_EQ(grid.samples[static_cast<std::size_t>(r * 80 + 79)].role, SurfaceRole::ground);
  }
}

TEST_F(SegmentationTest, WithoutConfidenceItIsCertainAndWithoutInstancesThereAreNone) {
  const LabelGrid grid = sample_labels({roles.view(), {}, {}}, camera);
  EXPECT_EQ(grid.samples[0].confidence, 1);
  EXPECT_EQ(grid.samples[0].instance, 0);
}

TEST_F(SegmentationTest, WhatMakesNoSenseIsNamed) {
  EXPECT_EQ(complaint({roles.view(), confidence.view(), instances.view()}), "");
  EXPECT_THAT(complaint({}), HasSubstr("roles is empty"));
  const Image<float> low(320, 240, 0.5F);
  const Image<std::uint16_t> narrow(320, 480, 1);
  EXPECT_THAT(complaint({roles.view(), low.view(), {}}), HasSubstr("confidence has another size"));
  EXPECT_THAT(complaint({roles.view(), {}, narrow.view()}), HasSubstr("instances has another size"));
  for (const float bad : {-0.1F, 1.5F, std::numeric_limits<float>::quiet_NaN()}) {
    const Image<float> wrong(640, 480, bad);
    EXPECT_THAT(complaint({roles.view(), wrong.view(), {}}), HasSubstr("confidence must be 0 to 1"));
  }
  const Image<std::uint8_t> no_role(640, 480, static_cast<std::uint8_t>(surface_role_count));
  EXPECT_THAT(complaint({no_role.view(), {}, {}}), HasSubstr("7 is no role"));
}

class ClassesTest : public SegmentationTest {
 protected:
  std::string complaint_of(const std::vector<std::string>& names) const {
    return complaint({roles.view(), {}, {}, classes.view(), names});
  }
  Image<std::uint16_t> classes{640, 480, 0};
};

TEST_F(ClassesTest, ASampleHasTheClassOfItsPixelByTheNumberOfItsName) {
  classes.at(8 * 10 + 4, 8 * 20 + 4) = 3;
  const std::vector<std::string> names{"wall", "table", "chair"};
  const LabelGrid grid = sample_labels({roles.view(), {}, {}, classes.view(), names}, camera);
  EXPECT_EQ(grid.samples[20 * 80 + 10].named, class_id("chair"));
  EXPECT_TRUE(grid.samples[20 * 80 + 11].named.none());
  EXPECT_EQ(grid.samples[20 * 80 + 10].role, SurfaceRole::wall) << "beside its role";
  EXPECT_EQ(grid.class_names, (ClassNames{{class_id("chair"), "chair"}})) << "those that occur";
}

TEST_F(ClassesTest, WhatMakesNoSenseIsNamed) {
  EXPECT_EQ(complaint_of({"wall", std::string(128, 'x'), "T\xc3\xbcr"}), "");
  EXPECT_THAT(complaint_of({}), HasSubstr("classes without class_names"));
  EXPECT_THAT(complaint_of({"wall", ""}), HasSubstr("the name of class 2 must be a text of 1 to 128 bytes"));
  for (const std::string& bad : {std::string(129, 'x'), std::string("a\nb"), std::string("\xff")})
    EXPECT_THAT(complaint_of({bad}), HasSubstr("the name of class 1 must be"));
  EXPECT_THAT(complaint_of({"wall", "chair", "wall"}), HasSubstr("class name 'wall' is there twice"));
  EXPECT_THAT(complaint_of({"costarring", "liquid"}),
              testing::AllOf(HasSubstr("'costarring'"), HasSubstr("'liquid'"), HasSubstr("one number")));
  EXPECT_THAT(complaint_of(std::vector<std::string>(65536, "x")),
              HasSubstr("65536 class names; at most 65535"));
  const std::vector<std::string> names{"wall"};
  EXPECT_THAT(complaint({roles.view(), {}, {}, {}, names}), HasSubstr("class_names without classes"));
  const Image<std::uint16_t> narrow(320, 480, 1);
  EXPECT_THAT(complaint({roles.view(), {}, {}, narrow.view(), names}), HasSubstr("classes has another size"));
  classes.at(4, 4) = 2;
  EXPECT_THAT(complaint_of(names), HasSubstr("class 2 is beyond the 1 of class_names"));
}

TEST(ClassRegister, KnowsOneNameOfANumber) {
  const ClassId number = class_id("liquid");
  ASSERT_EQ(number, class_id("costarring"));
  ClassRegister known;
  known.take({{number, "liquid"}});
  known.take({{number, "liquid"}, {class_id("wall"), "wall"}});
  try {
    known.take({{number, "costarring"}});
    FAIL() << "two names of one number";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("'liquid'"), HasSubstr("'costarring'")));
  }
}

}  // namespace
}  // namespace vsgraphs
