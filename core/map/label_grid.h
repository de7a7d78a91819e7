// What a segmenter says of a keyframe's image, at the samples of its depth grid.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/map/class_votes.h"
#include "core/map/surface_patch.h"

namespace vsgraphs {

struct LabelSample {
  SurfaceRole role = SurfaceRole::undecided;  // undecided: the segmenter does not say
  float confidence = 0;                       // 0..1
  std::uint16_t instance = 0;                 // 0: none; pieces of one thing share a number
  ClassId named = {};                         // none: the segmenter does not say
};

struct LabelGrid {
  int columns = 0, rows = 0;  // those of the DepthGrid
  std::vector<LabelSample> samples;
  ClassNames class_names{};  // of the classes that occur
};

// What a keyframe keeps of it: whatever has a class, on planes or not. Five bytes per sample, about 25 kB.
struct ClassGrid {
  int columns = 0, rows = 0;              // those of the DepthGrid
  std::vector<ClassId> classes;           // that occur, ascending
  std::vector<std::uint16_t> which;       // per sample, row by row; 0: none, k: the k-th of `classes`
  std::vector<std::uint8_t> confidences;  // per sample; 255: certain
  std::vector<std::uint16_t> instances;   // per sample, as the segmenter numbered them; 0: none
};
template <>
inline constexpr const char* shared_name<ClassGrid> = "class_grids";
// Whether each of its samples is there, and of a class that is.
bool fits_together(const ClassGrid& grid);
template <FieldsOf<ClassGrid> T>
void visit_fields(T& v, auto& field) {
  auto& [columns, rows, classes, which, confidences, instances] = v;
  field(columns, rows, classes, which, confidences, instances);
  if constexpr (std::remove_reference_t<decltype(field)>::reads)
    field.require(fits_together(v), "classes that do not fit together");
}

// Null where the segmenter named no class.
std::shared_ptr<const ClassGrid> classes_of(const LabelGrid& labels);

}  // namespace vsgraphs
