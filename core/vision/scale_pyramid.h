// The scales of an image pyramid, for whoever predicts at which level a point will be found again.
#pragma once

#include <algorithm>
#include <cmath>

namespace vsgraphs {

struct ScalePyramid {
  int levels = 8;
  double factor = 1.2;  // size ratio of neighbouring levels, > 1

  // Level-0 pixels per pixel of `level`.
  double scale(int level) const { return std::pow(factor, level); }
  // Standard deviation of a feature's position, level-0 pixels: one pixel of its own level.
  double level_sigma_px(int level) const { return scale(level); }

  // Level at which a point now at `depth_now_m` looks as large as it did at `level_when_seen` from
  // `depth_when_seen_m` (both > 0); rounded to the nearest level and held inside the pyramid.
  int predict_level(double depth_now_m, double depth_when_seen_m, int level_when_seen) const {
    const double shift = std::log(depth_when_seen_m / depth_now_m) / std::log(factor);
    const double level = std::clamp(level_when_seen + shift, 0.0, static_cast<double>(levels - 1));
    return static_cast<int>(std::lround(level));
  }
};

}  // namespace vsgraphs
