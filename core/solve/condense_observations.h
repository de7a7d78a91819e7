// Several observations of one plane as one: what fixed keyframes saw of a plane, so that a ground seen by hundreds of
// them costs one factor (PlanePrior) in a window. Robust: reweighted by Huber (1964) around their common optimum.
#pragma once

#include <optional>
#include <span>

#include "core/geometry/plane_estimate.h"
#include "core/solve/robust.h"

namespace vsgraphs {

struct WeightedPlane {
  PlaneEstimate
      seen;           // in the world; inflated for its keyframe's pose error before (PlaneEstimate::inflated)
  double weight = 1;  // below 1 where errors are shared: the sum takes observations as independent
};

// The sum of the quadratics chi^2_i, each times its weight, around the plane that minimises it: equal to the sum, up to a
// constant, to second order there. `start` gives the anchor and the first guess. Empty if there are no observations or
// none knows anything. Directions none knows stay as in `start`, without information. O(observations).
std::optional<PlaneEstimate> condense_observations(std::span<const WeightedPlane> observations,
                                                   const AnchoredPlane& start, Huber robust = huber_3dof);

}  // namespace vsgraphs
