// How firmly two planes are held to a right or a straight angle.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {

struct PlaneAngle {
  double sigma_rad = 2 * std::numbers::pi / 180;  // rooms are built this well
  int pairs = 1;  // related like this in the same room; they share the weight of one

  // Throws InputError unless both are positive.
  double inv_sigma() const {
    require_input(sigma_rad > 0 && pairs > 0, "plane angle: sigma_rad and pairs must be positive, not " +
                                                  std::to_string(sigma_rad) + " and " +
                                                  std::to_string(pairs));
    return 1 / (sigma_rad * std::sqrt(static_cast<double>(pairs)));
  }
};

}  // namespace vsgraphs
