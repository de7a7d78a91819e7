#include "core/solve/bundle/validate.h"

#include <cmath>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

// The message is built only when it is needed: this runs over every observation.
[[noreturn]] void refuse(const char* what, std::size_t index, const char* why) {
  throw InputError(std::string("bundle adjustment: ") + what + " " + std::to_string(index) + " " + why);
}

void check_flags(const char* what, std::size_t values, const std::vector<std::uint8_t>& fixed) {
  require_input(fixed.empty() || fixed.size() == values,
                std::string("bundle adjustment: ") + what + " has " + std::to_string(fixed.size()) +
                    " flags for " + std::to_string(values) + " variables; give one each, or none");
}

void check_values(const BundleProblem& problem) {
  const StructureVariables& s = problem.structures;
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    if (!problem.poses[i].finite()) refuse("pose", i, "is not finite");
  for (std::size_t i = 0; i < problem.landmarks.size(); ++i)
    if (!problem.landmarks[i].allFinite()) refuse("landmark", i, "is not finite");
  for (std::size_t i = 0; i < s.planes.size(); ++i) {
    const AnchoredPlane& p = s.planes[i];
    if (!p.anchor.allFinite() || !std::isfinite(p.offset_m) || !(std::abs(p.normal.squaredNorm() - 1) < 1e-6))
      refuse("plane", i, "is not finite or its normal not of unit length");
  }
  for (std::size_t i = 0; i < s.centroids.size(); ++i)
    if (!s.centroids[i].allFinite()) refuse("centroid", i, "is not finite");
  for (std::size_t i = 0; i < s.markers.size(); ++i)
    if (!s.markers[i].finite()) refuse("marker", i, "is not finite");
}

void check_observations(const BundleProblem& problem) {
  const int poses = static_cast<int>(problem.poses.size()),
            landmarks = static_cast<int>(problem.landmarks.size());
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const ReprojectionObservation& o = problem.observations[i];
    if (o.pose < 0 || o.pose >= poses) refuse("observation", i, "names a pose that is not there");
    if (o.landmark < 0 || o.landmark >= landmarks)
      refuse("observation", i, "names a landmark that is not there");
    // One test for all: a sum is finite only if its terms are.
    if (!std::isfinite(o.u + o.v + o.inverse_depth + o.inv_sigma_px + o.inv_sigma_inverse_depth))
      refuse("observation", i, "holds a value that is not finite");
    if (!(o.inv_sigma_px > 0) || o.inv_sigma_inverse_depth < 0)
      refuse("observation", i, "needs a positive inv_sigma_px and no negative inv_sigma_inverse_depth");
  }
}

void check_factors(const BundleProblem& problem) {
  const StructureVariables& s = problem.structures;
  const auto count = [&](VariableKind kind) {
    switch (kind) {
      case VariableKind::pose:
        return problem.poses.size();
      case VariableKind::plane:
        return s.planes.size();
      case VariableKind::centroid:
        return s.centroids.size();
      case VariableKind::marker:
        return s.markers.size();
    }
    return std::size_t{0};
  };
  for (std::size_t i = 0; i < problem.factors.size(); ++i) {
    if (!problem.factors[i]) refuse("factor", i, "is null");
    const DenseFactor& f = *problem.factors[i];
    if (f.rows() < 1 || f.rows() > max_factor_rows) refuse("factor", i, "has too many or no rows");
    for (std::size_t v = 0; v < f.variables().size(); ++v) {
      const VariableRef ref = f.variables()[v];
      if (ref.index < 0 || static_cast<std::size_t>(ref.index) >= count(ref.kind))
        refuse("factor", i, "names a variable that is not there");
      for (std::size_t w = 0; w < v; ++w)
        if (f.variables()[w] == ref) refuse("factor", i, "names a variable twice");
    }
  }
}

}  // namespace

void validate(const BundleProblem& problem, const BundleOptions& options) {
  const Intrinsics& k = problem.intrinsics;
  require_input(k.fx > 0 && k.fy > 0 && std::isfinite(k.fx + k.fy + k.cx + k.cy),
                "bundle adjustment: the intrinsics need positive focal lengths and finite values");
  require_input(options.max_iterations >= 0 && options.iterations_before_dropping >= 0,
                "bundle adjustment: iteration budgets cannot be negative");
  require_input(options.initial_lambda > 0, "bundle adjustment: initial_lambda must be positive");
  check_flags("pose_fixed", problem.poses.size(), problem.pose_fixed);
  check_flags("plane_fixed", problem.structures.planes.size(), problem.structures.plane_fixed);
  check_flags("centroid_fixed", problem.structures.centroids.size(), problem.structures.centroid_fixed);
  check_flags("marker_fixed", problem.structures.markers.size(), problem.structures.marker_fixed);
  check_values(problem);
  check_observations(problem);
  check_factors(problem);
}

}  // namespace vsgraphs
