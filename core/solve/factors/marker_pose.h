// A keyframe sees a marker: residual = S log(seen^-1 Tk^-1 Tm), with Tk, Tm the poses of keyframe and marker in the world, seen
// the marker's pose in the camera and S'S the inverse of its covariance, tangent (rho, phi) on the right of it. The
// vS-Graphs paper's marker constraint (appendix I), its information matrix filled from the detector. Huber acts on the
// length of the six, so that a pose read wrongly pulls no harder than one that just passes.
#pragma once

#include "core/solve/factors/relative_pose.h"

namespace vsgraphs {

inline constexpr Huber huber_of_marker{3.5};  // 95 % of a chi with six degrees of freedom

class MarkerPose final : public RelativePose {
 public:
  // `pose`, `marker`: indices into the problem's poses and markers. `seen`: in the frame of that pose.
  MarkerPose(int pose, int marker, const Se3& seen, const Matrix6d& sqrt_information,
             Huber robust = huber_of_marker)
      : RelativePose({VariableKind::pose, pose}, {VariableKind::marker, marker}, seen, sqrt_information,
                     robust) {}
};

}  // namespace vsgraphs
