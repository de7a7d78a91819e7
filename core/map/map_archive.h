// A map as sections of an archive, one per table; exactly, with ids, generations, redirects and the order in which ids
// will be given out.
#pragma once

#include <string>

#include "core/base/archive.h"
#include "core/map/map.h"

namespace vsgraphs {

// Sections PREFIX/keyframes, ... What keyframes share goes to the archive's pools. The map must outlive the writer's work.
// Linear in its size.
void save_map(ArchiveWriter& archive, const std::string& prefix, const Map& map);

// After the archive's shared constants are loaded (load_shared_constants). Throws InputError if a section is missing or
// what it holds does not fit together or cannot be (map_checks.h).
Map load_map(const ArchiveReader& archive, const std::string& prefix);

void load_shared_constants(ArchiveReader& archive);

}  // namespace vsgraphs
