// A keyframe sees a plane: residual = S (pi_hat [-] pi_c), with pi_c the plane in the camera, pi_hat the fit to what the
// keyframe saw of it, [-] the difference (two tilts, offset) at the patch, S'S = J' (sum of w x~ x~') J its information.
// Every reading counts, exactly to second order around the fit, at the price of three numbers; chi^2 is about 3 at the
// truth whatever the number of readings, and a perfect plane is not singular. The vS-Graphs paper's pi' G pi, squared
// again by the solver, has neither property. Huber acts on the length of the three.
#pragma once

#include "core/map/surface_patch.h"
#include "core/solve/factors/dense_factor.h"
#include "core/solve/factors/plane_difference.h"

namespace vsgraphs {

// What a patch says about its plane, in the frame `frame_from_camera` leads to: the identity for a keyframe of the
// problem, anchor_from_camera for one retired, whose anchor keyframe then stands for it.
inline PlaneEstimate plane_estimate(const SurfacePatch& patch, const Se3& frame_from_camera = {}) {
  return PlaneEstimate{patch.plane, patch.information}.transformed(frame_from_camera);
}

class PlaneObservationFactor final : public DenseFactor {
 public:
  // `pose`, `plane`: indices into the problem's poses and planes. `seen`: in the frame of that pose.
  PlaneObservationFactor(int pose, int plane, const PlaneEstimate& seen, Huber robust = huber_3dof)
      : DenseFactor({{VariableKind::pose, pose}, {VariableKind::plane, plane}}, 3, robust), seen_(seen) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Se3& pose = values.pose(variables()[0].index);
    const AnchoredPlane& plane = values.plane(variables()[1].index);
    const Eigen::Matrix3d& s = seen_.sqrt_information();
    const Eigen::Vector3d& centre = seen_.plane().anchor;  // camera frame
    const Eigen::Vector3d centre_in_world = pose * centre;
    const Eigen::Matrix3d camera_from_world = pose.rotation().transpose();
    const Eigen::Vector3d normal = camera_from_world * plane.normal;
    Eigen::Matrix<double, 2, 3> tilt;
    out.residual =
        s * seen_.local(normal, plane.signed_distance(centre_in_world), with_jacobians ? &tilt : nullptr);
    if (!with_jacobians) return true;
    const PlaneByTangent by_tangent(plane, centre_in_world);
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << Eigen::Matrix<double, 2, 3>::Zero(), tilt * skew(normal),  //
        normal.transpose(), centre.cross(normal).transpose();
    Eigen::Matrix3d by_plane;
    by_plane << tilt * camera_from_world * by_tangent.normal, Eigen::Vector2d::Zero(), by_tangent.offset;
    out.jacobians[0] = s * by_pose;
    out.jacobians[1] = s * by_plane;
    return true;
  }

 private:
  PlaneDifference seen_;
};

}  // namespace vsgraphs
