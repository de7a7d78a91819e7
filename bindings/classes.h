// A segmenter's own classes, as the map knows them, for Python.
#pragma once

#include <nanobind/nanobind.h>

#include "core/map/map.h"

namespace vsgraphs {

// Sorted.
nanobind::list class_names_of(const Map& map);
// name -> weight.
nanobind::dict class_votes_of(const Map& map, const ClassVotes& votes);
// See Snapshot.keyframe_classes.
nanobind::object keyframe_classes_of(const Map& map, std::uint32_t keyframe);

}  // namespace vsgraphs
