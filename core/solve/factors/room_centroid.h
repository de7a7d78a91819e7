// A room's centroid is the mean of its walls': residual = (nu - mean of f_w) / sigma, f_w the foot on the wall's current
// plane of the centre of what was seen of it. As in the vS-Graphs paper the centroid depends on this factor alone: it
// follows the walls and exerts no force on them. The authors' code averages the feet of the perpendiculars from the map's
// origin, which for a room far from it lie outside of the room.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/solve/factors/dense_factor.h"

namespace vsgraphs {

struct WallOfRoom {
  int plane = 0;                                            // index into the problem's planes
  Eigen::Vector3d extent_centre = Eigen::Vector3d::Zero();  // m, in the world
};

class RoomCentroid final : public DenseFactor {
 public:
  // `centroid`: index into the problem's centroids. Throws InputError without walls and for sigma_m not above 0.
  RoomCentroid(int centroid, std::span<const WallOfRoom> walls, double sigma_m = 0.05)
      : DenseFactor(refs(centroid, walls), 3), inv_sigma_(1 / sigma_m) {
    require_input(!walls.empty(), "room centroid: a room needs a wall");
    require_input(sigma_m > 0, "room centroid: sigma_m must be positive");
    for (const WallOfRoom& wall : walls) centres_.push_back(wall.extent_centre);
  }

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const double share = inv_sigma_ / static_cast<double>(centres_.size());
    Eigen::Vector3d residual = inv_sigma_ * values.centroid(variables()[0].index);
    if (with_jacobians) out.jacobians[0] = inv_sigma_ * Eigen::Matrix3d::Identity();
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      const AnchoredPlane& wall = values.plane(variables()[i + 1].index);
      residual -= share * wall.project(centres_[i]);
      if (!with_jacobians) continue;
      const Eigen::Matrix<double, 3, 2> basis = tangent_basis(wall.normal);
      Eigen::RowVector3d by_distance;
      by_distance << (centres_[i] - wall.anchor).transpose() * basis, 1;
      Eigen::Matrix3d by_wall = wall.normal * by_distance;  // of the centre minus its foot
      by_wall.leftCols<2>() += wall.signed_distance(centres_[i]) * basis;
      out.jacobians[i + 1] = share * by_wall;
    }
    out.residual = residual;
    return true;
  }

 private:
  static std::vector<VariableRef> refs(int centroid, std::span<const WallOfRoom> walls) {
    std::vector<VariableRef> refs{{VariableKind::centroid, centroid}};
    for (const WallOfRoom& wall : walls) refs.push_back({VariableKind::plane, wall.plane});
    return refs;
  }

  std::vector<Eigen::Vector3d> centres_;
  double inv_sigma_;
};

}  // namespace vsgraphs
