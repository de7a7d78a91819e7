// Internal to core/simulate: the rows and runs of pixels a projected face covers.
#pragma once

#include <algorithm>
#include <cmath>

#include "simulate/visibility.h"

namespace vsgraphs {

// Spans grow by this much so that rounding cannot open a crack between faces that share an edge.
inline constexpr double span_margin_px = 1e-6;

template <typename Paint>
void VisibilityBuffer::each_run(const FaceView& face_view, const Paint& paint) {
  const int v0 = static_cast<int>(std::ceil(std::max(bounds_[2], static_cast<double>(rows_.begin))));
  const int v1 = static_cast<int>(std::floor(std::min(bounds_[3], rows_.end - 1.0)));
  const float step = static_cast<float>(face_view.inverse_depth.a);
  for (int v = v0; v <= v1; ++v) {
    crossings_.clear();
    for (const Edge& e : edges_)
      if (e.v_min <= v && v < e.v_max) crossings_.push_back(e.u_at_v_min + (v - e.v_min) * e.slope);
    if (crossings_.size() == 2) {  // nearly always
      if (crossings_[0] > crossings_[1]) std::swap(crossings_[0], crossings_[1]);
    } else {
      std::sort(crossings_.begin(), crossings_.end());
    }
    const float start = static_cast<float>(face_view.inverse_depth.b * v + face_view.inverse_depth.c);
    for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2) {
      const double left = std::max(0.0, std::ceil(crossings_[i] - span_margin_px));
      const double right = std::min(width_ - 1.0, std::floor(crossings_[i + 1] + span_margin_px));
      if (right >= left) paint(v, static_cast<int>(left), static_cast<int>(right), start, step);
    }
  }
}

}  // namespace vsgraphs
