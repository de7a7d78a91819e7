#include "core/system/maps/atlas_file.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/check.h"
#include "core/map/map_archive.h"
#include "core/system/maps/atlas_checks.h"
#include "core/system/maps/followers.h"
#include "core/understanding/element_kind.h"

namespace vsgraphs {

namespace {

std::string prefix(std::uint32_t number) { return "map" + std::to_string(number); }

MapState load_map_state(const ArchiveReader& archive, const std::string& name, const Camera& camera) {
  MapState state;
  state.map = std::make_shared<const Map>(load_map(archive, name));
  std::vector<std::shared_ptr<Follower>> found;
  const Followers kinds = make_followers(Config{}, camera);
  for (const auto& follower : kinds.all()) {
    const std::string section = name + "/" + follower->name();
    if (!archive.has(section)) continue;
    follower->load(archive, section);
    found.push_back(follower);
  }
  state.followers = Followers(std::move(found));
  return state;
}

// Which file it goes back to. Files of before format 2 say nothing of that: each begins a line of its own.
void read_lineage(const ArchiveReader& archive, SavedAtlas& atlas) {
  const std::uint64_t revision = atlas.revision = archive.identity();
  AtlasVersion& parent = atlas.parent;
  if (archive.version() < 2)
    parent = {revision, revision};  // saved again, it is another file
  else
    archive.read("lineage", parent.lineage, parent.revision);
  atlas.state.loaded = {parent.lineage != 0 ? parent.lineage : revision, revision};
}

}  // namespace

void write_atlas(ArchiveWriter& archive, const SavedAtlas& atlas) {
  VSG_INVARIANT(atlas.map_names.empty() || atlas.map_names.size() == atlas.state.maps.size());
  archive.add("origin", atlas.program, atlas.commit);
  archive.add("camera", atlas.camera);
  archive.add("configuration", atlas.configuration);
  archive.add("lineage", atlas.parent.lineage, atlas.parent.revision);
  archive.add("maps", static_cast<std::uint32_t>(atlas.state.maps.size()), atlas.map_names);
  std::uint32_t number = 0;
  for (const MapState& state : atlas.state.maps) {
    const std::string name = prefix(number++);
    save_map(archive, name, *state.map);
    for (const auto& follower : state.followers.all()) follower->save(archive, name + "/" + follower->name());
  }
}

SavedAtlas read_atlas(const std::string& name, std::span<const std::byte> bytes) {
  ArchiveReader archive(name, bytes, atlas_kind);
  SavedAtlas atlas;
  atlas.format = archive.version();
  archive.read("origin", atlas.program, atlas.commit);
  archive.read("camera", atlas.camera);
  archive.read("configuration", atlas.configuration);
  read_lineage(archive, atlas);
  try {
    atlas.camera.validate();
  } catch (const InputError& error) {
    archive.damaged(error.what());
  }
  std::uint32_t maps = 0;
  archive.read("maps", maps, atlas.map_names);
  load_shared_constants(archive);
  for (std::uint32_t i = 0; i < maps; ++i)
    atlas.state.maps.push_back(load_map_state(archive, prefix(i), atlas.camera));
  if (Wrong wrong = wrong_with_atlas(atlas)) archive.damaged(wrong);
  return atlas;
}

std::uint64_t save_atlas(const std::filesystem::path& path, const SavedAtlas& atlas, int keep) {
  std::error_code ignored;
  require_input(!is_empty(atlas.state) || !std::filesystem::exists(path, ignored),
                "cannot write " + path.string() + ": a map without keyframes does not replace a file");
  for (Wrong wrong : {wrong_with_maps(atlas.state), wrong_with_atlas(atlas)})
    require_input(!wrong, "cannot write " + path.string() + ": the maps could not be loaded again (" +
                              (wrong ? wrong : "") + ")");
  ArchiveWriter archive(atlas_kind);
  write_atlas(archive, atlas);
  const auto parts = archive.finish();
  write_file_atomically(path, parts, keep);
  return archive_identity(parts.front());
}

std::optional<std::uint64_t> atlas_revision(const std::filesystem::path& path) {
  try {
    const FileContent beginning = read_file(path, SIZE_MAX, identity_bytes);
    const auto bytes = beginning.bytes();
    if (bytes.size() < identity_bytes ||
        std::memcmp(bytes.data(), atlas_kind.magic.data(), atlas_kind.magic.size()) != 0)
      return std::nullopt;
    return archive_identity(bytes);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

SavedAtlas load_atlas(const std::filesystem::path& path) {
  const FileContent content = read_file(path);
  return read_atlas(path.string(), content.bytes());
}

MapCounts count(const std::vector<Snapshot>& maps) {
  MapCounts counts;
  const auto add = [&](const std::string& name, const std::function<std::size_t(const Map&)>& in) {
    counts.emplace_back(name, 0);
    for (const Snapshot& map : maps) counts.back().second += in(*map);
  };
  add("keyframes", [](const Map& map) { return map.keyframes().size(); });
  add("landmarks", [](const Map& map) { return map.landmarks().size(); });
  add("planes", [](const Map& map) { return map.planes().size(); });
  add("rooms", [](const Map& map) { return map.structure().rooms.size(); });
  add("floors", [](const Map& map) { return map.structure().floors.size(); });
  add("doors", [](const Map& map) { return map.structure().doors.size(); });
  for (const ElementKind& kind : element_kinds()) {
    add(std::string(kind.name) + "s", [&](const Map& map) {
      const auto& elements = map.structure().elements;
      return static_cast<std::size_t>(
          std::count_if(elements.begin(), elements.end(),
                        [&](const FoundElement& element) { return element.kind == kind.name; }));
    });
  }
  add("markers", [](const Map& map) { return map.markers().size(); });
  return counts;
}

bool is_empty(const AtlasState& state) {
  for (const MapState& one : state.maps) {
    if (one.map->keyframes().size() > 0) return false;
  }
  return true;
}

}  // namespace vsgraphs
