// Whether a run can go on in an atlas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/system/maps/atlas_file.h"

namespace vsgraphs {
namespace {

TEST(AtlasFit, ConfigurationsAreLinesThatCanBeReadBack) {
  Config config;
  config.set("system.seed", std::int64_t{7});
  config.set("orb.scale_factor", 1.3);
  config.set("system.schedule_out", std::string("a \"b\" c"));
  const std::string text = configuration_text(config);
  EXPECT_EQ(configured(text, "system.seed"), "7");
  EXPECT_EQ(configured(text, "orb.scale_factor"), "1.3");
  EXPECT_EQ(configured(text, "system.mode"), "full");
  EXPECT_EQ(configured(text, "system.realtime"), "false");
  EXPECT_EQ(configured(text, "mode"), "");
  EXPECT_THAT(text, testing::HasSubstr("system.schedule_out: \"a \\\"b\\\" c\"\n"));
}

class AtlasFitTest : public testing::Test {
 protected:
  std::string error() const {
    try {
      require_fit("FILE", atlas, config, camera);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  static SavedAtlas some_atlas() {
    SavedAtlas atlas;
    atlas.camera.distortion = {0.1, -0.2, 0.001, 0.002, 0};
    atlas.configuration = configuration_text(Config{});
    return atlas;
  }
  SavedAtlas atlas = some_atlas();
  Config config;
  Camera camera = atlas.camera;
};

TEST_F(AtlasFitTest, TheSameCameraFitsAndOneRecalibratedToo) {
  EXPECT_EQ(error(), "");
  camera.fx += 2;
  camera.distortion = {};
  EXPECT_EQ(error(), "");
}

TEST_F(AtlasFitTest, AnotherImageSizeOrLensIsNamed) {
  camera.width = 320;
  camera.height = 240;
  EXPECT_EQ(
      error(),
      "FILE: was mapped with images of 640x480 pixels, and this camera's have 320x240; use the camera it was "
      "mapped with, or map anew");
  camera = atlas.camera;
  camera.fx = 600;
  EXPECT_THAT(error(), testing::HasSubstr("fx 525, fy 525, cx 320, cy 240 px, and this one has fx 600"));
}

TEST_F(AtlasFitTest, FeaturesOfOtherScalesDoNotFit) {
  config.set("orb.levels", std::int64_t{4});
  EXPECT_EQ(error(), "FILE: was mapped with orb.levels = 8, and this run has 4; set it to the same");
}

TEST_F(AtlasFitTest, AModeThatKnowsLessMayOnlyLocalise) {
  config.set("system.mode", std::string("slam"));
  EXPECT_THAT(error(), testing::HasSubstr("was mapped with --mode full, and --mode slam would leave"));
  config.system.localise_only = true;
  EXPECT_EQ(error(), "");
  config = Config{};
  Config less;
  less.set("system.mode", std::string("bc"));
  atlas.configuration = configuration_text(less);
  EXPECT_EQ(error(), "");  // rooms are sought from now on
}

}  // namespace
}  // namespace vsgraphs
