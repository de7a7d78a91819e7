// A floor's centroid is the mean of its rooms': residual = (nu_f - mean of nu_r) / sigma. Like a room's it depends on this
// factor alone and exerts no force.
#pragma once

#include <span>
#include <vector>

#include "core/base/check.h"
#include "core/solve/factors/dense_factor.h"

namespace vsgraphs {

class FloorCentroid final : public DenseFactor {
 public:
  // `floor`, `rooms`: indices into the problem's centroids. Throws InputError without rooms and for sigma_m not above 0.
  FloorCentroid(int floor, std::span<const int> rooms, double sigma_m = 0.05)
      : DenseFactor(refs(floor, rooms), 3), inv_sigma_(1 / sigma_m) {
    require_input(!rooms.empty(), "floor centroid: a floor needs a room");
    require_input(sigma_m > 0, "floor centroid: sigma_m must be positive");
  }

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const std::size_t rooms = variables().size() - 1;
    const double share = inv_sigma_ / static_cast<double>(rooms);
    Eigen::Vector3d residual = inv_sigma_ * values.centroid(variables()[0].index);
    for (std::size_t i = 1; i <= rooms; ++i) residual -= share * values.centroid(variables()[i].index);
    out.residual = residual;
    if (!with_jacobians) return true;
    out.jacobians[0] = inv_sigma_ * Eigen::Matrix3d::Identity();
    for (std::size_t i = 1; i <= rooms; ++i) out.jacobians[i] = -share * Eigen::Matrix3d::Identity();
    return true;
  }

 private:
  static std::vector<VariableRef> refs(int floor, std::span<const int> rooms) {
    std::vector<VariableRef> refs{{VariableKind::centroid, floor}};
    for (int room : rooms) refs.push_back({VariableKind::centroid, room});
    return refs;
  }

  double inv_sigma_;
};

}  // namespace vsgraphs
