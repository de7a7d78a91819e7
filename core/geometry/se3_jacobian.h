// Jacobian of the SE(3) logarithm and the adjoint, for tangent vectors ordered (rho, phi).
// Formulas: Barfoot, "State Estimation for Robotics" (2017), 7.1.5 (closed form of Q).
#pragma once

#include "core/geometry/se3.h"

namespace vsgraphs {

// d log(T exp(xi)) / d xi at xi = 0, where `log_of_transform` = log(T). Valid for rotation angles below pi.
Matrix6d se3_right_jacobian_inverse(const Vector6d& log_of_transform);

// T exp(xi) T^-1 = exp(adjoint(T) xi).
Matrix6d se3_adjoint(const Se3& transform);

}  // namespace vsgraphs
