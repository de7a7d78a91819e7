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
  field("min_range_m", o.min_range_m, 0.0, 2.0, "nearest depth reading that is used for planes, in metres");
  field("max_range_m", o.max_range_m, 1.0, 20.0, "farthest depth reading that is used for planes, in metres");
  field("min_samples", o.min_samples, 10, 2000, "least number of depth samples in a plane's patch");
  field("min_area_m2", o.min_area_m2, 0.0, 5.0, "smallest patch of a plane, in square metres");
  field("gate_sigmas", o.gate_sigmas, 1.0, 10.0,
        "largest distance of a depth sample from its plane, in standard deviations of its noise");
  field("max_turn_rad", o.max_turn_rad, 0.05, 1.0,
        "largest angle between a depth sample's normal and its plane's, in radians");
  field("min_confidence", o.min_confidence, 0.0, 1.0,
        "labels of a segmenter with less confidence than this, 0 to 1, are ignored");
  field("effective_samples", o.effective_samples, 3.0, 1000.0,
        "largest number of independent readings that a patch counts for, as neighbouring readings err "
        "together");
  field("point_spacing_m", o.point_spacing_m, 0.02, 1.0,
        "distance between the points that are kept of a patch's extent, in metres");
}

// `labels` may be null; otherwise of the grid's size. Deterministic. About 1 ms for an 80x60 grid.
KeyframeSurfaces extract_planes(const DepthGrid& grid, const LabelGrid* labels, const Camera& camera,
                                const PlaneExtractionOptions& options);

}  // namespace vsgraphs
