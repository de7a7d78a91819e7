// How well a joint problem knows its poses once it is solved: marginal covariances, all else integrated out. Landmarks leave by
// the Schur complement (Triggs et al., "Bundle Adjustment - A Modern Synthesis", 2000), the rest by inverting what remains.
#pragma once

#include <optional>
#include <vector>

#include "core/solve/bundle_adjustment.h"

namespace vsgraphs {

// Covariance of a_from_b at the problem's state, tangent (rho, phi) (m, rad) on the right of it; `a` and `b` are two of its poses
// and not both fixed. As measurements say they are: whitened noise of one sigma, robust weights included. `fit`, where it is not
// empty, leaves out observations as solve_bundle's report says. Empty where measurements do not hold all free variables
// together. Cost: one linearisation and a dense factorisation of the free variables: for small problems. Throws InputError as
// solve_bundle does.
std::optional<Matrix6d> relative_covariance(const BundleProblem& problem, int a, int b,
                                            const std::vector<ObservationFit>& fit = {},
                                            const BundleOptions& options = {});

}  // namespace vsgraphs
