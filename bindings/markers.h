// Markers between Python and the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "core/map/map.h"
#include "core/system/maps/markers.h"

namespace vsgraphs {

using Numbers =
    nanobind::ndarray<const std::int64_t, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
using Reals = nanobind::ndarray<const double, nanobind::c_contig, nanobind::device::cpu>;

// Arrays of one length N: numbers (N,), sizes (N,), poses (N, 4, 4), covariances (N, 6, 6). Throws InputError for others.
MarkerDetections marker_detections_of(const Numbers& ids, const Reals& sizes, const Reals& poses,
                                      const Reals& covariances);

// The map's markers for Snapshot.scene_graph.
nanobind::list markers_of(const Map& map);

}  // namespace vsgraphs
