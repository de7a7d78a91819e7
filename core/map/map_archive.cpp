#include "core/map/map_archive.h"

#include "core/map/map_checks.h"
#include "core/map/stretch.h"

namespace vsgraphs {

void save_map(ArchiveWriter& archive, const std::string& prefix, const Map& map) {
  visit_tables(map, [&](const char* name, const auto& part, std::uint32_t = 1) {
    archive.add(prefix + "/" + name, part);
  });
}

Map load_map(const ArchiveReader& archive, const std::string& prefix) {
  Map map;
  visit_tables(map, [&](const char* name, auto& part, std::uint32_t since = 1) {
    if (archive.version() >= since) archive.read(prefix + "/" + name, part);
  });
  if (archive.version() < 3) map.cut_into_stretches(usual_stretch_m);
  for (const auto check : {wrong_with_references, wrong_with_values}) {
    if (Wrong wrong = check(map)) archive.damaged(wrong);
  }
  return map;
}

void load_shared_constants(ArchiveReader& archive) {
  archive.load_shared<FeatureSet>();
  archive.load_shared<DepthGrid>();
  archive.load_shared<KeyframeSurfaces>();
  archive.load_shared<ClassGrid>();
  archive.load_shared<MappedMarker>();
}

}  // namespace vsgraphs
