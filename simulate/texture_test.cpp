#include "simulate/texture.h"

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "simulate/materials.h"

namespace vsgraphs {
namespace {

TEST(Texture, SamplesTexelCentresExactlyAndBlendsBetween) {
  Image<Rgb> image(4, 2, {100, 100, 100});
  image.at(1, 0) = {200, 50, 0};
  const Texture texture(image);
  // Row 0 is the upper one: t = 0.75. Texel 1 has its centre at s = 1.5 / 4.
  const Colour centre = texture.sample(0.375f, 0.75f, 0);
  EXPECT_NEAR(centre.r, 200, 1);
  EXPECT_NEAR(centre.g, 50, 1);
  EXPECT_NEAR(centre.b, 0, 1);
  EXPECT_NEAR(texture.sample(0.25f, 0.75f, 0).r, 150, 1.5);  // half-way to texel 0
}

TEST(Texture, RepeatsInBothDirectionsAlsoBelowZero) {
  Image<Rgb> image(8, 8);
  for (int v = 0; v < 8; ++v)
    for (int u = 0; u < 8; ++u)
      image.at(u, v) = {static_cast<std::uint8_t>(30 * u), static_cast<std::uint8_t>(30 * v), 7};
  const Texture texture(image);
  for (const float s : {0.1f, 0.55f, 0.93f}) {
    for (const float shift : {-2.0f, 1.0f, 3.0f}) {
      const Colour a = texture.sample(s, 0.3f, 0), b = texture.sample(s + shift, 0.3f - shift, 0);
      EXPECT_NEAR(a.r, b.r, 0.5);
      EXPECT_NEAR(a.g, b.g, 0.5);
    }
  }
}

TEST(Texture, CoarsestLevelIsTheMean) {
  Image<Rgb> image(16, 16, {10, 20, 30});
  for (int v = 0; v < 16; ++v)
    for (int u = 0; u < 8; ++u) image.at(u, v) = {110, 220, 130};
  const Texture texture(image);
  EXPECT_EQ(texture.level_count(), 5);
  const Colour mean = texture.sample(0.3f, 0.9f, 4);
  EXPECT_NEAR(mean.r, 60, 1);
  EXPECT_NEAR(mean.g, 120, 1);
  EXPECT_NEAR(mean.b, 80, 1);
}

TEST(Texture, RefusesSidesThatAreNoPowersOfTwo) {
  EXPECT_THROW(Texture(Image<Rgb>(6, 8)), InvariantError);
  EXPECT_THROW(Texture(Image<Rgb>()), InvariantError);
}

TEST(Materials, EqualOrdersShareOneTexture) {
  MaterialStore store;
  const Material poster{"poster", 3, {255, 255, 255}, 0.7};
  const int id = store.id_of(poster);
  EXPECT_EQ(store.id_of(poster), id);
  EXPECT_NE(store.id_of({"poster", 4, {255, 255, 255}, 0.7}), id);
  EXPECT_NE(store.id_of({"poster", 3, {255, 255, 255}, 1.4}), id);
  EXPECT_EQ(store.entries().size(), 3u);
  EXPECT_THROW(store.id_of({"velvet", 1, {1, 1, 1}, 1}), InvariantError);
}

TEST(Materials, SameSeedSamePaint) {
  const Material tiles{"tiles", 11, {180, 170, 160}, 1};
  EXPECT_EQ(paint_material(tiles).image.pixels, paint_material(tiles).image.pixels);
  Material other = tiles;
  other.seed = 12;
  EXPECT_NE(paint_material(tiles).image.pixels, paint_material(other).image.pixels);
}

}  // namespace
}  // namespace vsgraphs
