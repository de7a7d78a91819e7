// Uncertain rigid transforms: six by six covariances and informations, tangent (rho, phi) on the right of the transform, m
// and rad. After Barfoot and Furgale, "Associating Uncertainty With Three-Dimensional Poses", T-RO 2014 (first order).
#pragma once

#include "core/geometry/se3.h"

namespace vsgraphs {

// Whether it can be one: symmetric and nowhere negative but for rounding, and none of its variances beyond a million.
bool is_covariance(const Matrix6d& matrix);

// Independent directions, one sigma each way.
Matrix6d isotropic_covariance(double sigma_m, double sigma_rad);

// `covariance` must be positive definite; throws InvariantError if it is not.
Matrix6d information_of(const Matrix6d& covariance);
// `information` positive semidefinite: directions without any get a sigma of a kilometre, or as many radians.
Matrix6d covariance_of(const Matrix6d& information);

// a_from_c = a_from_b b_from_c, both uncertain and independent of each other.
Matrix6d compose_covariance(const Matrix6d& of_a_from_b, const Se3& b_from_c, const Matrix6d& of_b_from_c);
// Of b_from_a, given that of a_from_b.
Matrix6d inverted_covariance(const Se3& a_from_b, const Matrix6d& of_a_from_b);

// The least covariance that is nowhere, in no direction, below either. `floor`: independent directions, all above 0.
Matrix6d floored(const Matrix6d& covariance, const Matrix6d& floor);

// sqrt(e' C^-1 e): how many standard deviations an error is large. `covariance` as for information_of.
double sigmas_of(const Vector6d& error, const Matrix6d& covariance);

}  // namespace vsgraphs
