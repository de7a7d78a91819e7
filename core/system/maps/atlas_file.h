// A saved atlas: everything that is known, in one file, with what it was made with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/archive.h"
#include "core/geometry/camera.h"
#include "core/system/config/config.h"
#include "core/system/maps/atlas_state.h"

namespace vsgraphs {

inline constexpr ArchiveKind atlas_kind{"VSGATLAS", 5, "atlas"};

struct SavedAtlas {
  AtlasState state;
  Camera camera;
  std::string configuration;                  // lines "key: value", as `run --config` reads them
  std::string program, commit;                // version and commit of vsgraphs that made it
  std::vector<std::string> map_names;         // one per map, or none at all
  std::uint32_t format = atlas_kind.version;  // of the file it was read from
  AtlasVersion parent;                        // the file that the run which made it started from
  std::uint64_t revision = 0;                 // of the file it was read from; 0: it was made here
};

// Writes the file as a whole or not at all; returns its revision, which follows from the content alone. The newest `keep`
// previous versions stay (write_file_atomically). Maps without keyframes never replace a file, nor are maps written that could
// not be loaded again: InputError, as for whatever else goes wrong, naming the file and the cause; an old file then stays. Any
// thread: the state is values. Cost: linear in the keyframes, and one copy of it all in memory.
std::uint64_t save_atlas(const std::filesystem::path& path, const SavedAtlas& atlas, int keep = 0);
// Of the file's first bytes, whether what follows is whole or not; empty where no atlas can be read.
std::optional<std::uint64_t> atlas_revision(const std::filesystem::path& path);

// What save_atlas() was given, exactly. Throws InputError, one line that names the file, where it cannot be read, is no
// atlas, is damaged, or was saved by a newer version.
SavedAtlas load_atlas(const std::filesystem::path& path);
// The same from memory; `name` is for messages.
SavedAtlas read_atlas(const std::string& name, std::span<const std::byte> bytes);
// Fills the writer, whose finish() then gives the file's bytes; the atlas must outlive it.
void write_atlas(ArchiveWriter& archive, const SavedAtlas& atlas);

// How many of each there are.
// What is counted, in the plural, and how many: the same names in the same order for every map, elements of each kind among them.
using MapCounts = std::vector<std::pair<std::string, std::size_t>>;
MapCounts count(const std::vector<Snapshot>& maps);
// No keyframe in any map.
bool is_empty(const AtlasState& state);

// All options as lines "key: value" that `run --config` reads; numbers come back exactly.
std::string configuration_text(const Config& config);
// The value of one of its lines, without quotes; empty if there is none.
std::string configured(const std::string& configuration, const std::string& key);

// Whether a run with this configuration and camera can go on in the atlas. Throws InputError naming the file, both values
// and the cure: images of another size, another lens, other image pyramids, or (unless the run only localises) a mode that
// would leave walls or rooms of the atlas untended.
void require_fit(const std::string& name, const SavedAtlas& atlas, const Config& config,
                 const Camera& camera);

}  // namespace vsgraphs
