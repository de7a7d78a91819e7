#include "core/system/maps/atlas_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/atomic_file.h"
#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/map/test_depth_row.h"
#include "core/map/test_full_map.h"
#include "core/scene/space/space_keeper.h"
#include "core/system/maps/followers.h"

namespace vsgraphs {
namespace {

MapState gathered(Map& map) {
  map.apply(vsgraphs::SetUp{-Eigen::Vector3d::UnitY()});
  const Followers followers = make_followers(Config{}, Camera{});
  followers.start(map, {});
  Followers(followers).catch_up(map, true, [](const char*, const auto& work) { return work(), true; });
  return {map.snapshot(), followers};
}

// A wall that a segmenter has called a picture, in part.
void add_named_plane(Map& map, KeyframeId seen_by) {
  map.apply(NameClasses{{{class_id("picture"), "picture"}, {class_id("chair"), "chair"}}});
  map.apply(SetPatches{seen_by, test::some_patches(2)});
  map.apply(SetClasses{seen_by, test::some_classes()});
  MappedPlane plane;
  plane.plane = {-Eigen::Vector3d::UnitZ(), {0, 0, 3}, 0};
  plane.class_votes = {{class_id("picture"), 0.25F}};
  const PlaneId id = map.planes().next_id();
  map.apply(AddPlane{id, plane});
  map.apply(AddPlaneObservation{id, {seen_by, 1}});
}

// Two keyframes with landmarks and depth; `first_name` sets how the points look, so that two maps differ, and `first` where
// ids begin.
MapState some_map(int first_name, const FirstIds& first) {
  Map map;
  map.apply(OpenMap{first, 0});
  const Camera camera;
  const auto points = test::point_grid(8, 6);
  std::vector<KeyframeId> keyframes;
  for (int i = 0; i < 3; ++i) {
    Keyframe keyframe = test::keyframe_seeing(camera, test::standing_at(0.2 * i), points, first_name);
    keyframe.surface = test::depth_row();
    keyframes.push_back(test::add_keyframe(map, keyframe));
  }
  test::add_landmarks(map, points, keyframes);
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  add_named_plane(map, keyframes[0]);
  map.apply(AddMarker{{7}, {0.2, Se3{}, {}}});
  map.apply(AddMarkerObservation{{7}, {keyframes[0], Se3{}, Matrix6d::Identity()}});
  map.apply(MapEdit{});
  return gathered(map);
}

SavedAtlas some_atlas() {
  SavedAtlas atlas;
  atlas.state.maps = {some_map(0, {}), some_map(100, {64, 64, 64})};
  // As a map of a run that only locates the camera.
  atlas.state.maps[0].followers = Followers({std::make_shared<PlaceKeeper>(atlas.state.maps[0].places())});
  atlas.camera.distortion = {0.1, -0.2, 0.001, 0.002, 0};
  atlas.configuration = configuration_text(Config{});
  atlas.program = "1.2.3";
  atlas.commit = "abc";
  atlas.map_names = {"downstairs", ""};
  return atlas;
}

Bytes bytes_of(const SavedAtlas& atlas) {
  ArchiveWriter archive(atlas_kind);
  write_atlas(archive, atlas);
  return test::joined(archive.finish());
}

std::string error_of(std::span<const std::byte> bytes) {
  try {
    read_atlas("FILE", bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(AtlasFile, SavingWhatWasLoadedGivesTheSameBytes) {
  const std::filesystem::path path = testing::TempDir() + "atlas_file_test.vsg";
  const SavedAtlas atlas = some_atlas();
  save_atlas(path, atlas);
  const SavedAtlas back = load_atlas(path);
  std::filesystem::remove(path);
  EXPECT_EQ(bytes_of(back), bytes_of(atlas));
  ASSERT_EQ(back.state.maps.size(), 2U);
  EXPECT_EQ(back.state.maps[0].followers.find<SpaceKeeper>(), nullptr);
  EXPECT_EQ(back.state.maps[1].followers.all().size(), 3U);
  const SpaceKeeper& space = *back.state.maps[1].followers.find<SpaceKeeper>();
  EXPECT_EQ(space.view().views.size(), 2U);
  EXPECT_EQ(back.state.maps[1].places()->size(), 2);
  // What a keyframe and the free space share is one object again.
  const Map& map = *back.state.maps[1].map;
  const KeyframeId first = map.keyframes().at_index(64);
  EXPECT_EQ(map.keyframes().find(first)->surface, space.view().views.front().depth);
  EXPECT_EQ(back.map_names, atlas.map_names);
  EXPECT_EQ(back.program, "1.2.3");
  EXPECT_EQ(back.camera.distortion, atlas.camera.distortion);
  const MapCounts counts = count({back.state.maps[1].map, back.state.maps[1].map});
  EXPECT_THAT(counts,
              testing::IsSupersetOf(
                  {std::pair<std::string, std::size_t>{"keyframes", 4}, {"landmarks", 96}, {"markers", 2}}));
}

// As a run's state comes back from it: what the run started from is known.
SavedAtlas made_from(const SavedAtlas& loaded) {
  SavedAtlas next = some_atlas();
  next.state.loaded = loaded.state.loaded;
  next.parent = next.state.loaded;
  return next;
}

TEST(AtlasFile, TellsWhatItGoesBackTo) {
  const Bytes first = bytes_of(some_atlas());
  const SavedAtlas root = read_atlas("FILE", first);
  EXPECT_EQ(root.parent, AtlasVersion{});
  EXPECT_EQ(root.state.loaded.lineage, root.state.loaded.revision) << "the first of its line";
  EXPECT_EQ(root.state.loaded.revision, archive_identity(first));
  EXPECT_EQ(root.revision, archive_identity(first));
  EXPECT_EQ(some_atlas().revision, 0U);
  const SavedAtlas child = read_atlas("FILE", bytes_of(made_from(root)));
  const SavedAtlas grandchild = read_atlas("FILE", bytes_of(made_from(child)));
  EXPECT_EQ(child.parent, root.state.loaded);
  EXPECT_EQ(grandchild.parent, child.state.loaded);
  EXPECT_EQ(grandchild.state.loaded.lineage, root.state.loaded.revision);
  EXPECT_NE(child.state.loaded.revision, root.state.loaded.revision) << "though all maps are the same";
  EXPECT_NE(grandchild.state.loaded.revision, child.state.loaded.revision);
}

TEST(AtlasFile, TheSameContentIsTheSameRevision) {
  const SavedAtlas one = read_atlas("FILE", bytes_of(some_atlas()));
  EXPECT_EQ(one.state.loaded, read_atlas("FILE", bytes_of(some_atlas())).state.loaded);
  SavedAtlas other = some_atlas();
  other.map_names[0] = "upstairs";
  EXPECT_NE(one.state.loaded.revision, read_atlas("FILE", bytes_of(other)).state.loaded.revision);
}

// As earlier versions wrote it, of a run that only locates the camera.
Bytes of_format(std::uint32_t version, SavedAtlas atlas) {
  for (MapState& state : atlas.state.maps)
    state.followers = Followers({std::make_shared<PlaceKeeper>(state.places())});
  const ArchiveKind kind{atlas_kind.magic, version, atlas_kind.what};
  ArchiveWriter writer(kind);
  write_atlas(writer, atlas);
  const Bytes bytes = test::joined(writer.finish());
  const ArchiveReader archive("FILE", bytes, kind);
  ArchiveWriter older(kind);
  for (const std::string& name : archive.names()) {
    if (name != "lineage" || version > 1)  // there were none at first
      older.add_bytes(name, {archive.section(name).begin(), archive.section(name).end()});
  }
  return test::joined(older.finish());
}

TEST(AtlasFile, FilesOfFormat1BeginALine) {
  const Bytes old = of_format(1, some_atlas());
  const SavedAtlas atlas = read_atlas("FILE", old);
  EXPECT_EQ(atlas.format, 1U);
  EXPECT_EQ(atlas.state.loaded, (AtlasVersion{archive_identity(old), archive_identity(old)}));
  const SavedAtlas again = read_atlas("FILE", bytes_of(atlas));
  EXPECT_EQ(again.format, atlas_kind.version);
  EXPECT_EQ(again.parent, atlas.state.loaded);
  EXPECT_EQ(again.state.loaded.lineage, atlas.state.loaded.lineage);
}

TEST(AtlasFile, KeyframesOfFormat2AreCutIntoStretches) {
  const SavedAtlas atlas = read_atlas("FILE", of_format(2, some_atlas()));
  EXPECT_EQ(atlas.format, 2U);
  const Map& map = *atlas.state.maps[1].map;
  const KeyframeId first = map.retired_keyframes().at_index(64);
  for (std::uint32_t index = 64; index < map.retired_keyframes().index_bound(); ++index)
    EXPECT_EQ(map.stretch_of(map.retired_keyframes().at_index(index)), first);
  EXPECT_EQ(error_of(bytes_of(atlas)), "");
}

TEST(AtlasFile, MapsOfFormat4KnowNoClasses) {
  const SavedAtlas now = some_atlas();
  ASSERT_FALSE(now.state.maps[1].map->class_names().empty());
  const SavedAtlas atlas = read_atlas("FILE", of_format(4, now));
  EXPECT_EQ(atlas.format, 4U);
  for (const MapState& state : atlas.state.maps) {
    EXPECT_TRUE(state.map->class_names().empty());
    state.map->planes().for_each(
        [](PlaneId, const MappedPlane& plane) { EXPECT_TRUE(plane.class_votes.empty()); });
    state.map->keyframes().for_each(
        [](KeyframeId, const Keyframe& keyframe) { EXPECT_EQ(keyframe.classes, nullptr); });
  }
  EXPECT_EQ(error_of(bytes_of(atlas)), "");
}

TEST(AtlasFile, MapsThatNameOneNumberDifferentlyCannotBe) {
  SavedAtlas atlas = some_atlas();
  const auto name = [&atlas](std::size_t i, const std::string& text) {
    Map map = *atlas.state.maps[i].map;
    map.apply(NameClasses{{{class_id(text), text}}});
    atlas.state.maps[i].map = map.snapshot();
  };
  name(0, "liquid");
  EXPECT_EQ(error_of(bytes_of(atlas)), "");
  name(1, "costarring");
  EXPECT_THAT(error_of(bytes_of(atlas)), testing::HasSubstr("two classes of one number"));
}

TEST(AtlasFile, RevisionsAreReadOffTheFile) {
  const std::filesystem::path path = testing::TempDir() + "atlas_file_test_revision.vsg";
  std::filesystem::remove(path);
  EXPECT_EQ(atlas_revision(path), std::nullopt);
  const std::uint64_t revision = save_atlas(path, some_atlas());
  EXPECT_EQ(atlas_revision(path), revision);
  EXPECT_EQ(load_atlas(path).state.loaded.revision, revision);
  write_file_atomically(path, {std::as_bytes(std::span("no atlas, but as long as one's beginning"))});
  EXPECT_EQ(atlas_revision(path), std::nullopt);
  std::filesystem::remove(path);
}

TEST(AtlasFile, AMapWithoutKeyframesReplacesNothing) {
  const std::filesystem::path path = testing::TempDir() + "atlas_file_test_empty.vsg";
  std::filesystem::remove(path);
  const std::uint64_t nothing = save_atlas(path, SavedAtlas{});
  EXPECT_THROW(save_atlas(path, SavedAtlas{}), InputError) << "not even what is as empty";
  EXPECT_EQ(atlas_revision(path), nothing);
  const std::uint64_t house = save_atlas(path, some_atlas(), 1);
  EXPECT_THROW(save_atlas(path, SavedAtlas{}, 1), InputError);
  EXPECT_EQ(atlas_revision(path), house);
  EXPECT_EQ(atlas_revision(path.string() + ".1"), nothing);
  std::filesystem::remove(path);
  std::filesystem::remove(path.string() + ".1");
}

TEST(AtlasFile, WhatCouldNotBeLoadedAgainReplacesNothing) {
  const std::filesystem::path path = testing::TempDir() + "atlas_file_test_wild.vsg";
  const std::uint64_t house = save_atlas(path, some_atlas());
  SavedAtlas wild = some_atlas();
  Map map = *wild.state.maps[1].map;
  map.apply(MoveKeyframe{map.keyframes().at_index(64), test::standing_at(1e300)});
  wild.state.maps[1].map = map.snapshot();
  try {
    save_atlas(path, wild);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("could not be loaded again (a keyframe that is nowhere"));
  }
  EXPECT_EQ(atlas_revision(path), house);
  std::filesystem::remove(path);
}

TEST(AtlasFile, MapsWithoutKeyframesAndNoMapsAreAtlasesToo) {
  SavedAtlas atlas;
  EXPECT_TRUE(is_empty(read_atlas("FILE", bytes_of(atlas)).state));
  atlas.state.maps.push_back({std::make_shared<const Map>(), {}});
  const SavedAtlas back = read_atlas("FILE", bytes_of(atlas));
  EXPECT_EQ(back.state.maps.size(), 1U);
  EXPECT_TRUE(is_empty(back.state));
  EXPECT_FALSE(is_empty(some_atlas().state));
}

TEST(AtlasFile, DamageAnywhereIsOneError) {
  const Bytes whole = bytes_of(some_atlas());
  Rng rng(1, "atlas_file_test", 0);
  const auto place = [&] { return rng.index(static_cast<std::uint32_t>(whole.size())); };
  for (int round = 0; round < 300; ++round) {
    Bytes flipped = whole;
    flipped[place()] ^= static_cast<std::byte>(1U << rng.index(8));
    const std::string error = error_of(flipped);
    EXPECT_THAT(error, testing::StartsWith("FILE: "));
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_THAT(error_of(std::span(whole).first(place())), testing::StartsWith("FILE: is damaged"));
  }
}

// Under right checksums, as somebody might make one on purpose: an atlas or InputError, never a crash.
TEST(AtlasFile, ForgedSectionsAreErrorsOrAtlases) {
  const Bytes whole = bytes_of(some_atlas());
  const ArchiveReader original("FILE", whole, atlas_kind);
  const auto names = original.names();
  Rng rng(2, "atlas_file_test", 0);
  int errors = 0, atlases = 0;
  for (int round = 0; round < 400; ++round) {
    const std::string& chosen = names[rng.index(static_cast<std::uint32_t>(names.size()))];
    ArchiveWriter forged(atlas_kind);
    for (const std::string& name : names) {
      Bytes bytes(original.section(name).begin(), original.section(name).end());
      if (name == chosen && !bytes.empty()) {
        bytes[rng.index(static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), 400)))] =
            static_cast<std::byte>(rng.index(2) ? rng.index(8) : rng.next());
      }
      forged.add_bytes(name, std::move(bytes));
    }
    const Bytes bytes = test::joined(forged.finish());
    (error_of(bytes).empty() ? atlases : errors) += 1;
  }
  EXPECT_GT(errors, 50);
  EXPECT_GT(atlases, 50);
}

std::string error_of(const SavedAtlas& atlas) { return error_of(bytes_of(atlas)); }

TEST(AtlasFile, MapsHaveIdsOfTheirOwn) {
  SavedAtlas atlas = some_atlas();
  EXPECT_EQ(error_of(atlas), "");
  atlas.state.maps[1] = some_map(100, {});
  EXPECT_THAT(error_of(atlas), testing::HasSubstr("ids that are not its maps' own"));
  atlas.map_names.clear();
  Map ahead = *atlas.state.maps[0].map;
  ahead.apply(OpenMap{{64, 1U << 25, 64}, 0});
  atlas.state.maps = {{ahead.snapshot(), {}}};
  EXPECT_THAT(error_of(atlas), testing::HasSubstr("damaged"));
}

TEST(AtlasFile, ThePlaceIndexIsOfLivingKeyframes) {
  SavedAtlas atlas = some_atlas();
  atlas.state.maps[0].followers = Followers({std::make_shared<PlaceKeeper>(atlas.state.maps[1].places())});
  EXPECT_THAT(error_of(atlas), testing::HasSubstr("a place index of a keyframe that does not exist"));
}

TEST(AtlasFile, TextsAreTexts) {
  SavedAtlas atlas = some_atlas();
  atlas.map_names = {
      "K\xc3\xbc"
      "che",
      "\xe2\x82\xac \xf0\x9f\x8f\xa0"};
  EXPECT_EQ(error_of(atlas), "");
  for (const char* odd : {"\xc3", "\xff", "a\x80", "\xe2\x82", "\xc3\xbc\xbc", "\xf8\x88\x80\x80\x80"}) {
    atlas.program = odd;
    EXPECT_THAT(error_of(atlas), testing::HasSubstr("a text that is none")) << odd;
  }
}

TEST(AtlasFile, AMissingSectionIsNamed) {
  ArchiveWriter archive(atlas_kind);
  archive.add("origin", std::string("1"), std::string("2"));
  EXPECT_THAT(error_of(test::joined(archive.finish())), testing::HasSubstr("section 'camera' is missing"));
}

}  // namespace
}  // namespace vsgraphs
