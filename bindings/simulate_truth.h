// The truth of a simulated scene as Python values.
#pragma once

#include <nanobind/nanobind.h>

#include "simulate/truth.h"

namespace vsgraphs {

nanobind::dict scene_truth(const Scene& scene, const ObservationCounter& seen);

}  // namespace vsgraphs
