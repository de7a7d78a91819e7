// Where on its infinite plane a surface has been seen: cells of 0.1 m.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/geometry/plane.h"
#include "core/map/map.h"
#include "core/scene/cell_grid.h"

namespace vsgraphs {

// Two directions in a plane, and where they start. For upright planes s is level and t points up.
struct PlaneFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d s = Eigen::Vector3d::UnitX(), t = Eigen::Vector3d::UnitY();

  Eigen::Vector2d coordinates(const Eigen::Vector3d& point) const {
    return {s.dot(point - origin), t.dot(point - origin)};
  }
  Eigen::Vector3d point(double s_m, double t_m) const { return origin + s_m * s + t_m * t; }
};

// t is as near to `up` as the plane allows; for planes that lie level, s and t are any two level directions.
PlaneFrame frame_of(const AnchoredPlane& plane, const std::optional<Eigen::Vector3d>& up);

class PlaneExtent {
 public:
  static constexpr double cell_m = 0.1;

  explicit PlaneExtent(const PlaneFrame& frame) : frame_(frame) {}

  // Nothing farther along it belongs to one surface: the keyframe that saw it stands wrong.
  static constexpr double farthest_m = 500.0;

  void add(const Eigen::Vector3d& point) {
    const Eigen::Vector2d c = frame_.coordinates(point);
    if (!(c.cwiseAbs().maxCoeff() < farthest_m)) return;
    std::uint8_t& cell = cells_[cell_at(c.x(), c.y(), cell_m)];
    count_ += cell == 0;
    cell = 1;
  }
  const PlaneFrame& frame() const { return frame_; }
  const CellGrid<std::uint8_t>& cells() const { return cells_; }
  double area_m2() const { return count_ * cell_m * cell_m; }
  bool empty() const { return count_ == 0; }
  // Middle of the cells' bounding box, on the frame's plane; the origin if there are none.
  Eigen::Vector3d centre() const;
  // Whether a cell lies within `reach_m` (along each axis) of the point's foot.
  bool near(const Eigen::Vector3d& point, double reach_m) const;
  // Share of the points that have a cell within `reach_m`.
  double share_near(const std::vector<Eigen::Vector3d>& points, double reach_m) const;

 private:
  PlaneFrame frame_;
  CellGrid<std::uint8_t> cells_;
  int count_ = 0;
};

// Points of the patches behind a plane's observations, in the world. Linear in their number.
std::vector<Eigen::Vector3d> observed_points(const Map& map, const MappedPlane& plane);
PlaneExtent extent_of(const Map& map, const MappedPlane& plane);

}  // namespace vsgraphs
