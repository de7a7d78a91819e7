#include "bindings/classes.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bindings/arrays.h"

namespace nb = nanobind;

namespace vsgraphs {

nb::list class_names_of(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [id, name] : map.class_names()) names.push_back(name);
  std::sort(names.begin(), names.end());
  nb::list list;
  for (const std::string& name : names) list.append(name);
  return list;
}

nb::dict class_votes_of(const Map& map, const ClassVotes& votes) {
  nb::dict named;
  for (const ClassVote& vote : votes) named[map.class_names().at(vote.id).c_str()] = vote.weight;
  return named;
}

nb::object keyframe_classes_of(const Map& map, std::uint32_t keyframe) {
  const KeyframeId id =
      keyframe < map.keyframes().index_bound() ? map.keyframes().at_index(keyframe) : KeyframeId{};
  const Keyframe* found = map.keyframes().find(id);
  if (!found || !found->classes) return nb::none();
  const ClassGrid& grid = *found->classes;
  const auto rows = static_cast<std::size_t>(grid.rows), columns = static_cast<std::size_t>(grid.columns);
  std::vector<float> confidence;
  for (const std::uint8_t c : grid.confidences) confidence.push_back(static_cast<float>(c) / 255);
  nb::list names;
  for (const ClassId number : grid.classes) names.append(map.class_names().at(number));
  nb::dict d;
  d["class_names"] = names;
  d["classes"] = to_numpy(std::vector<std::uint16_t>(grid.which), {rows, columns});
  d["confidence"] = to_numpy(std::move(confidence), {rows, columns});
  d["instances"] = to_numpy(std::vector<std::uint16_t>(grid.instances), {rows, columns});
  return d;
}

}  // namespace vsgraphs
