// How a stage declares its options: a plain struct, and one `describe` function that names every field with its
// range and meaning. Reading, checking and documenting options all go through that one function.
//
//   struct TrackerOptions { int max_lost_frames = 30; };
//   template <typename Visitor> void describe(TrackerOptions& o, Visitor& field) {
//     field("max_lost_frames", o.max_lost_frames, 1, 1000, "frames after which ...");
//   }
//
// A visitor takes (name, int& or double&, minimum, maximum, meaning), (name, bool&, meaning) and
// (name, std::string&, allowed values (empty list: any), meaning).
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace vsgraphs {

using AllowedValues = std::vector<std::string>;

}  // namespace vsgraphs
