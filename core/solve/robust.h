// Huber's robust cost (Huber 1964) on squared whitened residuals, and the chi-square gates the solvers share.
#pragma once

#include <cmath>
#include <cstdint>

namespace vsgraphs {

// 95 % quantiles of chi-square with 1, 2 and 3 degrees of freedom.
inline constexpr double chi2_95_1 = 3.841458820694124;
inline constexpr double chi2_95_2 = 5.991464547107979;
inline constexpr double chi2_95_3 = 7.814727903251179;

// rho(s) of the squared residual s: s inside, growing linearly in |r| outside. The cost of a factor is rho / 2.
struct Huber {
  double delta = 0;  // threshold on |r|, in sigmas; 0 or less: no robustness

  double cost(double squared) const {
    if (delta <= 0 || squared <= delta * delta) return squared;
    return 2 * delta * std::sqrt(squared) - delta * delta;
  }
  // rho'(s): the weight of the factor in the normal equations.
  double weight(double squared) const {
    if (delta <= 0 || squared <= delta * delta) return 1.0;
    return delta / std::sqrt(squared);
  }
};

inline constexpr Huber huber_1dof{1.959963984540054};   // sqrt(chi2_95_1)
inline constexpr Huber huber_2dof{2.447746830680816};   // sqrt(chi2_95_2)
inline constexpr Huber huber_3dof{2.7954834829151074};  // sqrt(chi2_95_3)

// What the 95 % gate says of an observation. A depth that disagrees while the pixel agrees demotes the match to its
// pixel: at depth edges the reading often belongs to the other surface although the match is right.
enum class ObservationFit : std::uint8_t { outlier = 0, pixel_only = 1, inlier = 2 };

inline bool is_inlier(ObservationFit fit) { return fit != ObservationFit::outlier; }

// Gate of one observation from the squared whitened residuals of its pixel and its depth (unused without depth).
inline ObservationFit classify(double chi2_px, double chi2_depth, bool has_depth) {
  if (!has_depth) return chi2_px <= chi2_95_2 ? ObservationFit::inlier : ObservationFit::outlier;
  if (chi2_px + chi2_depth <= chi2_95_3) return ObservationFit::inlier;
  return chi2_px <= chi2_95_2 ? ObservationFit::pixel_only : ObservationFit::outlier;
}

}  // namespace vsgraphs
