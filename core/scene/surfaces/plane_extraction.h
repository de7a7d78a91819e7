// From one keyframe's depth grid to its planar patches: regions grown over the organised samples, each by the plane it has so
// far (Holz and Behnke, "Fast Range Image Segmentation and Smoothing Using Approximate Surface Reconstruction and Region
// Growing", IAS 2012), grown again from the refined plane, and condensed to nine numbers. Labels keep regions apart:
// pixels of different role or instance never share one. A segmenter's own classes are counted, and part nothing.
#pragma once

#include "core/base/options.h"
#include "core/geometry/camera.h"
#include "core/map/depth_grid.h"
#include "core/map/label_grid.h"
#include "core/map/surface_patch.h"

namespace vsgraphs {

struct PlaneExtractionOptions {
  double min_range_m = 0.3;
  double max_range_m = 5.0;
  int min_samples = 60;
  double min_area_m2 = 0.08;
  double gate_sigmas = 3.0;
  double max_turn_rad = 0.45;
  double min_confidence = 0.1;
  double effective_samples = 30;
  double point_spacing_m = 0.1;
};

template <typename Visitor>
void describe(PlaneExtractionOptions& o, Visitor& field) {
  field("min_range_m", o.min_range_m, 0.0, 2.0, "nearer depth readings are not used for planes");
  field("max_range_m", o.max_range_m, 1.0, 20.0, "farther depth readings are not used for planes");
  field("min_samples", o.min_samples, 10, 2000, "samples of the depth grid that make a patch");
  field("min_area_m2", o.min_area_m2, 0.0, 5.0, "smaller patches are left out");
  field("gate_sigmas", o.gate_sigmas, 1.0, 10.0, "how far off its plane a sample may lie");
  field("max_turn_rad", o.max_turn_rad, 0.05, 1.0, "between a sample's normal and its plane's");
  field("min_confidence", o.min_confidence, 0.0, 1.0, "labels less certain than this say nothing");
  field("effective_samples", o.effective_samples, 3.0, 1000.0,
        "independent readings that a patch counts for at the most: neighbouring ones err together");
  field("point_spacing_m", o.point_spacing_m, 0.02, 1.0,
        "distance of the points kept to tell a patch's extent");
}

// `labels` may be null; otherwise of the grid's size. Deterministic. About 1 ms for an 80x60 grid.
KeyframeSurfaces extract_planes(const DepthGrid& grid, const LabelGrid* labels, const Camera& camera,
                                const PlaneExtractionOptions& options);

}  // namespace vsgraphs
