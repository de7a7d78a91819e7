// Saved atlases.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdio>

#include "bindings/bind.h"
#include "build_info.h"
#include "core/base/atomic_file.h"
#include "core/base/check.h"
#include "core/system/maps/atlas_file.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace vsgraphs {

namespace {

SavedAtlas atlas_of(const AtlasState& state, const Config& config, const Camera& camera,
                    std::vector<std::string> map_names) {
  require_input(map_names.empty() || map_names.size() == state.maps.size(),
                "map_names: give one per map, or none");
  return {state,
          camera,
          configuration_text(config),
          nb::cast<std::string>(nb::module_::import_("vsgraphs.version").attr("version")()),
          VSGRAPHS_COMMIT,
          std::move(map_names),
          atlas_kind.version,
          state.loaded};
}

// Sixteen digits; none for none.
nb::object name_of(std::uint64_t revision) {
  if (revision == 0) return nb::none();
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(revision));
  return nb::str(digits);
}

// A file of format 1 stands for its own past (read_lineage): nothing is known of it.
nb::object parent_of(const SavedAtlas& atlas) {
  const bool known = atlas.parent.revision != atlas.revision;
  return known ? name_of(atlas.parent.revision) : nb::none();
}

nb::object save(const SavedAtlas& atlas, const std::filesystem::path& path, int keep) {
  if (keep < 0) throw nb::value_error("keep must not be negative");
  std::uint64_t revision = 0;
  {
    const nb::gil_scoped_release others_go_on;
    revision = save_atlas(path, atlas, keep);
  }
  return name_of(revision);
}

const MapState& map_of(const SavedAtlas& atlas, std::int64_t number) {
  const auto maps = static_cast<std::int64_t>(atlas.state.maps.size());
  const std::int64_t index = number < 0 ? number + maps : number;
  if (index < 0 || index >= maps)
    throw nb::index_error(("map " + std::to_string(number) + " of " + std::to_string(maps)).c_str());
  return atlas.state.maps[static_cast<std::size_t>(index)];
}

std::shared_ptr<Map> snapshot_of(const SavedAtlas& atlas, std::int64_t number) {
  return std::const_pointer_cast<Map>(map_of(atlas, number).map);
}

nb::list similar_places(const SavedAtlas& atlas, std::uint32_t keyframe, std::uint32_t gap, int count,
                        std::int64_t number) {
  const MapState& state = map_of(atlas, number);
  const auto& keyframes = state.map->keyframes();
  const KeyframeId id = keyframe < keyframes.index_bound() ? keyframes.at_index(keyframe) : KeyframeId{};
  if (!id.valid())
    throw nb::index_error(("keyframe " + std::to_string(keyframe) + " is not in the map").c_str());
  if (count < 0) throw nb::value_error("count must not be negative");
  std::vector<std::uint8_t> excluded(keyframes.index_bound(), 1);
  for (std::uint32_t index = 0; index + gap <= keyframe; ++index) excluded[index] = 0;
  excluded[keyframe] = 1;
  nb::list similar;
  for (const PlaceMatch& match : state.places()->query(*keyframes.find(id)->features, count, excluded))
    similar.append(nb::make_tuple(match.keyframe.index, match.score));
  return similar;
}

void put(nb::dict& d, const MapCounts& counts) {
  for (const auto& [name, number] : counts) d[name.c_str()] = number;
}

nb::dict info_of(const SavedAtlas& atlas) {
  nb::dict info, camera;
  camera["width"] = atlas.camera.width;
  camera["height"] = atlas.camera.height;
  camera["fx"] = atlas.camera.fx;
  camera["fy"] = atlas.camera.fy;
  camera["cx"] = atlas.camera.cx;
  camera["cy"] = atlas.camera.cy;
  std::vector<Snapshot> all;
  nb::list each;
  for (std::size_t i = 0; i < atlas.state.maps.size(); ++i) {
    all.push_back(atlas.state.maps[i].map);
    nb::dict d;
    d["name"] = atlas.map_names.empty() ? nb::none() : nb::cast(atlas.map_names[i]);
    put(d, count({all.back()}));
    each.append(d);
  }
  info["format"] = atlas.format;
  info["program"] = atlas.program;
  info["commit"] = atlas.commit;
  info["revision"] = name_of(atlas.revision);
  info["lineage"] = name_of(atlas.state.loaded.lineage);
  info["parent"] = parent_of(atlas);
  info["mode"] = configured(atlas.configuration, "system.mode");
  info["camera"] = camera;
  info["maps"] = atlas.state.maps.size();
  put(info, count(all));
  info["each"] = each;
  return info;
}

}  // namespace

void bind_atlas(nb::module_& m) {
  nb::class_<SavedAtlas>(
      m, "Atlas",
      "All maps of a run with what they were made with: what an atlas file holds (docs/atlas.md).")
      .def(
          "__init__",
          [](SavedAtlas* self, const AtlasState& state, const Config& config, const Camera& camera,
             std::vector<std::string> map_names) {
            new (self) SavedAtlas(atlas_of(state, config, camera, std::move(map_names)));
          },
          "state"_a, "config"_a, "camera"_a, "map_names"_a = std::vector<std::string>{},
          "Args:\n"
          "  state: Slam.atlas_state().\n"
          "  config, camera: those of the run.\n"
          "  map_names: one per map, or none.\n\n"
          "Raises InputError for names that are not one per map.")
      .def("save", &save, "path"_a, "keep"_a = 0,
           nb::sig("def save(self, path: str | os.PathLike, keep: int = 0) -> str"),
           "Writes the file as a whole or not at all: an old file stays until the new one is complete, and a "
           "symbolic link is\n"
           "followed. Returns the revision of what was written.\n\n"
           "Args:\n"
           "  path: the file.\n"
           "  keep: so many previous versions stay beside it, as PATH.1 (the last one), PATH.2, ...\n\n"
           "Raises InputError naming the file and the cause; also where maps without keyframes would "
           "replace a file.")
      .def("info", &info_of, nb::sig("def info(self) -> dict[str, typing.Any]"),
           "format, program, commit, revision, lineage, parent, mode, camera, maps; keyframes, landmarks, "
           "planes, rooms, floors, doors, "
           "markers of all maps;\n"
           "each: a list with the same counts and the name per map.")
      .def("snapshot", &snapshot_of, "number"_a = -1,
           "The map of this number; the last one is the one worked on. Raises IndexError.")
      .def("similar_places", &similar_places, "keyframe"_a, "gap"_a = 10U, "count"_a = 5, "number"_a = -1,
           nb::sig("def similar_places(self, keyframe: int, gap: int = 10, count: int = 5, number: int = -1) "
                   "-> list[tuple[int, float]]"),
           "(keyframe, score from 0 to 1) of at most `count` keyframes of a map that look most like one of "
           "its "
           "keyframes, best\n"
           "first, among those whose ids are lower by `gap` or more. Candidates: look-alike places score "
           "alike. "
           "Ids are those of\n"
           "Snapshot.keyframes(). Raises IndexError for a map or keyframe that is not there.")
      .def("__len__", [](const SavedAtlas& atlas) { return atlas.state.maps.size(); })
      .def_prop_ro(
          "empty", [](const SavedAtlas& atlas) { return is_empty(atlas.state); }, "no map has a keyframe")
      .def_ro("state", &SavedAtlas::state, "what Slam starts from")
      .def_prop_ro(
          "revision", [](const SavedAtlas& atlas) { return name_of(atlas.revision); },
          nb::sig("def revision(self) -> str | None"),
          "16 digits that name the file it was loaded from by its content; None if it was not")
      .def_prop_ro(
          "lineage", [](const SavedAtlas& atlas) { return name_of(atlas.state.loaded.lineage); },
          nb::sig("def lineage(self) -> str | None"),
          "the revision of the first file that it goes back to, from run to run; None if it was never in one")
      .def_prop_ro("parent", &parent_of, nb::sig("def parent(self) -> str | None"),
                   "the revision of the file which the run that made it started from; None: from nothing")
      .def_ro("camera", &SavedAtlas::camera)
      .def_ro("configuration", &SavedAtlas::configuration,
              "lines \"key: value\", as `vsgraphs run --config` reads them")
      .def(
          "require_fit",
          [](const SavedAtlas& atlas, const Config& config, const Camera& camera, const std::string& name) {
            require_fit(name, atlas, config, camera);
          },
          "config"_a, "camera"_a, "name"_a = "the atlas",
          "Raises InputError, naming both values and the cure, if a run with this configuration and camera "
          "cannot go on in\n"
          "the atlas: images of another size, another lens, another image pyramid, or a mode that would "
          "leave "
          "walls or rooms\n"
          "untended. `name` stands for the atlas in the message.");
  m.def(
      "load_atlas", &load_atlas, "path"_a, nb::call_guard<nb::gil_scoped_release>(),
      "Reads a saved atlas. Raises InputError, one line that names the file, where it cannot be read, is no "
      "atlas, is\n"
      "damaged or was saved by a newer version.");
  m.def(
      "atlas_revision",
      [](const std::filesystem::path& path) { return name_of(atlas_revision(path).value_or(0)); }, "path"_a,
      nb::sig("def atlas_revision(path: str | os.PathLike) -> str | None"),
      "The revision of the atlas in this file, from its first bytes: the same for the same content. None "
      "where there is no\n"
      "atlas. Whether the file is whole, load_atlas() tells.");
  m.def("require_writable", &require_writable, "path"_a,
        "Raises the InputError that saving a file of this name would raise; writes nothing that stays.");
}

}  // namespace vsgraphs
