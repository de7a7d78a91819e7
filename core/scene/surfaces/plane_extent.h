// Where on its infinite plane a surface has been seen: cells of 0.1 m.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/plane.h"
#include "core/geometry/se3.h"
#include "core/scene/surfaces/cell_grid.h"

namespace vsgraphs {

// Two directions in a plane, and where they start. For upright planes s is level and t points up.
struct PlaneFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d s = Eigen::Vector3d::UnitX(), t = Eigen::Vector3d::UnitY();

  Eigen::Vector2d coordinates(const Eigen::Vector3d& point) const {
    return {s.dot(point - origin), t.dot(point - origin)};
  }
  Eigen::Vector3d point(double s_m, double t_m) const { return origin + s_m * s + t_m * t; }
  // The same frame as seen from where `change` takes the points of its world.
  PlaneFrame transformed(const Se3& change) const {
    return {change * origin, change.rotation() * s, change.rotation() * t};
  }
};
template <FieldsOf<PlaneFrame> T>
void visit_fields(T& v, auto& field) {
  auto& [origin, s, t] = v;
  field(origin, s, t);
}

// t is as near to `up` as the plane allows; for planes that lie level, s and t are any two level directions.
PlaneFrame frame_of(const AnchoredPlane& plane, const std::optional<Eigen::Vector3d>& up);

class PlaneExtent {
 public:
  static constexpr double cell_m = 0.1;

  PlaneExtent() = default;
  explicit PlaneExtent(const PlaneFrame& frame) : frame_(frame) {}

  // Nothing farther along it belongs to one surface: the keyframe that saw it stands wrong.
  static constexpr double farthest_m = 500.0;

  void add(const Eigen::Vector3d& point) { count(point, 1); }
  // Takes a point out that was added where it is now.
  void remove(const Eigen::Vector3d& point) { count(point, -1); }
  // Takes over another one's cells, each from where it lies now.
  void add(const PlaneExtent& other);
  // Goes along where the surface is moved; no cell changes.
  void set_frame(const PlaneFrame& frame) { frame_ = frame; }
  const PlaneFrame& frame() const { return frame_; }
  // How many points lie in each.
  const CellGrid<std::uint16_t>& cells() const { return cells_; }
  double area_m2() const { return count_ * cell_m * cell_m; }
  bool empty() const { return count_ == 0; }
  // Middle of the cells' bounding box, on the frame's plane; the origin if there are none.
  Eigen::Vector3d centre() const;
  // The middles of all cells with a point.
  std::vector<Eigen::Vector3d> points() const;
  // Whether a cell lies within `reach_m` (along each axis) of the point's foot.
  bool near(const Eigen::Vector3d& point, double reach_m) const;
  // Share of the points that have a cell within `reach_m`.
  double share_near(const std::vector<Eigen::Vector3d>& points, double reach_m) const;

  // Of one that was read.
  bool fits_together() const {
    return count_ >= 0 && static_cast<std::size_t>(count_) <= cells_.memory_bytes() / sizeof(std::uint16_t);
  }

  template <FieldsOf<PlaneExtent> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.frame_, v.cells_, v.count_);
  }

 private:
  void count(const Eigen::Vector3d& point, int change);

  PlaneFrame frame_;
  CellGrid<std::uint16_t> cells_;
  int count_ = 0;
};

}  // namespace vsgraphs
